// No recorded session of test/data is taken for one in degrees.
#include "hammer_loads/pipeline/unit_check.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <filesystem>

#include "hammer_loads/pipeline/hull_pitch.h"

namespace hammer_loads {
namespace {

struct UnitOutcome {
  bool crank_told{}, boom_told{};
  int crank_samples{};
};

/// unit: what every angle of the bag is multiplied by.
UnitOutcome readSession(const std::string& path, double unit) {
  UnitOutcome outcome;
  UnitCheck check(300.0);
  HullPitch pitch({"boom_joint", "arm_joint", "hammer_joint"}, 0.0);
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  ros::Time last;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    const sensor_msgs::JointState::ConstPtr message = instance.instantiate<sensor_msgs::JointState>();
    if (!message) continue;
    std::vector<double> angles = message->position;
    for (double& angle : angles) angle *= unit;
    pitch.update(message->name, angles);
    outcome.boom_told |= pitch.looksLikeDegrees();
    if (message->name.front() != "hammer_crank_joint") continue;
    check.add((message->header.stamp - last).toSec(), angles.front(), message->velocity.front());
    last = message->header.stamp;
    outcome.crank_told |= check.isOtherUnit();
    ++outcome.crank_samples;
  }
  return outcome;
}

TEST(UnitCheckOfRecordedSessions, DetectsDegreesAndNothingElse) {
  int sessions = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HAMMER_LOADS_TEST_DATA)) {
    if (entry.path().extension() != ".bag") continue;
    SCOPED_TRACE(entry.path());
    ++sessions;
    const UnitOutcome radians = readSession(entry.path(), 1.0);
    EXPECT_FALSE(radians.crank_told);
    EXPECT_FALSE(radians.boom_told);
    EXPECT_GT(radians.crank_samples, 1000);
    const UnitOutcome degrees = readSession(entry.path(), 57.29577951308232);
    EXPECT_TRUE(degrees.crank_told);
    EXPECT_TRUE(degrees.boom_told);
  }
  EXPECT_GE(sessions, 2);
}

}  // namespace
}  // namespace hammer_loads
