/// Files and directories that others delete, move or replace while the log writes.
#include <functional>

#include "hammer_loads/log/bag_log.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

TEST_F(LogTest, ReportsThatItsFileWasDeleted) {
  BagLog log(settings_);
  ASSERT_TRUE(log.start().empty());
  log.write("/a", at(0), wrench(0));
  ASSERT_TRUE(waitFor([&] { return log.health().messages_written == 1; }));
  std::filesystem::remove(log.health().file);
  ASSERT_TRUE(waitFor([&] { return log.health().state == LogState::kFailed; }, std::chrono::seconds(3)));
  EXPECT_NE(log.health().reason.find("was deleted"), std::string::npos) << log.health().reason;
}

/// Records into `logs`, changes something there, waits until the log stops by itself.
class MovedLogTest : public LogTest {
 protected:
  LogHealth recordWhile(const std::function<void(const std::string& file)>& change) {
    settings_.directory = path("logs");
    std::filesystem::create_directory(path("logs"));
    BagLog log(settings_);
    EXPECT_TRUE(log.start().empty());
    for (std::size_t i = 0; i < 100; ++i) log.write("/a", at(i), wrench(i));
    EXPECT_TRUE(waitFor([&] { return log.health().messages_written == 100; }));
    change(log.health().file);
    EXPECT_TRUE(waitFor([&] { return log.health().state == LogState::kFailed; }, std::chrono::seconds(3)));
    EXPECT_FALSE(log.isRecording());
    return log.health();
  }
};

TEST_F(MovedLogTest, ReportsThatItsDirectoryWasRenamedAndLeavesAWholeBagThere) {
  const LogHealth health = recordWhile([this](const std::string&) {
    std::filesystem::rename(path("logs"), path("elsewhere"));
    std::filesystem::create_directory(path("logs"));  // another one under the old name
  });
  EXPECT_NE(health.reason.find("moved"), std::string::npos) << health.reason;
  EXPECT_EQ(std::filesystem::path(health.file).parent_path(), path("elsewhere"));
  EXPECT_EQ(readBag(health.file).size(), 100u);
  EXPECT_TRUE(std::filesystem::is_empty(path("logs")));
}

TEST_F(MovedLogTest, ReportsThatItsDirectoryWasRemoved) {
  const LogHealth health = recordWhile([this](const std::string&) { std::filesystem::remove_all(path("logs")); });
  EXPECT_NE(health.reason.find("was deleted"), std::string::npos) << health.reason;
}

TEST_F(MovedLogTest, ReportsThatItsFileWasReplacedAndLeavesTheOtherAlone) {
  std::string own;
  const LogHealth health = recordWhile([&](const std::string& file) {
    own = file;
    std::filesystem::rename(file, path("aside"));
    writeFile(file, "precious");
  });
  EXPECT_NE(health.reason.find("replaced"), std::string::npos) << health.reason;
  EXPECT_EQ(readFile(own), "precious");
  EXPECT_EQ(readBag(path("aside")).size(), 100u) << "closed in order, only not renamed";
}

/// In a directory that others may write to, the name may lead elsewhere by the time rosbag opens the file.
TEST_F(LogTest, WritesToTheFileThatItTookWhateverItsNameLeadsTo) {
  writeFile(path("precious"), "precious");
  unsigned number = 0;
  auto name = LogName::take(directory_, "test", number);
  ASSERT_TRUE(name.value);
  const std::string active = name.value->active();
  std::filesystem::rename(active, path("aside"));
  std::filesystem::create_symlink(path("precious"), active);
  LogFile file(std::move(*name.value), 768 * 1024);
  ASSERT_FALSE(file.open());
  LogTopic topic(0, "/a", {"std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n"}, false, "");
  std::vector<std::uint8_t> bytes(1000);
  ASSERT_FALSE(file.write(topic, at(0), bytes.data(), 1000, LogFile::Clock::now()));
  EXPECT_FALSE(file.isInPlace());
  const auto fault = file.close();
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->reason.find("replaced"), std::string::npos) << fault->reason;
  EXPECT_EQ(readFile(path("precious")), "precious");
  EXPECT_TRUE(std::filesystem::is_symlink(active)) << "not ours to remove or rename";
  EXPECT_EQ(readBag(path("aside")).size(), 1u);
}

}  // namespace
}  // namespace hammer_loads::test
