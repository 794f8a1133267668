// Frequencies and damping identified from noisy sensors on a reference machine with its own mass matrix, stiffness from
// the cylinders' triangles by differences, and Rayleigh damping. Its motion is integrated in small steps.
#include "hammer_loads/boom/mode_identifier.h"

#include <gtest/gtest.h>

#include "boom/identifier_session.h"

namespace hammer_loads {
namespace {

using test::IdentifierSession;
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
    // The first two modes carry the vibration. The third, at 20 Hz and more, moves a joint by less than its sensor's
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

TEST(ModeIdentifier, FindsNothingWithoutReadings) {
  IdentifierSession run(0.7, Sensor::kImu);
  const double before = run.identifier().frequencyVariance(0);
  const JointVector torque = JointVector::Constant(4, 1e3);
  for (int i = 0; i < 5000; ++i) run.boom_->vibration().advance(kMillisecond, {torque, torque, torque});
  EXPECT_EQ(run.identifier().frequencyRatio(0), 1.0);
  EXPECT_GE(run.identifier().frequencyVariance(0), before);
  EXPECT_FALSE(run.identifier().identified());
}

TEST(ModeIdentifier, SurvivesNonsenseAndAForceThatIsAFewPercentWrong) {
  IdentifierSession run(0.7, Sensor::kImu);
  run.run(12.0, 0.05);
  // The third mode depends on the same three stiffnesses and is hardly excited.
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(run.frequencyError(k)), k < 2 ? 0.025 : 0.04) << k;
  // A reading a thousand times too large has little effect. A NaN has none.
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

TEST(ModeIdentifier, ModesAreThoseOfTheOilFound) {
  IdentifierSession run(0.7, Sensor::kPressures);
  run.run(12.0);
  Boom right = test::shippedBoom();  // with the machine's bulk modulus
  right.moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  const BoomModes& modes = run.boom_->vibration().modes();
  const auto overRight = [&] { return modes.given_omega[0] / right.vibration().modes().given_omega[0]; };
  EXPECT_NEAR(overRight(), std::sqrt(0.7), 0.02);
  const JointVector omega = modes.omega;
  run.boom_->moveCompliant({test::workingPosition(), test::kZero, test::kZero}, test::kLevel);
  EXPECT_NEAR(overRight(), 1.0, 0.02);
  EXPECT_LT((modes.omega - omega).cwiseQuotient(omega).cwiseAbs().maxCoeff(), 0.002) << "what is found stays";
}

}  // namespace
}  // namespace hammer_loads
