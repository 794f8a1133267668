// What the mode identifier knows before any reading, how fast that fades, and within which bounds it stays: each within
// a factor of 1.25 of what is said.
#include "boom/identifier_on_boom.h"

namespace hammer_loads {
namespace {

using test::expectAround;
using IdentifierNumbers = test::IdentifierOnBoom;

TEST_F(IdentifierNumbers, OfOilAndDampingBeforeAnyReading) {
  const ModeIdentifier found = identifier();
  expectAround(std::sqrt(found.oilCovariance(0, 1)), 0.3);
  expectAround(found.dampingDeviation(0), 0.5);
}

TEST_F(IdentifierNumbers, OfTheOilsBounds) {
  for (const double way : {-1.0, 1.0}) {
    ModeIdentifier found = identifier();
    found.setModes(modes_, LogOil::Constant(way * 7.0));
    expectAround(-way * found.oil()[0], 2.0);
  }
}

TEST_F(IdentifierNumbers, OfTheDampingsBounds) {
  for (const double given : {1e-4, 0.99}) {
    ModeIdentifier found = identifier(given);
    found.setModes(modes_);
    expectAround(found.damping(0), given < 0.01 ? 2e-3 : 0.7);
  }
}

/// Joints turn at 0.05 rad/s, the one that moves most.
TEST_F(IdentifierNumbers, OfAMotionThatIsNotKnown) {
  const ModeIdentifier found = identifier(0.02, false);
  for (int k = 0; k < modes_.count; ++k) {
    const double rate = 0.05 / modes_.shape.col(k).cwiseAbs().maxCoeff();
    expectAround(accelerationDeviation(found, k), modes_.omega[k] * rate);
  }
}

TEST_F(IdentifierNumbers, OfTheRocksForce) {
  ModeIdentifier found = identifier();
  found.followContact(JointVector::Constant(4, 1.0));
  expectAround(found.contactDeviation(), 1e4);
  wait(found, 1.0);
  expectAround(std::sqrt(square(found.contactDeviation()) - 1e8), 1.3e5);
}

/// Landings are seen for a tenth of a second after a reading of the IMU.
TEST_F(IdentifierNumbers, OfTheRocksForceWhereAnImuShowsIt) {
  ModeIdentifier found = identifier();
  found.followContact(JointVector::Constant(4, 1.0));
  found.bear(true);
  const auto grownOver = [&](double time) {
    const double before = square(found.contactDeviation());
    wait(found, time);
    return std::sqrt((square(found.contactDeviation()) - before) / time);
  };
  hear(found, Clock::kImu);
  expectAround(grownOver(0.08), 3e5);
  grownOver(0.04);
  expectAround(grownOver(0.05), 1.3e5);
}

/// Oil torques that come as they are expected.
TEST_F(IdentifierNumbers, OfTheSurpriseByOilTorques) {
  ModeIdentifier found = identifier();
  VibrationReading reading = oilTorqueReading(1, 0.0);
  reading.channel = 0, reading.noise = 100.0, reading.clock = Clock::kPressures;
  EXPECT_EQ(found.oilSurprise(), 1.0);
  for (int i = 0; i < 3333; ++i) found.observe(&reading, 1);
  expectAround(-std::log(found.oilSurprise()), 1.0);
}

/// The links move in the hull, and bend: of a motion that is known exactly, displaced and at rest.
TEST_F(IdentifierNumbers, OfWhatAModesShapeLacks) {
  const auto know = [&](double x, double v) {
    ModeIdentifier found = identifier(0.02, false);
    for (int round = 0; round < 4; ++round) {
      for (int k = 0; k < modes_.count; ++k) {
        for (const bool rate : {false, true}) {
          VibrationReading reading = jointAngleReading(1, 0.0);
          reading.displacement.setZero(), reading.channel = 2 * k + (rate ? 1 : 0);
          const JointVector row = modes_.inertia.col(k);  // picks this mode alone
          (rate ? reading.velocity : reading.displacement).head(row.size()) = row;
          reading.value = k == 0 ? (rate ? v : x) : 0.0, reading.noise = 1e-9;
          found.observe(&reading, 1);
        }
      }
    }
    return accelerationDeviation(found, 0);
  };
  const double omega = modes_.omega[0];
  expectAround(know(1.0, 0.0), 2.0 * 0.005 * omega * omega);
  expectAround(know(0.0, 10.0), 0.1 * 2.0 * 0.02 * omega * 10.0);
}

/// What the hammer's force is wrong by: 5 % of a blow's impulse, and of a lasting force over some 10 ms.
TEST_F(IdentifierNumbers, OfTheHammersForce) {
  ModeIdentifier found = identifier(0.02, false);
  const double before = square(accelerationDeviation(found, 0)), omega = modes_.omega[0];
  JointVector impulse = modes_.inertia.col(0) * 20.0;
  found.strike(impulse);
  const double damped = 2.0 * 0.02 * omega;
  expectAround(std::sqrt(square(accelerationDeviation(found, 0)) - before) / (damped * 20.0), std::hypot(0.05, 0.1));
}

/// And of a force that lasts: 5 % of its root mean square over some 2 s, the same way for 10 ms.
TEST_F(IdentifierNumbers, OfAForceThatLasts) {
  constexpr double kDamping = 0.5, kForce = 1e4;
  ModeIdentifier found = identifier(kDamping, false);
  const JointVector force = JointVector::Constant(modes_.count, kForce);
  const auto errorAfter = [&](double time) {
    for (int i = 0; i < std::lround(1e3 * time); ++i) found.advance(1e-3, {force, force, force});
    return square(accelerationDeviation(found, 0)) - square(2.0 * 0.005 * kForce);
  };
  const double soon = errorAfter(2.0), later = errorAfter(18.0);
  expectAround(soon / later, 1.0 - std::exp(-1.0));
  // White noise q: q / (4 zeta omega) of the velocity, over omega^2 of the displacement.
  const double q = square(0.05 * kForce) * 2.0 * 0.01, omega = modes_.omega[0];
  expectAround(later, q / (4.0 * kDamping * omega) * square(omega) * (1.0 + square(2.0 * kDamping)));
}

/// Accelerations that are as far off as counts: five times what they should be, or right again.
TEST_F(IdentifierNumbers, OfAccelerationsThatNothingExplains) {
  ModeIdentifier found = identifier(0.07, false);
  VibrationReading reading = jointAngleReading(1, 0.0);
  reading.displacement.setZero(), reading.acceleration[1] = 1.0, reading.channel = 0, reading.noise = 1e4;
  int samples = 0, again = 0;
  for (; found.explains() && samples < 10000; ++samples) {
    reading.value = samples % 2 == 0 ? 1e5 : -1e5;
    found.observe(&reading, 1);
  }
  expectAround(samples, std::log(24.0 / 20.0) / 3e-4);
  reading.value = 0.0;
  for (; !found.explains() && again < 10000; ++again) found.observe(&reading, 1);
  expectAround(again, std::log(5.0 / 1.8) / 3e-4);
}

}  // namespace
}  // namespace hammer_loads
