#include "hammer_loads/log/bag_log.h"

#include <std_msgs/String.h>

#include <random>

#include "log/log_test_support.h"
#include "support/resident_memory.h"

namespace hammer_loads::test {
namespace {

constexpr char kRunInfo[] = "/node/run_info";

std_msgs::String text(const std::string& data) {
  std_msgs::String message;
  message.data = data;
  return message;
}

TEST_F(LogTest, CompressionChangesTheSizeAlone) {
  for (const LogCompression compression : {LogCompression::kNone, LogCompression::kLz4}) {
    settings_.compression = compression;
    settings_.prefix = compression == LogCompression::kNone ? "1_plain" : "2_packed";
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    for (std::size_t i = 0; i < 3000; ++i) log.write("/node/hull_wrench", at(i), wrench(i));
  }
  ASSERT_EQ(files().size(), 2u);
  const std::vector<Entry> plain = readBag(files()[0]), packed = readBag(files()[1]);
  ASSERT_EQ(plain.size(), 3000u);
  ASSERT_EQ(packed.size(), 3000u);
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_EQ(plain[i].bytes, packed[i].bytes);
  EXPECT_GT(std::filesystem::file_size(files()[0]), 3000u * plain[0].bytes.size());
  EXPECT_LT(2 * std::filesystem::file_size(files()[1]), std::filesystem::file_size(files()[0]));
}

TEST_F(LogTest, EverySplitStandsAlone) {
  settings_.split_size = 200'000;
  constexpr std::size_t kCount = 20000;
  std::mt19937 random(1);
  std::vector<geometry_msgs::WrenchStamped> sent;
  {
    BagLog log(settings_);
    ASSERT_TRUE(log.start().empty());
    log.writeLatched("/tf_static", at(0), text("one arm"), "/first");
    log.writeLatched("/tf_static", at(0), text("other arm"), "/second");
    for (std::size_t i = 0; i < kCount; ++i) {
      sent.push_back(wrench(i));
      sent.back().wrench.force.z = static_cast<double>(random());  // hardly compressible
      log.write("/wrench", at(i), sent.back());
      if (i == 0) log.writeLatched(kRunInfo, at(i), text("old"), "/node");
      if (i == 1) log.writeLatched(kRunInfo, at(i), text("new"), "/node");
    }
  }
  ASSERT_GE(files().size(), 4u);
  std::size_t next = 0;
  for (std::size_t n = 0; n < files().size(); ++n) {
    const std::string file = files()[n];
    EXPECT_LT(std::filesystem::file_size(file), settings_.split_size * 3 / 2) << file;
    const auto entries = readBag(file);
    const auto wrenches = onTopic(entries, "/wrench");
    ASSERT_FALSE(wrenches.empty());
    for (const Entry& entry : wrenches) ASSERT_EQ(entry.as<geometry_msgs::WrenchStamped>(), sent[next++]);
    const auto transforms = onTopic(entries, "/tf_static");
    ASSERT_EQ(transforms.size(), 2u);
    for (const Entry& entry : transforms) {
      EXPECT_TRUE(entry.latched);
      EXPECT_EQ(entry.time, wrenches[0].time);
    }
    EXPECT_NE(transforms[0].caller, transforms[1].caller);
    const auto info = onTopic(entries, kRunInfo);
    ASSERT_EQ(info.size(), n == 0 ? 2u : 1u);
    EXPECT_EQ(info.back().as<std_msgs::String>().data, "new");
    EXPECT_EQ(info.back().caller, "/node");
  }
  EXPECT_EQ(next, kCount);
}

/// rosbag loads a plugin for every bag, and two threads must not do this at the same time.
TEST_F(LogTest, ManyLogsLiveInOneProcess) {
  constexpr std::size_t kSplits = 20;
  {
    BagLog logs[] = {BagLog(settings_), BagLog(settings_), BagLog(settings_)};
    for (BagLog& log : logs) ASSERT_TRUE(log.start().empty());
    for (std::size_t i = 0; i <= kSplits; ++i) {
      for (BagLog& log : logs) log.write("/wrench", at(i), wrench(i));
      for (BagLog& log : logs) ASSERT_TRUE(i == kSplits || log.split());
    }
  }
  EXPECT_EQ(files().size(), 3 * (kSplits + 1));
  EXPECT_EQ(readAll().size(), 3 * (kSplits + 1));
}

TEST_F(LogTest, NeedsTheMemoryOfItsQueueOnlyFromTheFirstStartOn) {
  settings_.queue_size = 100'000'000;
  const auto queue = static_cast<double>(settings_.queue_size);
  const double before = residentMemory();
  BagLog log(settings_);
  EXPECT_LT(residentMemory() - before, 0.2 * queue);
  ASSERT_EQ(log.start(), std::vector<std::string>{});
  EXPECT_GT(residentMemory() - before, 0.9 * queue);
}

/// rosbag keeps a copy of the data that passed through chunks not ended by their size.
TEST_F(LogTest, MemoryStaysFlatWhenChunksAreEndedByTime) {
  const std::shared_ptr<LogFile> file = LogFile::create(settings_, directory_);
  file->open();
  LogTopic topic(0, BagWriter::connectionOf("/a", std_msgs::String(), false));
  std::vector<std::uint8_t> bytes(100'000);
  auto now = LogFile::Clock::now();
  double before = 0.0;
  for (std::size_t i = 0; i < 1500; ++i, now += LogFile::kChunkPeriod / 5) {  // 1 MB/s for 150 s
    if (i == 500) before = residentMemory();
    file->write(topic, at(i), bytes.data(), static_cast<std::uint32_t>(bytes.size()), now);
    file->closeChunkInTime(now);
  }
  EXPECT_LT(residentMemory(), before + 5e6) << "100 MB passed";
  file->close();
}

}  // namespace
}  // namespace hammer_loads::test
