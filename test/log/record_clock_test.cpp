#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {
namespace {

TEST(RecordClock, RisesWhateverTheClockDoes) {
  ros::Time::init();
  std::mt19937 random(1);
  std::uniform_int_distribution<int> step(-3, 3);
  ros::Time arrival(0, 0);
  RecordClock clock;
  for (int i = 0; i < 100000; ++i) {
    const std::int64_t next = std::max<std::int64_t>(0, static_cast<std::int64_t>(arrival.toNSec()) + step(random));
    arrival.fromNSec(static_cast<std::uint64_t>(next));
    const ros::Time last = clock.last(), time = clock.next(arrival).time;
    ASSERT_GT(time, last);
    ASSERT_GE(time, arrival);
    ASSERT_GE(time, ros::TIME_MIN);
  }
  EXPECT_EQ(clock.next(ros::Time(5, 999999999)).time, ros::Time(5, 999999999));
  EXPECT_EQ(clock.next(ros::Time(5, 999999999)).time, ros::Time(6, 0));
  const ros::Time end(std::numeric_limits<std::uint32_t>::max(), 999999999);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(clock.next(end).time, end);
}

TEST(RecordClock, IgnoresAWallClockThatIsSetBack) {
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
