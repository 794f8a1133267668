/// Messages that the log could not store are reported in its bag and in its health.
#include "hammer_loads/log/log_gaps.h"

#include <std_msgs/String.h>

#include <map>

#include "hammer_loads/log/bag_log.h"
#include "log/log_test_support.h"

namespace hammer_loads::test {
namespace {

std_msgs::String text(std::size_t size) {
  std_msgs::String message;
  message.data.assign(size, 'x');
  return message;
}

std::vector<diagnostic_msgs::DiagnosticStatus> gapsIn(const std::vector<Entry>& entries) {
  std::vector<diagnostic_msgs::DiagnosticStatus> gaps;
  for (const Entry& entry : entries)
    if (isGapTopic(entry.topic)) gaps.push_back(entry.as<diagnostic_msgs::DiagnosticStatus>());
  return gaps;
}

TEST_F(LogTest, BagReportsAnInputThatIsTooLargeForTheQueue) {
  settings_.node = "/left/hammer_loads";
  settings_.queue_size = 1'000'000;
  {
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    log.write("/input", at(0), text(10));
    log.write("/input", at(1), text(600'000));
    log.write("/other", at(1), text(600'000));
    log.write("/input", at(2), text(600'000));
    log.write("/input", at(3), text(10));
    log.write("/input", at(4), text(10));
    const LogHealth health = log.health();
    EXPECT_EQ(health.messages_dropped, 3u);
    ASSERT_EQ(health.topics.size(), 2u);
    EXPECT_EQ(health.topics[0].too_large, 2u);
    EXPECT_EQ(health.topics[1].too_large, 1u);
  }
  const auto entries = readAll();
  EXPECT_EQ(onTopic(entries, "/input").size(), 3u);
  const auto reports = onTopic(entries, "/left/hammer_loads/log/gaps");
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(entries[1].topic, reports[0].topic) << "where the first is missing";
  EXPECT_EQ(entries[entries.size() - 3].time, at(3)) << "ahead of the first message after the last one";
  std::map<std::string, std::uint64_t> lost;
  for (const auto& gap : gapsIn(entries))
    for (const auto& topic : gap.values) lost[topic.key] += std::stoul(topic.value);
  EXPECT_EQ(lost, (std::map<std::string, std::uint64_t>{{"/input", 2}, {"/other", 1}}));
}

TEST_F(LogTest, EachBagReportsItsOwnGapAlsoAtItsEnd) {
  settings_.queue_size = 1'000'000;
  {
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    log.write("/input", at(1), text(600'000));
    EXPECT_TRUE(log.split());
    log.write("/input", at(2), text(10));
    EXPECT_TRUE(log.split());
    log.write("/input", at(3), text(600'000));
    log.stop();
    ASSERT_TRUE(log.start().empty());
    log.write("/input", at(4), text(600'000));
  }
  ASSERT_EQ(files().size(), 4u);
  std::size_t gaps = 0;
  for (const std::string& file : files()) gaps += gapsIn(readBag(file)).size();
  EXPECT_EQ(gaps, 3u);
  EXPECT_EQ(gapsIn(readBag(files()[1])).size() + gapsIn(readBag(files()[2])).size(), 1u);
}

}  // namespace
}  // namespace hammer_loads::test
