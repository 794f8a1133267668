// How long the vibration remembers its swing and how far ahead it says where the boom is: each within a factor of 1.25
// of what is said.
#include "boom/identifier_on_boom.h"

namespace hammer_loads {
namespace {

using test::expectAround;

class VibrationNumbers : public testing::Test {
 protected:
  VibrationNumbers() : boom_(*Boom::make(test::shippedUrdf(), damped()).value) {
    boom_.moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  }
  static BoomParameters damped() {
    BoomParameters p = test::shippedBoomParameters();
    p.vibration.damping_ratio = 0.5;
    return p;
  }
  void hold(double torque, double time) {
    const JointVector by = JointVector::Constant(4, torque);
    for (int i = 0; i < std::lround(1e3 * time); ++i) boom_.vibration().advance(1e-3, {by, by, by});
  }
  /// From rest to a speed of the joints.
  JointVector strike(double size) {
    boom_.vibration().strike(JointVector::Constant(4, size));
    return boom_.vibration().velocity();
  }

  Boom boom_;
};

/// Of a load that was held for long and is let go; its own motion is over sooner.
TEST_F(VibrationNumbers, OfTheUsualSwing) {
  hold(500.0, 8.0);
  const double held = square(boom_.vibration().usualSwing()[0]);
  hold(0.0, 0.5);
  const double first = square(boom_.vibration().usualSwing()[0]);
  hold(0.0, 1.0);
  EXPECT_LT(first, held);
  expectAround(first / square(boom_.vibration().usualSwing()[0]), std::exp(1.0));
}

/// Of a steady force, some two thirds of which are the least that counts.
TEST_F(VibrationNumbers, OfTheRocksMeanForce) {
  constexpr double kForce = 2e4;
  const JointVector by_newton = boom_.hammerTorque({{0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}}), none = JointVector::Zero(4);
  double time = 0.0;
  for (; boom_.vibration().contact() == 0.0 && time < 5.0; time += 1e-3) {
    boom_.vibration().followContact(by_newton, (1.0 - std::exp(-1.0)) * kForce);
    boom_.vibration().advance(1e-3, {none, none, none});
    for (int joint = 1; joint < 4; ++joint) {
      VibrationReading reading = oilTorqueReading(joint, kForce * by_newton[joint]);
      reading.noise = 100.0, reading.clock = Clock::kPressures;
      boom_.vibration().observe(joint, reading);
    }
  }
  expectAround(time, 0.5);
}

TEST_F(VibrationNumbers, OfADisplacementAhead) {
  const JointVector rate = strike(1.0);
  expectAround(boom_.vibration().displacementAfter(10.0).norm() / rate.norm(), 0.02);
  expectAround(boom_.vibration().displacementAfter(0.01).norm() / rate.norm(), 0.01);
}

TEST_F(VibrationNumbers, OfADisplacementThatIsNone) {
  double largest = 0.0;
  for (int i = 0; i < 10000; ++i) {
    strike(1.0);
    const JointVector ahead = boom_.vibration().displacementAfter(0.01);
    if (ahead.isZero(0.0)) break;
    largest = ahead.cwiseAbs().maxCoeff();
  }
  expectAround(largest, 0.1);
}

}  // namespace
}  // namespace hammer_loads
