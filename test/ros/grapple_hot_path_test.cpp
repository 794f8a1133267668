#include <gtest/gtest.h>

#include "ros/grapple_messages.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

struct Discard final : GrappleSink {
  void runInfo(const RunInfo&, const ros::Time&) override {}
  void edge(Jaw, const geometry_msgs::PointStamped& m, const ros::Time&) override { sum += m.point.x; }
  void twist(Jaw, const geometry_msgs::TwistStamped& m, const ros::Time&) override { sum += m.twist.linear.x; }
  void accel(Jaw, const geometry_msgs::AccelStamped& m, const ros::Time&) override { sum += m.accel.linear.x; }
  void mechanism(const sensor_msgs::JointState& m, const ros::Time&) override { sum += m.position[1]; }
  bool wants(Jaw) const override { return true; }
  bool wantsMechanism() const override { return true; }
  double sum{};
};

TEST(GrappleHotPath, AllocatesNothing) {
  Discard sink;
  GrappleFlow flow(test::grappleSettings(SliderAcceleration::kDifference), sink);
  sensor_msgs::JointState message = test::sliderMessage(ros::Time(1.0), 0.3, 0.1);
  flow.jointStates(message, message.header.stamp);
  const std::size_t before = test::allocations;
  ASSERT_GT(before, 0u) << "the counter works";
  for (int i = 0; i < 2000; ++i) {
    message.header.stamp += ros::Duration(0.001);
    message.position[1] = i % 10 == 9 ? 0.74 : 0.3 + 1e-4 * i;  // refused ones as well
    flow.jointStates(message, message.header.stamp);
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_EQ(flow.accepted(), 1801u);
}

}  // namespace
}  // namespace hammer_loads
