/// A bag played under simulated time gives what process_bag makes of it.
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <cstdio>
#include <map>

#include "hammer_loads/ros/bag_processing.h"

namespace hammer_loads {
namespace {

std::map<ros::Time, geometry_msgs::Wrench> offline(const std::string& bag_file) {
  BagJob job;
  job.input = bag_file;
  job.output = "/tmp/replay_rostest_" + std::to_string(getpid()) + ".bag";
  BagReport report;
  const Settings settings = *loadFiles(configDirectory(), {}).value;
  EXPECT_EQ(processBag(job, settings, [](double) {}, report), "");
  std::map<ros::Time, geometry_msgs::Wrench> wrenches;
  rosbag::Bag bag(job.output);
  for (const auto& item : rosbag::View(bag, rosbag::TopicQuery(std::string("/hammer_loads/hull_wrench")))) {
    const auto message = item.instantiate<geometry_msgs::WrenchStamped>();
    wrenches[message->header.stamp] = message->wrench;
  }
  std::remove(job.output.c_str());
  return wrenches;
}

TEST(Replay, LosesNoSampleAndEqualsProcessBag) {
  std::string bag_file;
  ASSERT_TRUE(ros::param::get("~bag", bag_file));
  const auto expected = offline(bag_file);
  ASSERT_GT(expected.size(), 2000u);
  std::map<ros::Time, geometry_msgs::Wrench> live;
  std::size_t messages = 0;
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<geometry_msgs::WrenchStamped>(
      "/hammer_loads/hull_wrench", 20000, [&](const geometry_msgs::WrenchStamped::ConstPtr& message) {
        live[message->header.stamp] = message->wrench;
        ++messages;
      });
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
  while (ros::ok() && live.size() < expected.size() && ros::WallTime::now() < deadline)
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  ASSERT_EQ(live.size(), expected.size());
  EXPECT_EQ(messages, expected.size()) << "none doubled";
  // Joint angles may arrive on the other side of a sample: weight times their change from message to message (20 ms at
  // 0.06 rad/s); played four times as fast, a busy machine may deliver them some messages late.
  constexpr double kPitchStep = 1.3e-3, kWeight = 35.2 * 9.80665, kMessagesLate = 5.0;
  for (const auto& [stamp, wrench] : expected) {
    ASSERT_NEAR(live.at(stamp).force.z, wrench.force.z, kMessagesLate * kWeight * kPitchStep) << stamp;
    ASSERT_NEAR(live.at(stamp).force.x, wrench.force.x, kMessagesLate * kWeight * kPitchStep) << stamp;
  }
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "replay_rostest");
  return RUN_ALL_TESTS();
}
