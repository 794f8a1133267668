/// Names, directories and deletion of the log's files.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <random>

#include "hammer_loads/log/bag_log.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

/// Writes messages for several bags through a log that splits.
LogHealth record(const LogSettings& settings, std::size_t count) {
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

TEST_F(LogTest, NeverOverwritesAFile) {
  // Every name that the log would choose first in the next seconds is taken, by a bag or by one being written.
  std::vector<std::string> taken;
  const std::time_t now = std::time(nullptr);
  for (int second = -1; second < 30; ++second) {
    const std::time_t time = now + second;
    std::tm parts{};
    localtime_r(&time, &parts);
    char stamp[32];
    std::strftime(stamp, sizeof stamp, "%Y-%m-%d-%H-%M-%S", &parts);
    taken.push_back(path(std::string("test_") + stamp + "_0.bag"));
    taken.push_back(path(std::string("test_") + stamp + "_1.bag.active"));
  }
  for (const std::string& file : taken) writeFile(file, "precious");
  std::string late;
  {
    BagLog first(settings_), second(settings_);
    ASSERT_TRUE(first.start().empty());
    ASSERT_TRUE(second.start().empty());
    first.write("/wrench", at(1), wrench(1));
    second.write("/wrench", at(2), wrench(2));
    late = first.health().file;
    late = late.substr(0, late.size() - std::string(".active").size());
    writeFile(late, "precious");  // its final name is taken while it is written
  }
  taken.push_back(late);
  for (const std::string& file : taken) EXPECT_EQ(readFile(file), "precious") << file;
  std::size_t wrenches = 0;
  for (const std::string& file : files())
    if (std::filesystem::file_size(file) > 100) wrenches += readBag(file).size();
  EXPECT_EQ(wrenches, 2u);
}

TEST_F(LogTest, ReportsBeforehandWhyItCannotStart) {
  writeFile(path("file"), "");
  std::filesystem::create_directory(path("empty"));
  using Change = std::function<void(LogSettings&)>;
  const std::vector<std::pair<Change, std::string>> cases = {
      {[&](LogSettings& s) { s.directory = path("missing"); }, "missing', must exist: No such file or directory"},
      {[&](LogSettings& s) { s.directory = path("file/below"); }, "file/below', must exist: Not a directory"},
      {[&](LogSettings& s) { s.directory = path("file"); }, "file', must be a directory"},
      {[&](LogSettings& s) { s.directory = ""; }, "log_directory: '', must exist"},
      {[&](LogSettings& s) { s.prefix = "../up"; }, "log_prefix: '../up', must be a file name's beginning"},
      {[&](LogSettings& s) { s.prefix = ""; }, "log_prefix: ''"},
      {[&](LogSettings& s) { s.prefix = "a\nb"; }, "log_prefix"},
      {[&](LogSettings& s) { s.split_size = 0; }, "log_split_mb: 0 MB, must be >= 0.064 MB"},
      {[&](LogSettings& s) { s.total_size = s.split_size; }, "log_total_mb: 100 MB, must be 0 (no limit) or >= 2 x"},
      {[&](LogSettings& s) { s.queue_size = 5'000'000'000; }, "log_queue_mb: 5000 MB, must be <= 4000 MB"},
  };
  for (const auto& [change, line] : cases) {
    LogSettings changed = settings_;
    changed.directory = path("empty");
    change(changed);
    BagLog log(changed);
    const auto problems = log.start();
    EXPECT_EQ(problems, log.settingProblems()) << line;
    ASSERT_EQ(problems.size(), 1u) << line;
    EXPECT_NE(problems[0].find(line), std::string::npos) << problems[0];
    EXPECT_EQ(log.health().state, LogState::kOff);
    log.write("/wrench", at(0), wrench(0));
  }
  EXPECT_TRUE(std::filesystem::is_empty(path("empty")));
  EXPECT_FALSE(std::filesystem::exists(path("missing")));
}

TEST_F(LogTest, MakesNoDirectoryOutsideHome) {
  const std::string home = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
  std::filesystem::create_directories(path("home"));
  std::filesystem::create_directories(path("disk"));
  std::filesystem::create_directory_symlink(path("disk"), path("home/link"));
  setenv("HOME", path("home").c_str(), 1);
  for (const char* given : {"~/../x", "~/a/../../x", "~/link/x", "~/../home/../x"}) {
    EXPECT_FALSE(findLogDirectory(given).value) << given;
  }
  for (const char* given : {"~/a/../b", "~/../home/c", "~/../disk"})
    EXPECT_TRUE(findLogDirectory(given).value) << given;
  setenv("HOME", home.c_str(), 1);
  EXPECT_FALSE(std::filesystem::exists(path("x")));
  EXPECT_TRUE(std::filesystem::is_empty(path("disk")));
  EXPECT_TRUE(std::filesystem::exists(path("home/b")));
}

TEST_F(LogTest, DeletesOldestFilesOfItsOwnOnly) {
  settings_.split_size = 100'000;
  settings_.total_size = 350'000;
  writeFile(path("test_2001-01-01-00-00-00_0.bag"), "of another run");
  const LogHealth health = record(settings_, 20000);
  EXPECT_GT(health.files_deleted, 2u);
  EXPECT_EQ(health.files_closed, health.files_deleted + files().size() - 1);
  EXPECT_EQ(readFile(path("test_2001-01-01-00-00-00_0.bag")), "of another run");
  std::filesystem::remove(path("test_2001-01-01-00-00-00_0.bag"));
  std::uint64_t total = 0;
  for (const std::string& file : files()) total += std::filesystem::file_size(file);
  EXPECT_LE(total, settings_.total_size + settings_.split_size / 4);
  const auto left = readAll();
  ASSERT_FALSE(left.empty());
  EXPECT_EQ(number(left.back()), 19999u);
  EXPECT_EQ(number(left.back()) - number(left.front()) + 1, left.size());
}

TEST_F(LogTest, ReportsThatItsFileWasDeleted) {
  BagLog log(settings_);
  ASSERT_TRUE(log.start().empty());
  log.write("/a", at(0), wrench(0));
  ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 1; }));
  std::filesystem::remove(log.health().file);
  ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kFailed; }, std::chrono::seconds(3)));
  EXPECT_NE(log.health().reason.find("was deleted"), std::string::npos) << log.health().reason;
}

