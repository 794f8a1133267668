#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {
namespace {

TEST(RecordTime, RisesWhateverTheClockDoes) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> step(-3, 3);
  ros::Time clock(0, 0), last(0, 0);
  for (int i = 0; i < 100000; ++i) {
    const std::int64_t next = std::max<std::int64_t>(0, static_cast<std::int64_t>(clock.toNSec()) + step(random));
    clock.fromNSec(static_cast<std::uint64_t>(next));
    const ros::Time time = BagLog::nextRecordTime(clock, last);
    ASSERT_GT(time, last);
    ASSERT_GE(time, clock);
    ASSERT_GE(time, ros::TIME_MIN);
    last = time;
  }
  EXPECT_EQ(BagLog::nextRecordTime(ros::Time(5, 999999999), ros::Time(5, 999999999)), ros::Time(6, 0));
  EXPECT_EQ(BagLog::nextRecordTime(ros::Time(7, 5), ros::Time(5, 0)), ros::Time(7, 5));
  const ros::Time end(std::numeric_limits<std::uint32_t>::max(), 999999999);
  EXPECT_EQ(BagLog::nextRecordTime(end, end), end);
}

TEST(RecordClock, RisesWhateverTheWallClockDoes) {
  ros::Time::init();
  RecordClock clock;
  EXPECT_EQ(clock.next(ros::Time(100.0)).time, ros::Time(100.0));
  EXPECT_EQ(clock.next(ros::Time(100.0)).time, ros::Time(100, 1));
  const RecordClock::Tick back = clock.next(ros::Time(50.0));
  EXPECT_EQ(back.time, ros::Time(100, 2));
  EXPECT_FALSE(back.ran_back);
  EXPECT_EQ(clock.next(ros::Time(101.0)).time, ros::Time(101.0));
  EXPECT_EQ(clock.last(), ros::Time(101.0));
}

}  // namespace
}  // namespace hammer_loads
