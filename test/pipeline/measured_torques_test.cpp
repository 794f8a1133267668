// How far torques of measured pressures are carried on and doubted between readings: each within a factor of 1.25 of
// what is said.
#include "hammer_loads/pipeline/measured_torques.h"

#include <gtest/gtest.h>

#include <cmath>

#include "boom/booms.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/util/square.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kBoomCylinder = 0;
constexpr int kBoomJoint = 1;

void expectRoundly(double value, double said) {
  EXPECT_GT(value, 0.8 * said);
  EXPECT_LT(value, 1.25 * said);
}

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

/// Of a torque that grows evenly, which no boom at rest explains.
TEST_F(MeasuredBoom, ALineGoesOnForTwentyMilliseconds) {
  for (int i = 0; i < 100; ++i) read(100.0 * i);
  const double last = torque().value;
  sample(0.01);
  expectRoundly(torque().value - last, 1e5 * 0.01);
  sample(0.04);
  expectRoundly(torque().value - last, 1e5 * 0.02);
}

/// A single jump counts by its share of them.
TEST_F(MeasuredBoom, TwoHundredReadingsSayHowFarOneIsOff) {
  for (int i = 0; i < 2000; ++i) read(0.0);
  read(1e4);
  expectRoundly(torque().deviation, 1e4 / std::sqrt(200.0));
}

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

TEST_F(MeasuredBoom, OverATenthOfASecondNothingWasForetold) {
  for (const double gap : {0.08, 0.125}) {
    measured_ = {};
    for (int i = 0; i < 100; ++i) read(0.0);
    read(1e4, gap);
    EXPECT_EQ(torque().deviation > 100.0, gap < 0.1) << torque().deviation;
  }
}

/// Stamps that lag: readings that surprise by more than their variance make the torque's swing doubtful, by 0.4 of it
/// at that surprise.
TEST_F(MeasuredBoom, ReadingsThatDoNotFitMakeTheSwingDoubtful) {
  constexpr double kSwing = 1e4;  // [N m]
  boom_.vibration().identify();
  boom_.vibration().rest();
  boom_.moveCompliant(motion_, {0.0, 0.0, -test::kGravity});
  const auto surpriseBy = [&](double size) {
    VibrationReading reading = oilTorqueReading(kBoomJoint, 0.0);
    reading.channel = 5, reading.clock = Clock::kPressures, reading.noise = 1e-3;
    for (int i = 0; i < 20000; ++i) {
      reading.value = i % 2 == 0 ? size : -size;
      boom_.vibration().observe(&reading, 1);
    }
    return boom_.vibration().identifier()->oilSurprise();
  };
  for (int i = 0; i < 4000; ++i) read(kSwing * std::sin(0.2 * i));
  for (const double size : {0.9e-3, 1.12e-3}) {
    const double surprise = surpriseBy(size);
    ASSERT_NEAR(surprise, square(size / 1e-3), 0.01);
    sample(0.0);
    if (surprise < 1.0)
      EXPECT_LT(torque().deviation, 0.05 * kSwing);
    else
      expectRoundly(torque().deviation, 0.4 * std::sqrt(surprise) * kSwing / std::sqrt(2.0));
  }
}

/// Less than a twentieth of the boom's weight, as well as that is known, is no rock that bears on the hull.
TEST(MeasuredRock, BearsFromATwentiethOfTheBoomsWeightOn) {
  constexpr double kToTool = 0.2;  // [m]
  const Boom shipped = test::shippedBoom();
  const double least = 0.05 * test::kGravity * massFrom(shipped.chain(), shipped.pose(), 1).mass;
  for (const double part : {0.8, 1.25}) {
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