TEST_F(LogTest, NamesBagsThatWereNotClosed) {
  const std::string left = path("test_2001-01-02-00-00-00_0.bag.active");
  for (const char* name :
       {"test_2001-01-02-00-00-00_0.bag.active", "test_2001-01-01-00-00-00_2.bag",
        "test_2_2001-01-01-00-00-00_0.bag.active", "tes_2001-01-01-00-00-00_0.bag.active", "notes.txt"})
    writeFile(path(name), "x");
  writeFile(path("test_2001-01-01-00-00-00_8.bag.active"), "");
  std::filesystem::create_symlink(left, path("test_2001-01-01-00-00-00_9.bag.active"));
  BagLog log(settings_);
  ASSERT_TRUE(log.start().empty());
  log.write("/wrench", at(0), wrench(0));
  ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 1; }));
  const std::string bag = path("test_2001-01-02-00-00-00_0.bag");
  const std::string line =
      left + " was not closed; to recover it: mv '" + left + "' '" + bag + "' && rosbag reindex '" + bag + "'";
  EXPECT_EQ(BagLog(settings_).unfinishedBags(), std::vector<std::string>{line}) << "not the one being written";
}

/// The lock of a killed process is released.
TEST_F(LogTest, NamesTheBagOfAKilledProcess) {
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
  for (const char* node : {"/left/hammer_loads", "/right/hammer_loads"}) {
    settings_.node = node;
    record(settings_, 1);
  }
  std::vector<std::string> names;
  for (const std::string& file : files()) {
    const std::string name = std::filesystem::path(file).filename();
    names.push_back(name.substr(0, name.find("_2")));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"left_hammer_loads", "right_hammer_loads"}));
}

}  // namespace
}  // namespace hammer_loads::test
