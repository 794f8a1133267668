#include "hammer_loads/grapple_ros/grapple_flow.h"

#include <gtest/gtest.h>

#include "ros/grapple_messages.h"
#include "support/counting_new.h"
#include "support/csv.h"

namespace hammer_loads {
namespace {

using test::KeptMessages;
using test::sliderMessage;

constexpr std::size_t kLeft = 0, kRight = 1;
constexpr double kStep = 0.01;       // between samples [s]
constexpr double kRounding = 1e-13;  // between cold and warm start, doc/grapple.md 4 [m]

class GrappleFlowTest : public testing::Test {
 protected:
  GrappleFlowTest() { kept_.attachTo(flow_.outputs()); }
  /// Sends a sample one step after the last one.
  void send(double position, std::optional<double> velocity) {
    stamp_ += ros::Duration(kStep);
    flow_.jointStates(sliderMessage(stamp_, position, velocity), recordTime());
  }
  ros::Time recordTime() const { return stamp_ + ros::Duration(0.003); }
  RefusalCount refused(const std::string& reason) const {
    for (const RefusalCount& refusal : flow_.refusals()) {
      if (refusal.reason == reason) return refusal;
    }
    throw std::runtime_error("no such reason: " + reason);
  }

  KeptMessages kept_;
  GrappleFlow flow_{test::grappleSettings()};
  ros::Time stamp_{1000.0};
};

TEST_F(GrappleFlowTest, GivesTheReferenceTablesValuesForBothJaws) {
  constexpr double kSpeed = 0.3;  // [m/s]
  const test::Csv table = test::dataCsv("grapple_table.csv");
  for (std::size_t i = 0; i < table.size(); ++i) {
    SCOPED_TRACE(i);
    const auto at = [&](const char* column) { return table.number(i, column); };
    send(at("s"), kSpeed);
    const auto& [edge_time, edge] = kept_.edges[kRight].back();
    const auto& [twist_time, twist] = kept_.twists[kRight].back();
    const auto& [accel_time, accel] = kept_.accels[kRight].back();
    EXPECT_EQ(edge_time, recordTime());
    EXPECT_EQ(edge.header.stamp, stamp_);
    EXPECT_EQ(edge.header.frame_id, "grapple");
    // The tolerance is the table's accuracy times the largest value of the column.
    EXPECT_NEAR(edge.point.x, at("Px"), 3e-12);
    EXPECT_NEAR(edge.point.y, at("Py"), 3e-12);
    EXPECT_NEAR(twist.twist.linear.x, kSpeed * at("dPx_ds"), 1e-9);
    EXPECT_NEAR(twist.twist.linear.y, kSpeed * at("dPy_ds"), 1e-9);
    EXPECT_NEAR(accel.accel.linear.x, kSpeed * kSpeed * at("d2Px_ds2"), 1e-7);
    EXPECT_NEAR(accel.accel.linear.y, kSpeed * kSpeed * at("d2Py_ds2"), 1e-7);
    // The jaw is rigid and carried by D on the main rocker: v_P = v_D + w x DP.
    const double w5 = kSpeed * at("dtheta5_ds"), w = twist.twist.angular.z;
    EXPECT_NEAR(kSpeed * at("dPx_ds"), -w5 * at("Dy") - w * (at("Py") - at("Dy")), 1e-9);
    EXPECT_NEAR(kSpeed * at("dPy_ds"), w5 * at("Dx") + w * (at("Px") - at("Dx")), 1e-9);
    // The left jaw is the mirror image.
    EXPECT_EQ(kept_.edges[kLeft].back().second.point.x, -edge.point.x);
    EXPECT_EQ(kept_.edges[kLeft].back().second.point.y, edge.point.y);
    EXPECT_EQ(kept_.twists[kLeft].back().second.twist.linear.x, -twist.twist.linear.x);
    EXPECT_EQ(kept_.twists[kLeft].back().second.twist.angular.z, -w);
    EXPECT_EQ(kept_.accels[kLeft].back().second.accel.linear.y, accel.accel.linear.y);
  }
  EXPECT_EQ(flow_.accepted(), table.size());
  EXPECT_EQ(flow_.refused(), 0u);
}

TEST_F(GrappleFlowTest, MechanismHoldsTheTablesJointAngles) {
  const test::Csv table = test::dataCsv("grapple_table.csv");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto at = [&](const char* column) { return table.number(i, column); };
    send(at("s"), 0.3);
    const sensor_msgs::JointState& m = kept_.mechanisms.back().second;
    ASSERT_EQ(m.name.size(), 13u);
    ASSERT_EQ(m.velocity.size(), 13u);
    const auto place = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(m.name.begin(), m.name.end(), name) - m.name.begin());
    };
    EXPECT_EQ(m.position.at(place("grapple_slider_joint")), at("s"));
    for (const std::string side : {"grapple_left_", "grapple_right_"}) {
      const auto position = [&](const char* link) { return m.position.at(place(side + link + "_joint")); };
      EXPECT_NEAR(position("drive_rod"), std::atan2(at("Hy") - at("s"), at("Hx")), 1e-12);
      EXPECT_NEAR(position("rocker"), at("theta1"), 1e-12);
      EXPECT_NEAR(position("lever"), at("theta2") - at("theta1"), 2e-12);
      EXPECT_NEAR(position("jaw"), at("theta3") - at("theta2"), 2e-12);
      EXPECT_NEAR(position("tie_rod"), std::atan2(at("Ey") - at("Cy"), at("Ex") - at("Cx")) - at("theta2"), 1e-11);
      EXPECT_NEAR(position("main_rocker"), at("theta5"), 1e-12);
      EXPECT_NEAR(m.velocity.at(place(side + "main_rocker_joint")), 0.3 * at("dtheta5_ds"), 1e-9);
    }
  }
}

