// Frequencies and damping from noisy sensors on a boom that a hand-made chain vibrates: its own mass matrix, stiffness
// from the cylinders' triangles by differences, damping by Rayleigh, integrated in small steps.
#include "hammer_loads/boom/mode_identifier.h"

#include <gtest/gtest.h>

#include "boom/identifier_session.h"

namespace hammer_loads {
namespace {

using test::IdentifierSession;
using test::kGravity;
using test::kMillisecond;
using test::Sensor;

struct WrongOil {
  double given_over_true;
  Sensor sensor;
  const char* name;
  friend std::ostream& operator<<(std::ostream& out, const WrongOil& oil) { return out << oil.name; }
};
class Oil : public testing::TestWithParam<WrongOil> {};

TEST_P(Oil, IsIdentifiedFromANoisySensor) {
  const WrongOil& oil = GetParam();
  double worst_frequency = 0.0, worst_torque = 0.0;
  for (unsigned seed : {1U, 2U}) {
    IdentifierSession run(oil.given_over_true, oil.sensor, seed);
    EXPECT_FALSE(run.identifier().identified());
    EXPECT_GT(std::abs(run.frequencyError(0)), 0.14);
    run.run(12.0);
    EXPECT_TRUE(run.identifier().identified());
    // The two modes that carry the vibration; the third, at 20 Hz and more, moves a joint by less than its sensor's
    // noise.
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT(std::abs(run.frequencyError(k)), 0.01) << k;
      EXPECT_LT(std::abs(run.dampingError(k)), 0.15) << k;
      worst_frequency = std::max(worst_frequency, std::abs(run.frequencyError(k)));
    }
    EXPECT_LT(std::abs(run.frequencyError(2)), 0.08);
    EXPECT_EQ(run.allocations_, 0U);
    worst_torque = std::max(worst_torque, run.torqueError(4.0));
  }
  EXPECT_LT(worst_torque, 0.05);
  IdentifierSession given(oil.given_over_true, oil.sensor, 1, false);
  given.run(12.0);
  const double torque_as_given = given.torqueError(4.0);
  EXPECT_GT(torque_as_given, 0.25);
  RecordProperty("frequency_error", format("%.2g", worst_frequency));
  RecordProperty("torque_error", format("%.2g", worst_torque));
  RecordProperty("torque_error_as_given", format("%.2g", torque_as_given));
}

INSTANTIATE_TEST_SUITE_P(BulkModulus, Oil,
                         testing::Values(WrongOil{0.7, Sensor::kImu, "SoftImu"},
                                         WrongOil{1.4, Sensor::kImu, "StiffImu"},
                                         WrongOil{0.7, Sensor::kSlowImu, "SoftImu200Hz"},
                                         WrongOil{1.4, Sensor::kSlowImu, "StiffImu200Hz"},
                                         WrongOil{0.7, Sensor::kJoints, "SoftJoints200Hz"},
                                         WrongOil{1.4, Sensor::kJoints, "StiffJoints200Hz"},
                                         WrongOil{0.7, Sensor::kPressures, "SoftPressures"},
                                         WrongOil{1.4, Sensor::kPressures, "StiffPressures"}),
                         [](const auto& named) { return named.param.name; });

/// Readings of one instant in one call or each in its own: pressures are the same, an IMU's differ by the second order.
TEST(ModeIdentifier, GivesEqualResultsForReadingsTogetherAndOneByOne) {
  for (const Clock clock : {Clock::kPressures, Clock::kImu}) {
    IdentifierSession run(0.7, Sensor::kPressures);
    run.run(1.0);  // frequencies are still being learned
    const Vibration& before = run.boom_->vibration();
    Vibration together = before, apart = before;
    std::array<VibrationReading, 3> readings;
    for (int j = 1; j < 4; ++j) {
      VibrationReading& one = readings[static_cast<std::size_t>(j - 1)];
      one = oilTorqueReading(j, run.machine_.hold()[j - 1] + 50.0 * j);
      one.noise = 200.0, one.offset_std = 1000.0, one.clock = clock;
      one.channel = j == 3 ? 7 : j;  // one that has not been used
    }
    together.observe(readings.data(), readings.size());
    for (const VibrationReading& one : readings) apart.observe(one.channel, one);
    const double known = clock == Clock::kPressures ? 1e-9 : 0.1;  // of the change
    const ModeIdentifier &a = *together.identifier(), &b = *apart.identifier(), &old = *before.identifier();
    EXPECT_LT((a.displacement() - b.displacement()).norm(), known * (a.displacement() - old.displacement()).norm());
    EXPECT_LT((a.velocity() - b.velocity()).norm(), known * (a.velocity() - old.velocity()).norm());
    for (int k = 0; k < 3; ++k) {
      const double change = std::abs(a.frequencyRatio(k) - old.frequencyRatio(k));
      EXPECT_LT(std::abs(a.frequencyRatio(k) - b.frequencyRatio(k)), known * change + 1e-12) << k;
      EXPECT_NEAR(a.frequencyDeviation(k) / b.frequencyDeviation(k), 1.0, known) << k;
      EXPECT_GT(change, 1e-6) << k;
    }
  }
}

TEST(ModeIdentifier, FindsNothingWithoutReadings) {
  IdentifierSession run(0.7, Sensor::kImu);
  const double before = run.identifier().frequencyDeviation(0);
  const JointVector torque = JointVector::Constant(4, 1e3);
  for (int i = 0; i < 5000; ++i) run.boom_->vibration().advance(kMillisecond, {torque, torque, torque});
  EXPECT_EQ(run.identifier().frequencyRatio(0), 1.0);
  EXPECT_GE(run.identifier().frequencyDeviation(0), before);
  EXPECT_FALSE(run.identifier().identified());
}

TEST(ModeIdentifier, SurvivesNonsenseAndAForceThatIsAFewPercentWrong) {
  IdentifierSession run(0.7, Sensor::kImu);
  run.run(12.0, 0.05);
  // The third mode hangs on the same three stiffnesses, and is hardly moved.
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(run.frequencyError(k)), k < 2 ? 0.025 : 0.04) << k;
  // A reading of a thousand times its size moves little; one that is no number nothing.
  const double ratio = run.identifier().frequencyRatio(0);
  VibrationReading reading = jointAngleReading(1, 100.0);
  reading.noise = 1e-4, reading.offset_std = 0.01;
  run.boom_->vibration().observe(5, reading);
  EXPECT_NEAR(run.identifier().frequencyRatio(0), ratio, 0.02);
  reading.value = std::nan("");
  run.boom_->vibration().observe(5, reading);
  reading.value = 1e308;
  reading.velocity.setConstant(1e200);
  run.boom_->vibration().observe(5, reading);
  EXPECT_TRUE(std::isfinite(run.identifier().frequencyRatio(0)));
  run.boom_->vibration().observe(-1, reading);
  run.boom_->vibration().observe(ModeIdentifier::kMaxChannels, reading);
}

