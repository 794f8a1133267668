#include "hammer_loads/ros/record_clock.h"

#include "support/main.h"

namespace hammer_loads {
namespace {

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

TEST(RecordClock, BeginsAnewWhenSimulatedTimeRunsBack) {
  ros::Time::setNow(ros::Time(100.0));
  ASSERT_TRUE(ros::Time::isSimTime());
  RecordClock clock;
  clock.next(ros::Time(100.0));
  const RecordClock::Tick back = clock.next(ros::Time(50.0));
  EXPECT_EQ(back.time, ros::Time(50.0));
  EXPECT_TRUE(back.ran_back);
  const RecordClock::Tick on = clock.next(ros::Time(50.0));
  EXPECT_EQ(on.time, ros::Time(50, 1)) << "a clock that stands still is no jump";
  EXPECT_FALSE(on.ran_back);
}

}  // namespace
}  // namespace hammer_loads

HAMMER_LOADS_TEST_MAIN
