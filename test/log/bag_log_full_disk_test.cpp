/// The log on a disk that is or becomes full: it stops in time, and its bag is complete.
#include <sys/mount.h>

#include <atomic>
#include <cstring>

#include "hammer_loads/log/log_directory.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

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
  EXPECT_FALSE(log.hasRoomAgain());
  free = 16'999'999;  // enough for a start on request, too little for an automatic one
  EXPECT_FALSE(log.hasRoomAgain());
  free = 17'000'000;
  EXPECT_TRUE(log.hasRoomAgain());
  free = 1'000'000;
  ASSERT_TRUE(log.start().empty());
  free = 17'000'000;
  EXPECT_FALSE(log.hasRoomAgain()) << "it is recording";
  log.write("/a", at(101), wrench(101));
  log.stop();
  ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kOff; }));
  EXPECT_EQ(readAll().size(), 101u);
  EXPECT_EQ(log.health().reason, "");
}

/// A small disk for the test, where the system permits mounting one.
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

  /// Writes noise until the log stops; any bag that remains must be complete.
  void fillUp(BagLog& log, const std::string& reason) {
    ASSERT_TRUE(log.start().empty());
    ASSERT_TRUE(sendUntilFull(log));
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

/// With log_min_free_mb: 0 the end of the disk is the only limit.
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

}  // namespace
}  // namespace hammer_loads::test
