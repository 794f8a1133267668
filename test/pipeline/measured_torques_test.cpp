// Torques of measured pressures between readings, and the contact with rock that they show.
#include "hammer_loads/pipeline/measured_torques.h"

#include <gtest/gtest.h>

#include <cmath>

#include "boom/booms.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kBoomCylinder = 0;

/// The shipped boom at rest and in mid air, its weight as steady torque. One cylinder has pressures.
class MeasuredBoom : public testing::Test {
 protected:
  MeasuredBoom() : boom_(test::shippedBoom()) {
    boom_.moveCompliant(motion_, {0.0, 0.0, -test::kGravity});
    boom_.vibration().rest();
    boom_.moveCompliant(motion_, {0.0, 0.0, -test::kGravity});
  }
  /// A reading of this torque beside the weight, and a sample of the crank at once.
  void read(double torque, double step = 1e-3) {
    stamp_ += static_cast<StampNs>(std::llround(1e9 * step));
    const Cylinder& cylinder = boom_.cylinders()[kBoomCylinder];
    const double push = -torque / boom_.cylinderPosition(kBoomCylinder).arm;
    pressures_.update(stamp_, kBoomCylinder, Chamber::kRod, 0.0);
    pressures_.update(stamp_, kBoomCylinder, Chamber::kBore, push / cylinder.boreArea());
    sample(0.0);
  }
  void sample(double later) {
    measured_.follow(boom_, motion_.position, none_, none_,
                     {stamp_ + static_cast<StampNs>(std::llround(1e9 * later)), 0.0}, pressures_);
  }
  const MeasuredTorques::Torque& torque() const { return *measured_.of(kBoomCylinder); }

  Boom boom_;
  JointVector none_ = JointVector::Zero(boom_.chain().joints());
  JointMotion motion_{test::workingPosition(), none_, none_};
  CylinderPressures pressures_{0.5};
  MeasuredTorques measured_;
  StampNs stamp_{test::kMs};
};

/// Of an even line, on whose second reading noise of 100 N m came by 1 ns later: no line goes through these two.
TEST_F(MeasuredBoom, ReadingsThatCameTogetherAreNoLine) {
  for (int i = 0; i < 100; ++i) read(10.0 * i);
  read(1100.0, 1e-9);
  sample(0.001);
  EXPECT_NEAR(torque().value, 1000.0, 2.0);
  EXPECT_LT(torque().deviation, 10.0);
  for (int i = 100; i < 150; ++i) read(10.0 * i);
  EXPECT_NEAR(torque().value, 1490.0, 2.0);
  EXPECT_LT(torque().deviation, 10.0);
}

/// A force within the error of the boom's weight is no contact with rock; a multiple of that error is.
TEST(MeasuredRock, ShowsAboveTheErrorOfTheBoomsWeight) {
  constexpr double kToTool = 0.2;  // [m]
  const Boom shipped = test::shippedBoom();
  const double least = 0.05 * test::kGravity * massFrom(shipped.chain(), shipped.pose(), 1).mass;
  for (const double part : {0.5, 2.0}) {
    PipelineSettings settings;
    settings.boom = BoomModel::kCompliant;
    settings.joint_max_age = 0.2;
    settings.gravity = test::kGravity;
    settings.boom_acceleration = BoomAcceleration::kDifference;
    BoomFollower follower(test::shippedBoom(), settings, kToTool);
    const JointVector working = test::workingPosition();
    const std::vector<double> angles(working.data(), working.data() + working.size());
    WrenchHistory step;
    step.count = 1;
    step.pieces[0].duration = 1e-3;
    for (int i = 1; i < 5000; ++i) {
      const StampNs stamp = i * test::kMs;
      follower.jointStates(stamp, test::kFour, angles, {});
      const BoomState& state = follower.sample({stamp, {}}, step);
      ASSERT_FALSE(state.fault);
      const Boom& boom = follower.boom();
      const JointVector torque =
          state.loads.weight + boom.hammerTorque({{0.0, 0.0, part * least}, {0.0, kToTool * part * least, 0.0}});
      for (std::size_t c = 0; c < boom.cylinders().size(); ++c) {
        const double push = -torque[boom.cylinders()[c].joint()] / boom.cylinderPosition(c).arm;
        follower.pressure(stamp, c, Chamber::kRod, 0.0);
        follower.pressure(stamp, c, Chamber::kBore, push / boom.cylinders()[c].boreArea());
      }
    }
    EXPECT_TRUE(follower.contactKnown());
    EXPECT_EQ(follower.boom().vibration().contact() > 0.0, part > 1.0);
  }
}

}  // namespace
}  // namespace hammer_loads
