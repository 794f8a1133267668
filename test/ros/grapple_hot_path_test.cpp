#include <gtest/gtest.h>

#include "ros/grapple_messages.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

TEST(GrappleHotPath, AllocatesNothing) {
  GrappleFlow flow(test::grappleSettings(SliderAcceleration::kDifference));
  std::size_t sent = 0;
  flow.outputs().forEach([&](auto& output) { output.attach([&sent](const auto&, const ros::Time&) { ++sent; }); });
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
  EXPECT_EQ(sent, 1u + 7u * 1801u - 2u) << "run_info; three outputs per jaw, mechanism; no acceleration at first";
}

}  // namespace
}  // namespace hammer_loads
