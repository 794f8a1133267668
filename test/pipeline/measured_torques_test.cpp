// How far torques of measured pressures are carried on and doubted between readings: each within a factor of 1.25 of
// what is said.
#include "hammer_loads/pipeline/measured_torques.h"

#include <gtest/gtest.h>

#include <cmath>

#include "boom/booms.h"
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

}  // namespace
}  // namespace hammer_loads
