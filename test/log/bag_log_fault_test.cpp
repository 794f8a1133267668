/// The log with slow or blocked disks, write errors and directories without write permission.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>

#include "hammer_loads/log/log_gaps.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

/// A disk that blocks on request.
class Gate {
 public:
  void close() { set(false); }
  void open() { set(true); }
  void pass() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return is_open_; });
  }

 private:
  void set(bool open) {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_open_ = open;
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_{true};
};

TEST_F(LogTest, StandingDiskBlocksNobodyAndDropsAreCounted) {
  settings_.queue_size = 100'000;
  Gate gate;
  LogDisk disk;
  disk.before_write = [&gate] { gate.pass(); };
  std::uint64_t dropped = 0;
  {
    BagLog log(settings_, disk);
    ASSERT_TRUE(log.start().empty());
    log.write("/a", at(0), wrench(0));
    ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 1; }));
    gate.close();
    for (std::size_t i = 1; i <= 2000; ++i) {  // would never return if it waited for the disk
      log.write("/a", at(i), wrench(i));
      if (i % 2 == 0) log.write("/b", at(i), wrench(i));
    }
    const LogHealth health = log.health();
    EXPECT_GT(health.queue_fill, 0.9);
    ASSERT_EQ(health.topics.size(), 2u);
    EXPECT_EQ(health.topics[0].topic, "/a");
    EXPECT_GT(health.topics[0].dropped, health.topics[1].dropped);
    EXPECT_GT(health.topics[1].dropped, 0u);
    dropped = health.messages_dropped;
    gate.open();
    ASSERT_TRUE(waitFor([&] { return log.health().messages_written + dropped == 3001; }));
    log.write("/a", at(2001), wrench(2001));
    log.write("/a", at(2002), noise(60'000, 1));  // another type on this topic is rejected
    log.write("/c", at(2003), noise(60'000, 1));  // larger than half the queue
    log.write("/c", at(2004), noise(10'000, 1));
    dropped += 2;
    EXPECT_EQ(log.health().messages_dropped, dropped);
  }
  auto entries = readAll();
  const auto is_gap = [](const Entry& entry) { return isGapTopic(entry.topic); };
  entries.erase(std::remove_if(entries.begin(), entries.end(), is_gap), entries.end());
  EXPECT_EQ(entries.size(), 3003 - dropped + 2);
  const auto a = onTopic(entries, "/a");
  for (const Entry& entry : a) {
    const auto message = entry.as<geometry_msgs::WrenchStamped>();
    ASSERT_EQ(message, wrench(message.header.seq));
  }
  EXPECT_EQ(number(a.back()), 2001u);
  EXPECT_EQ(onTopic(entries, "/c").size(), 1u);
}

/// Runs an action in a child process and returns 0 if it succeeds.
template <typename Action>
int inChild(Action action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    std::exit(::testing::Test::HasFailure() ? 1 : 0);  // destructors of statics run too; none may end the process
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

TEST_F(LogTest, OutlivesWriteErrors) {
  const int status = inChild([this] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2'000'000, 2'000'000};  // writes beyond fail, whatever was allocated in advance
    setrlimit(RLIMIT_FSIZE, &limit);
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    ASSERT_TRUE(sendUntilFull(log));
    const LogHealth health = log.health();
    EXPECT_NE(health.reason.find("File too large"), std::string::npos) << health.reason;
    EXPECT_NE(health.reason.find("rosbag reindex"), std::string::npos) << health.reason;
    EXPECT_GT(health.messages_dropped, 0u);
    ASSERT_TRUE(log.start().empty());
    log.write("/noise", at(0), noise(1000, 2));
    log.stop();
    ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kOff; }));
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(files(".active").size(), 1u);
  EXPECT_EQ(readAll().size(), 1u);
}

TEST_F(LogTest, ReportsThatItsDirectoryMayNotBeWritten) {
  settings_.directory = "/proc";  // not writable even by root
  EXPECT_NE(BagLog(settings_).start().at(0).find("log_directory: '/proc', must be writable"), std::string::npos);
  settings_.directory = path("locked");
  std::filesystem::create_directory(settings_.directory);
  std::filesystem::permissions(directory_, std::filesystem::perms(0755));
  std::filesystem::permissions(settings_.directory, std::filesystem::perms(0555));
  const int status = inChild([this] {
    constexpr uid_t kNobody = 65534;
    ASSERT_TRUE(getuid() != 0 || setuid(kNobody) == 0);
    BagLog log(settings_);
    const auto problems = log.settingProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].find("must be writable: Permission denied"), std::string::npos) << problems[0];
    EXPECT_EQ(log.start(), problems);
    EXPECT_EQ(log.health().state, LogState::kOff);
  });
  EXPECT_EQ(status, 0);
}

TEST_F(LogTest, StopsAlsoWhileTooManyOrdersWait) {
  Gate gate;
  LogDisk disk;
  disk.before_write = [&gate] { gate.pass(); };
  BagLog log(settings_, disk);
  ASSERT_TRUE(log.start().empty());
  gate.close();
  log.write("/a", at(0), wrench(0));  // the writer blocks at this message
  std_msgs::String text;
  for (std::size_t i = 0; i < 2000; ++i) log.writeLatched("/latched", at(1), text);
  EXPECT_FALSE(log.split()) << "no order is taken any more";
  log.stop();
  EXPECT_FALSE(log.isRecording());
  log.write("/a", at(2), wrench(2));
  gate.open();
  ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kOff; }));
  EXPECT_EQ(onTopic(readAll(), "/a").size(), 1u);
}

}  // namespace
}  // namespace hammer_loads::test