TEST_F(GrappleFlowTest, RefusesEachBadSampleCountsItAndStaysOnItsBranch) {
  std::uint64_t all_refused = 0;
  for (const test::BadSample& bad : test::badSamples(stamp_, 0.5)) {
    SCOPED_TRACE(bad.reason);
    send(0.5, 0.1);
    const std::size_t before = kept_.edges[kRight].size();
    const double x = kept_.edges[kRight].back().second.point.x;
    const std::uint64_t count_before = refused(bad.reason).count;
    sensor_msgs::JointState message = bad.message;
    message.header.stamp += stamp_ - ros::Time(1000.0);
    flow_.jointStates(message, recordTime());
    EXPECT_EQ(refused(bad.reason).count, count_before + 1);
    EXPECT_EQ(kept_.edges[kRight].size(), before);
    EXPECT_EQ(kept_.mechanisms.size(), before);
    if (bad.reason != std::string("missing joint")) ++all_refused;
    EXPECT_EQ(flow_.refused(), all_refused);
    stamp_ += ros::Duration(kStep);
    send(0.5, 0.1);
    ASSERT_EQ(kept_.edges[kRight].size(), before + 1);
    EXPECT_NEAR(kept_.edges[kRight].back().second.point.x, x, kRounding);
  }
  EXPECT_EQ(refused("across fold").last,
            "grapple_slider_joint: 0.88 m, across fold: must lie between the dead centre at -0.27 m and the fold at "
            "0.7331923934967 m");
  EXPECT_EQ(refused("short array").last, "");
}

TEST_F(GrappleFlowTest, AcceptsTimeThatRunsBackFromTheSecondSampleOn) {
  send(0.3, 0.1);
  stamp_ -= ros::Duration(100.0);
  send(0.3, 0.1);
  EXPECT_EQ(flow_.accepted(), 1u);
  send(0.31, 0.1);
  send(0.32, 0.1);
  EXPECT_EQ(flow_.accepted(), 3u);
}

TEST(SliderAccelerationTest, DifferenceIsThatOfTheLastTwoVelocities) {
  KeptMessages kept;
  GrappleFlow flow(test::grappleSettings(SliderAcceleration::kDifference));
  kept.attachTo(flow.outputs());
  const auto send = [&](double time, double position, std::optional<double> velocity) {
    flow.jointStates(sliderMessage(ros::Time(time), position, velocity), ros::Time(time));
  };
  send(10.0, 0.3, 0.1);
  EXPECT_TRUE(kept.accels[kRight].empty()) << "one velocity has no difference";
  EXPECT_EQ(flow.withoutAcceleration(), 1u);
  send(10.25, 0.35, 0.3);  // 0.8 m/s2
  ASSERT_EQ(kept.accels[kRight].size(), 1u);
  const GrappleMotion m = *flow.tracker().grapple().at(0.35);
  EXPECT_NEAR(kept.accels[kRight].back().second.accel.linear.x, 0.3 * 0.3 * m.ddp.re + 0.8 * m.dp.re, 1e-12);
  EXPECT_NEAR(kept.accels[kLeft].back().second.accel.angular.z, -(0.3 * 0.3 * m.jaw.dd + 0.8 * m.jaw.d), 1e-12);
  send(12.0, 0.36, 0.1);  // later than stale_after_s
  send(12.1, 0.36, std::nullopt);
  send(12.2, 0.36, 0.1);
  EXPECT_EQ(kept.accels[kRight].size(), 1u) << "no neighbour, no velocity, no velocity before";
  send(12.3, 0.36, 0.1);
  EXPECT_EQ(kept.accels[kRight].size(), 2u);
  EXPECT_EQ(flow.withoutAcceleration(), 4u);
}

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
    message.position[1] = i % 10 == 9 ? 0.74 : 0.3 + 1e-4 * i;  // including refused ones
    flow.jointStates(message, message.header.stamp);
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_EQ(flow.accepted(), 1801u);
  EXPECT_EQ(sent, 1u + 7u * 1801u - 2u) << "run_info; three outputs per jaw, mechanism; no acceleration at first";
}

}  // namespace
}  // namespace hammer_loads
