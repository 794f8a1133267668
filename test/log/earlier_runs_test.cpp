/// Names of several nodes, bags of earlier runs, bags that were not closed.
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "hammer_loads/log/bag_log.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

/// Some bags' worth of messages through a log that splits.
LogHealth record(const LogSettings& settings, std::size_t count = 20000) {
  std::mt19937 random(1);
  BagLog log(settings);
  EXPECT_EQ(log.start(), std::vector<std::string>{});
  for (std::size_t i = 0; i < count; ++i) {
    auto message = wrench(i);
    message.wrench.force.z = static_cast<double>(random());
    log.write("/wrench", at(i), message);
  }
  log.stop();
  EXPECT_TRUE(waitFor([&] { return log.health().state == LogState::kOff; }));
  return log.health();
}

class EarlierRunsTest : public LogTest {
 protected:
  EarlierRunsTest() {
    settings_.split_size = 100'000;
    settings_.total_size = 350'000;
    for (const std::string& file : earlier_) writeFile(file, std::string(50'000, 'x'));
    for (const std::string& file : foreign_) writeFile(file, std::string(50'000, 'x'));
    std::filesystem::create_symlink(foreign_[0], path("test_2001-01-01-00-00-00_9.bag"));
    writeFile(path("test_2001-01-01-00-00-00_8.bag"), "");
  }

  static bool exists(const std::string& file) { return std::filesystem::exists(std::filesystem::symlink_status(file)); }

  // In order of age.
  const std::vector<std::string> earlier_ = {
      path("test_2001-01-01-00-00-00_2.bag"), path("test_2001-01-01-00-00-00_10.bag"),
      path("test_2001-01-01-00-00-00_10-1.bag"), path("test_2001-01-02-00-00-00_0.bag.active"),
      path("test_2001-02-01-00-00-00_0.bag")};
  const std::vector<std::string> foreign_ = {path("test_2_2001-01-01-00-00-00_0.bag"),
                                             path("tes_2001-01-01-00-00-00_0.bag"),
                                             path("test_2001-01-01-00-00-00_0.orig.bag"),
                                             path("test_2001-01-01-00-00-00_.bag"),
                                             path("test_2001-01-01_0.bag"),
                                             path("notes.txt")};
};

TEST_F(EarlierRunsTest, StayAsShipped) {
  EXPECT_GT(record(settings_).files_deleted, 2u);
  for (const std::string& file : earlier_) EXPECT_TRUE(exists(file)) << file;
  for (const std::string& file : foreign_) EXPECT_TRUE(exists(file)) << file;
}

/// With 200 kB unclosed the limit of 350 kB leaves room for the last bag alone, without them for two more.
TEST_F(EarlierRunsTest, UnclosedOnesCountButStay) {
  const auto ownBags = [this] {
    const LogHealth health = record(settings_);
    return health.files_closed - health.files_deleted;
  };
  writeFile(earlier_[3], std::string(200'000, 'x'));
  EXPECT_EQ(ownBags(), 1u);
  EXPECT_TRUE(exists(earlier_[3]));
  std::filesystem::remove(earlier_[3]);
  EXPECT_EQ(ownBags(), 3u);
}

TEST_F(EarlierRunsTest, AreDeletedFirstIfThatIsWanted) {
  settings_.prune_earlier_runs = true;
  const LogHealth health = record(settings_);
  for (const std::string& file : earlier_) EXPECT_FALSE(exists(file)) << file;
  for (const std::string& file : foreign_) EXPECT_TRUE(exists(file)) << file;
  EXPECT_TRUE(exists(path("test_2001-01-01-00-00-00_9.bag"))) << "a link";
  EXPECT_GT(health.files_deleted, earlier_.size() + 2);
  for (const std::string& file : foreign_) std::filesystem::remove(file);
  std::filesystem::remove(path("test_2001-01-01-00-00-00_9.bag"));
  std::filesystem::remove(path("test_2001-01-01-00-00-00_8.bag"));
  std::uint64_t total = 0;
  for (const std::string& file : files()) total += std::filesystem::file_size(file);
  EXPECT_LE(total, settings_.total_size + settings_.split_size / 4);
  EXPECT_EQ(number(readAll().back()), 19999u);
}

/// 250 kB of earlier runs and 100 kB for the new bag fit exactly; a limit of 50 kB less costs the oldest.
TEST_F(EarlierRunsTest, OldestIsDeletedOnlyAsFarAsNeeded) {
  settings_.prune_earlier_runs = true;
  const LogHealth first = record(settings_, 1);
  EXPECT_EQ(first.files_deleted, 0u);
  std::filesystem::remove(first.file);
  settings_.total_size = 300'000;
  EXPECT_EQ(record(settings_, 1).files_deleted, 1u);
  EXPECT_FALSE(exists(earlier_[0]));
  for (std::size_t i = 1; i < earlier_.size(); ++i) EXPECT_TRUE(exists(earlier_[i])) << earlier_[i];
}

TEST_F(EarlierRunsTest, WhatAnotherProcessStillWritesIsNeverDeleted) {
  settings_.prune_earlier_runs = true;
  BagLog other(settings_);
  ASSERT_TRUE(other.start().empty());
  other.write("/wrench", at(0), wrench(0));
  ASSERT_TRUE(waitFor([&] { return other.health().messages_written == 1; }));
  EXPECT_GT(record(settings_).files_deleted, earlier_.size());
  EXPECT_TRUE(exists(other.health().file));
  EXPECT_TRUE(other.isRecording());
}

TEST_F(EarlierRunsTest, BagsThatWereNotClosedAreNamed) {
  BagLog log(settings_);
  ASSERT_TRUE(log.start().empty());
  log.write("/wrench", at(0), wrench(0));
  ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 1; }));
  EXPECT_EQ(BagLog(settings_).unfinishedBags(), std::vector<std::string>{earlier_[3]}) << "not the one being written";
  const std::string hint = BagLog::recoveryHint(earlier_[3]);
  const std::string bag = path("test_2001-01-02-00-00-00_0.bag");
  EXPECT_NE(hint.find("mv '" + bag + ".active' '" + bag + "' && rosbag reindex '" + bag + "'"), std::string::npos)
      << hint;
}

/// The lock of a process that was killed is gone.
TEST_F(EarlierRunsTest, BagOfAKilledProcessIsNamed) {
  settings_.prefix = "killed";
  const pid_t child = fork();
  if (child == 0) {
    BagLog log(settings_);
    log.start();
    log.write("/wrench", at(0), wrench(0));
    waitFor([&] { return log.health().messages_written == 1 && log.health().file_size > 0; });
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const auto left = BagLog(settings_).unfinishedBags();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].rfind(path("killed_"), 0), 0u) << left[0];
}

TEST_F(LogTest, TwoNodesWithoutAPrefixHaveNamesOfTheirOwn) {
  settings_.prefix = "";
  for (const char* node : {"/left/hammer_loads", "/right/hammer_loads"}) record(forNode(settings_, node), 1);
  std::vector<std::string> names;
  for (const std::string& file : files()) {
    const std::string name = std::filesystem::path(file).filename();
    names.push_back(name.substr(0, name.find("_2")));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"left_hammer_loads", "right_hammer_loads"}));
}

TEST_F(LogTest, APrefixHoldsWhateverTheNodeIsCalled) {
  record(forNode(settings_, "/left/hammer_loads"), 1);
  EXPECT_EQ(files().at(0).rfind(path("test_2"), 0), 0u);
}

}  // namespace
}  // namespace hammer_loads::test
