/// The log against slow, full and broken disks.
#include <signal.h>
#include <std_msgs/String.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <random>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/log_gaps.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

/// Does not fit into less space by compression.
std_msgs::String noise(std::size_t size, std::size_t seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std_msgs::String message;
  message.data.resize(size);
  for (char& c : message.data) c = static_cast<char>(random());
  return message;
}

void send(BagLog& log, std::size_t i) { log.write("/noise", at(i), noise(50'000, i)); }

/// A disk that stops when told to.
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
    log.write("/a", at(2002), noise(60'000, 1));  // another type on this topic is not mixed in
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

TEST_F(LogTest, DestructorWritesWhatASlowDiskStillOwes) {
  LogDisk disk;
  disk.before_write = [] { std::this_thread::sleep_for(std::chrono::microseconds(200)); };
  {
    BagLog log(settings_, disk);
    ASSERT_TRUE(log.start().empty());
    for (std::size_t i = 0; i < 2000; ++i) log.write("/a", at(i), wrench(i));
    EXPECT_LT(log.health().messages_written, 2000u);
  }
  EXPECT_EQ(readAll().size(), 2000u);
}

TEST_F(LogTest, StopsCleanlyWhenTheDiskIsNearlyFullAndStartsAgain) {
  settings_.min_free_space = 1'000'000;
  std::atomic<std::uint64_t> free{2'000'000};
  LogDisk disk;
  disk.free_space = [&free](const std::string&) { return free.load(); };
  BagLog log(settings_, disk);
  ASSERT_TRUE(log.start().empty());
  for (std::size_t i = 0; i < 100; ++i) log.write("/a", at(i), wrench(i));
  ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 100; }));
  free = 999'999;
  ASSERT_TRUE(waitFor([&] { return log.health().state != LogState::kRecording; }, std::chrono::seconds(2)));
  EXPECT_EQ(log.health().state, LogState::kDiskFull);
  EXPECT_NE(log.health().reason.find("1.0 MB free in " + directory_), std::string::npos) << log.health().reason;
  EXPECT_FALSE(log.isRecording());
  EXPECT_EQ(readBag(log.health().file).size(), 100u);
  log.write("/a", at(100), wrench(100));
  EXPECT_FALSE(log.split());
  ASSERT_EQ(log.start().size(), 1u);
  EXPECT_EQ(files("").size(), 1u);
  EXPECT_EQ(log.health().state, LogState::kDiskFull);
  EXPECT_TRUE(log.settingProblems().empty()) << "no reason to end the node";
  free = 1'000'000;
  ASSERT_TRUE(log.start().empty());
  log.write("/a", at(101), wrench(101));
  log.stop();
  ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kOff; }));
  EXPECT_EQ(readAll().size(), 101u);
  EXPECT_EQ(log.health().reason, "");
}

/// A small disk of its own, where the system lets us mount one.
class SmallDiskTest : public LogTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(path("disk"));
    if (mount("none", path("disk").c_str(), "tmpfs", 0, "size=24m") != 0)
      GTEST_SKIP() << "cannot mount a tmpfs: " << std::strerror(errno);
    is_mounted_ = true;
    settings_.directory = directory_ = path("disk");
  }
  ~SmallDiskTest() override {
    if (!is_mounted_) return;
    umount2(directory_.c_str(), MNT_DETACH);
    directory_ = std::filesystem::path(directory_).parent_path();
  }

  /// Writes noise until the log gives up; whatever bag that leaves must be whole.
  void fillUp(BagLog& log, const std::string& reason) {
    ASSERT_TRUE(log.start().empty());
    std::size_t sent = 0;
    ASSERT_TRUE(waitFor([&] {
      if (log.health().queue_fill < 0.5) send(log, sent++);
      return !log.isRecording();
    }));
    ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kDiskFull; }));
    const LogHealth health = log.health();
    EXPECT_NE(health.reason.find(reason), std::string::npos) << health.reason;
    EXPECT_EQ(health.files_closed, 1u);
    EXPECT_EQ(files().size(), 1u);
    const auto entries = readAll();
    EXPECT_EQ(entries.size(), health.messages_written);
    EXPECT_GT(entries.size(), 100u);
    for (std::size_t i = 0; i < entries.size(); ++i) ASSERT_EQ(entries[i].as<std_msgs::String>(), noise(50'000, i));
  }

  bool is_mounted_{};
};

