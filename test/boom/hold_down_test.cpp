#include "hammer_loads/boom/hold_down.h"

#include <gtest/gtest.h>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

using test::kGravity;
using test::kLevel;
using test::kZero;

class Press : public testing::Test {
 protected:
  Press() : boom_(test::shippedBoom()) { pose(test::workingPosition()); }
  void pose(const JointVector& q) { boom_.move({q, kZero, kZero}, kLevel); }
  /// Returns the wrench of a mean hold-down force along +z of the hull at the striking line.
  static Wrench press(double force) {
    constexpr double kStrikingLine = -0.1975;
    return {Eigen::Vector3d(0.0, 0.0, force), Eigen::Vector3d(0.0, -kStrikingLine * force, 0.0)};
  }
  Boom boom_;
};

TEST_F(Press, MachineTipsByHand) {
  // Straight ahead, hull vertical: the hold-down force lifts the machine about its far edge.
  pose(test::joints({0.0, -0.35, 1.20, -0.85}));
  const HoldDown hold = boom_.holdDown(press(1000.0));
  const PointMass all = massFrom(boom_.chain(), boom_.pose(), 0);
  EXPECT_NEAR(all.mass, 6200.0, 1.0);
  const double rear = boom_.parameters().supports->rear_x;
  const double lever = boom_.pose().tip().translation().x() - 0.1975 - rear;
  EXPECT_NEAR(hold.machine, all.mass * kGravity * (all.p.x() - rear) / (1000.0 * lever), 1e-9);
  EXPECT_EQ(hold.edge, 2);
  // `least` times the load is the limit of balance. A slightly larger load does not hold.
  EXPECT_TRUE(boom_.holdDown(press(1000.0 * hold.least * 0.999)).least >= 1.0);
  EXPECT_FALSE(boom_.holdDown(press(1000.0 * hold.least * 1.001)).least >= 1.0);
}

TEST_F(Press, PullingUpTipsTheMachineForwards) {
  pose(test::joints({0.0, -0.35, 1.20, -0.85}));
  const HoldDown hold = boom_.holdDown(press(-1000.0));
  EXPECT_EQ(hold.edge, 0);
  EXPECT_GT(hold.machine, 1.0);
}

TEST_F(Press, TipsOverTheSideSoonerWhenSwungAside) {
  pose(test::joints({0.0, -0.35, 1.20, -0.85}));
  const double ahead = boom_.holdDown(press(1000.0)).machine;
  for (double swing : {1.2, -1.2}) {
    pose(test::joints({swing, -0.35, 1.20, -0.85}));
    const HoldDown hold = boom_.holdDown(press(1000.0));
    EXPECT_LT(hold.machine, ahead);
    // A boom to the left lifts the left side, so that the machine tips over the right edge, and vice versa.
    EXPECT_EQ(hold.edge, swing > 0.0 ? 3 : 1);
  }
}

TEST_F(Press, CylindersGiveAtTheirReliefPressure) {
  const Wrench w = press(2000.0);
  const HoldDown hold = boom_.holdDown(w);
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) {
    ASSERT_TRUE(std::isfinite(hold.cylinder[i])) << i;
    const Cylinder& cylinder = boom_.cylinders()[i];
    const double times = hold.cylinder[i];
    BoomLoads loads;
    boom_.loads({times * w.force, times * w.torque}, true, loads);
    EXPECT_NEAR(loads.cylinder[i].pressure, cylinder.parameters().relief_pressure, 1e-3);
  }
}

TEST_F(Press, NothingHoldsBeyondWhatWeightAloneNeeds) {
  BoomParameters parameters = boom_.parameters();
  parameters.cylinders[0].relief_pressure = 1e5;  // the boom sinks by its own weight
  Checked<Boom> weak = Boom::make(test::shippedUrdf(), parameters);
  ASSERT_TRUE(weak.value);
  weak.value->move({test::workingPosition(), kZero, kZero}, kLevel);
  const HoldDown hold = weak.value->holdDown(press(1.0));
  EXPECT_EQ(hold.cylinder[0], 0.0);
  EXPECT_FALSE(hold.least >= 1.0);
}

TEST_F(Press, NoLoadHoldsForEver) {
  const HoldDown hold = boom_.holdDown({});
  EXPECT_TRUE(std::isinf(hold.least));
  EXPECT_TRUE(hold.least >= 1.0);
}

}  // namespace
}  // namespace hammer_loads