TEST(ModeIdentifier, AnotherPoseKeepsWhatIsKnown) {
  IdentifierSession run(0.7, Sensor::kImu);
  run.run(6.0);
  const JointVector x = run.identifier().displacement(), v = run.identifier().velocity(), zero = JointVector::Zero(4);
  const double of_arm = run.identifier().oilCovariance(1, 1), with_hammer = run.identifier().oilCovariance(1, 2);
  Boom right = test::shippedBoom();  // of the machine's oil
  const auto overRight = [&](const JointVector& position) {
    right.moveCompliant({position, zero, zero}, {0.0, 0.0, -kGravity});
    return JointVector(run.boom_->vibration().modes().omega.cwiseQuotient(right.vibration().modes().omega));
  };
  const JointVector before = overRight(test::workingPosition());
  const JointVector position = test::workingPosition() + test::joints({0.0, 0.1, -0.1, 0.05});
  run.boom_->moveCompliant({position, zero, zero}, {0.0, 0.0, -kGravity});
  EXPECT_LT((run.identifier().displacement() - x).norm(), 1e-12);
  EXPECT_LT((run.identifier().velocity() - v).norm(), 1e-11);
  EXPECT_EQ(run.identifier().oilCovariance(1, 1), of_arm);
  EXPECT_EQ(run.identifier().oilCovariance(1, 2), with_hammer);
  EXPECT_LT((overRight(position) - before).cwiseAbs().maxCoeff(), 0.003);
  const JointVector omega = run.boom_->vibration().modes().omega;
  run.boom_->vibration().rest();
  EXPECT_TRUE(run.identifier().displacement().isZero(0.0));
  EXPECT_EQ(run.boom_->vibration().modes().omega, omega);
}

TEST(ModeIdentifier, ModesAreThoseOfTheOilFound) {
  IdentifierSession run(0.7, Sensor::kPressures);
  run.run(12.0);
  Boom right = test::shippedBoom();  // of the machine's oil
  right.moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  const BoomModes& modes = run.boom_->vibration().modes();
  const auto overRight = [&] { return modes.given_omega[0] / right.vibration().modes().given_omega[0]; };
  EXPECT_NEAR(overRight(), std::sqrt(0.7), 0.02);
  const JointVector omega = modes.omega;
  run.boom_->moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  EXPECT_NEAR(overRight(), 1.0, 0.02);
  EXPECT_LT((modes.omega - omega).cwiseQuotient(omega).cwiseAbs().maxCoeff(), 0.002) << "what is found stays";
}

TEST(VibrationSpread, WaitsWhereReadingsShowTheMotion) {
  IdentifierSession run(0.7, Sensor::kImu);
  run.run(6.0);
  const Vibration& vibration = run.boom_->vibration();
  ASSERT_TRUE(vibration.followsReadings());
  VibrationSpread spread;
  spread.follow(vibration);
  const auto damped = [&] { return spread.accelerationDifference(VibrationSpread::kDamped, vibration.acceleration()); };
  const JointVector difference = damped(), much = JointVector::Constant(4, 1e5);
  spread.advance(kMillisecond, {much, much, much}, LoadSpread(4, 0));
  EXPECT_EQ(damped(), difference);
  JointVector expected(3);  // the same motion with more damping
  for (int k = 0; k < 3; ++k) {
    const Mode mode = vibration.mode(k);
    const double more = std::exp(spread.deviation(k).damping) - 1.0;
    expected[k] = -2.0 * more * mode.zeta * mode.omega * vibration.motion(k).v;
  }
  EXPECT_LT((jointsOf(vibration.modes(), expected) - difference).norm(), 1e-9 * difference.norm());
  run.boom_->vibration().rest();  // a gap: readings show nothing any more
  spread.follow(vibration);
  spread.advance(kMillisecond, {much, much, much}, LoadSpread(4, 0));
  EXPECT_GT(damped().norm(), 1.0);
}

}  // namespace
}  // namespace hammer_loads