/// With log_min_free_mb: 0 there is no other limit than the disk's end.
TEST_F(SmallDiskTest, DoesNotStartOnAFullDisk) {
  std::ofstream(path("other")) << std::string(26'000'000, 'x');
  ASSERT_LT(freeSpace(directory_), 1'000'000u);
  settings_.min_free_space = 0;
  BagLog log(settings_);
  EXPECT_TRUE(log.settingProblems().empty()) << "no reason to end the node";
  const auto problems = log.start();
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("must have at least 4 MB free"), std::string::npos) << problems[0];
  EXPECT_FALSE(log.isRecording());
  EXPECT_EQ(log.health().state, LogState::kDiskFull);
  EXPECT_EQ(log.health().reason, problems[0]);
  EXPECT_EQ(files("").size(), 1u) << "no empty bag is left";
  std::filesystem::remove(path("other"));
  EXPECT_TRUE(log.start().empty());
  EXPECT_EQ(log.health().state, LogState::kRecording);
  EXPECT_EQ(log.health().reason, "");
}

TEST_F(SmallDiskTest, StopsBeforeItIsFull) {
  settings_.min_free_space = 6'000'000;
  std::atomic<std::uint64_t> last{};
  LogDisk disk;
  disk.free_space = [&last](const std::string& directory) { return last = freeSpace(directory); };
  disk.before_write = [] { std::this_thread::sleep_for(std::chrono::milliseconds(8)); };  // 6 MB between two checks
  BagLog log(settings_, disk);
  fillUp(log, "log_min_free_mb: 6.0 MB must stay free");
  EXPECT_GT(freeSpace(directory_), 0u);
}

TEST_F(SmallDiskTest, ClosesItsBagEvenIfItBecomesFullBetweenTwoChecks) {
  LogDisk disk;
  disk.free_space = [](const std::string&) { return std::uint64_t{1'000'000'000}; };
  BagLog log(settings_, disk);
  fillUp(log, "No space left on device");
}

TEST_F(SmallDiskTest, ClosesItsBagEvenIfOthersTakeAllTheRest) {
  LogDisk disk;
  disk.free_space = [](const std::string&) { return std::uint64_t{1'000'000'000}; };
  std::ofstream other(path("other"));
  std::atomic<bool> filled{false};
  disk.before_write = [&] {
    if (!filled.exchange(true)) other << std::string(24'000'000, 'x') << std::flush;
  };
  std::size_t sent = 0;
  BagLog log(settings_, disk);
  ASSERT_TRUE(log.start().empty());
  ASSERT_TRUE(waitFor([&] {
    if (log.health().queue_fill < 0.5) send(log, sent++);
    return log.health().state == LogState::kDiskFull;
  }));
  EXPECT_EQ(readAll().size(), log.health().messages_written);
}

/// Runs in a process of its own; 0 if all went well.
template <typename Action>
int inChild(Action action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    std::exit(::testing::Test::HasFailure() ? 1 : 0);  // destructors of statics too: nothing may end the process there
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

TEST_F(LogTest, OutlivesWriteErrors) {
  const int status = inChild([this] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2'000'000, 2'000'000};  // writes beyond fail, whatever was allocated ahead
    setrlimit(RLIMIT_FSIZE, &limit);
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    std::size_t sent = 0;
    ASSERT_TRUE(waitFor([&] {
      if (log.health().queue_fill < 0.5) send(log, sent++);
      return !log.isRecording();
    }));
    ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kDiskFull; }));
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

TEST_F(LogTest, SaysThatItsDirectoryMayNotBeWritten) {
  settings_.directory = "/proc";  // not even by root
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
  log.write("/a", at(0), wrench(0));  // the writer waits with this one
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

TEST_F(LogTest, TakesAnyRecordTime) {
  {
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    log.write("/a", ros::Time(), wrench(0));
    log.write("/a", ros::Time(std::numeric_limits<std::uint32_t>::max(), 999999999), wrench(1));
    log.write("/a", ros::Time(5.0), wrench(2));
  }
  EXPECT_EQ(readAll().size(), 3u);
}

}  // namespace
}  // namespace hammer_loads::test
