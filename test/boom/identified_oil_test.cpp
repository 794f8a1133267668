// What the mode identifier finds of oil and delays, how well it then knows them and how fast that fades: each within a
// factor of 1.25 of what is said.
#include <algorithm>
#include <array>

#include "boom/identifier_on_boom.h"

namespace hammer_loads {
namespace {

using test::expectAround;

/// Shaken by pulses that are known exactly, seen by the joints' accelerations.
class IdentifiedOil : public test::IdentifierOnBoom {
 protected:
  IdentifiedOil() { past_.fill(test::kZero), forces_.fill(JointVector::Zero(modes_.count)); }
  void run(ModeIdentifier& found, double time, Clock clock = Clock::kCrank) {
    for (int i = 0; i < std::lround(time / 1e-3); ++i, ++samples_) {
      const int early = std::max(-late_, 0);
      const double phase = std::fmod(1e-3 * samples_, 0.2113) / 0.018;
      const JointVector to =
          JointVector::Constant(modes_.count, phase < 1.0 ? 400.0 * std::sin(kTwoPi / 2.0 * phase) : 0.0);
      forces_[at(samples_)] = to;
      const JointVector& known_from = forces_[at(samples_ - early - 1)];
      const JointVector& known = forces_[at(samples_ - early)];
      found.advance(1e-3, {known_from, known, 0.5 * (known_from + known)});
      JointVector modal(modes_.count);
      for (int k = 0; k < modes_.count; ++k) {
        const Mode mode{modes_.omega[k], 0.07};
        ModeState& now = truth_[static_cast<std::size_t>(k)];
        now = advanced(stepOf(mode, 1e-3), now, pathOf({force_[k], to[k], 0.5 * (force_[k] + to[k])}, 1e-3));
        modal[k] = acceleration(mode, now, to[k]);
      }
      force_ = to;
      past_[at(samples_)] = jointsOf(modes_, modal);
      const auto waits = static_cast<int>(std::ceil(found.waiting() / 1e-3));
      const JointVector seen = past_[at(samples_ - std::max(late_, 0) - waits)];
      for (int j = 1; j < 4; ++j) {
        VibrationReading reading = jointAngleReading(j, seen[j]);
        std::swap(reading.displacement, reading.acceleration);
        reading.channel = j, reading.noise = 0.02, reading.clock = clock, reading.ahead = -1e-3 * waits;
        found.observe(&reading, 1);
      }
    }
  }
  static std::size_t at(int sample) { return static_cast<std::size_t>((sample + 64) % 64); }

  std::array<ModeState, kMaxJoints> truth_{};
  std::array<JointVector, 64> past_;    ///< accelerations of the joints
  std::array<JointVector, 64> forces_;  ///< modal
  JointVector force_ = JointVector::Zero(3);
  int samples_{}, late_{};  ///< late_: readings by which a clock is late; below 0: by which the hammer is
};

TEST_F(IdentifiedOil, WandersAsItWarmsUp) {
  ModeIdentifier found = identifier();
  run(found, 3.0);
  ASSERT_TRUE(found.identified());
  const double oil = found.oilCovariance(0, 0), damping = found.dampingVariance(0);
  ASSERT_LT(oil, square(0.1));
  wait(found, 100.0, 0.1);
  expectAround(std::sqrt((found.oilCovariance(0, 0) - oil) / 100.0), 0.004);
  expectAround(std::sqrt((found.dampingVariance(0) - damping) / 100.0), 0.01);
}

TEST_F(IdentifiedOil, IsIdentifiedAtThreePercentOfAFrequency) {
  ModeIdentifier found = identifier();
  for (int i = 0; i < 5000 && !found.identified(); ++i) run(found, 1e-3);
  double worst = 0.0;
  for (int k = 0; k < modes_.count; ++k) worst = std::max(worst, found.frequencyDeviation(k));
  expectAround(worst, 0.03);
}

/// A clock's delay is looked for some time after that; what the oil was taken for without it may be wrong, and is found
/// anew for as long as the delay takes.
TEST_F(IdentifiedOil, AClocksDelayIsLookedForAFifthOfASecondLater) {
  ModeIdentifier found = identifier();
  for (int i = 0; i < 5000 && !found.identified(); ++i) run(found, 1e-3);
  run(found, 0.16);
  hear(found, Clock::kImu);
  EXPECT_EQ(found.delayDeviation(Clock::kImu), 0.0);
  run(found, 0.09);
  const double oil = found.oilCovariance(0, 0), damping = found.dampingVariance(0);
  hear(found, Clock::kImu);
  expectAround(found.delayDeviation(Clock::kImu), 2e-3);
  for (const double share : {0.5, 1.0}) {
    wait(found, 0.5);
    expectAround(std::sqrt(found.oilCovariance(0, 0) - oil), std::sqrt(share) * 0.1);
    expectAround(std::sqrt(found.dampingVariance(0) - damping), std::sqrt(share) * 0.5);
  }
}

/// A clock drifts by some 20 ppm.
TEST_F(IdentifiedOil, AClocksDelayWanders) {
  ModeIdentifier found = identifier();
  run(found, 4.0, Clock::kImu);
  wait(found, 0.2);
  const double before = square(found.delayDeviation(Clock::kImu));
  ASSERT_GT(before, 0.0);
  wait(found, 20.0, 0.1);
  expectAround(std::sqrt((square(found.delayDeviation(Clock::kImu)) - before) / 20.0), 2e-5);
}

/// Readings 3 ms late: what is found of that may be wrong by a part, the more the less shows it. A hull on rock makes
/// no difference.
TEST_F(IdentifiedOil, ADelayThatIsFoundIsKnownByAPart) {
  for (const bool rock : {false, true}) {
    ModeIdentifier found = identifier();
    late_ = 3;
    found.bear(rock);
    run(found, 8.0, Clock::kImu);
    EXPECT_NEAR(found.delay(Clock::kImu), 3e-3, 3e-4) << rock;
    expectAround(found.delayDeviation(Clock::kImu), 0.05 * 3e-3);
    wait(found, 0.2);
    expectAround(found.delayDeviation(Clock::kImu), 0.3 * 3e-3);
  }
}

/// As much of a common delay is taken for the crank's as its model expects within 0.6 of its deviations.
TEST_F(IdentifiedOil, WhatAllClocksHaveInCommonMayBeTheCranks) {
  ModeIdentifier found = identifier();
  late_ = 3;
  run(found, 8.0, Clock::kImu);
  const double common = found.delay(Clock::kImu);
  found.expectCrankLead({common - 1e-3, 1e-3 / 0.6 / 0.95});
  EXPECT_NEAR(found.crankLead(), common, 1e-9);
  EXPECT_NEAR(found.delayDeviation(Clock::kImu), 0.3 * common, 0.05 * common);
  found.expectCrankLead({common - 1e-3, 1e-3 / 0.6 / 1.25});
  EXPECT_NEAR(found.crankLead(), common - 1e-3 + 1e-3 / square(1.25), 5e-5);
}

/// Whichever way a clock is off, the motion is what the modes do at the crank's stamps.
TEST_F(IdentifiedOil, OfAClockThatIsOffTheMotionIsThatAtTheCrank) {
  for (const int late : {3, -3}) {
    ModeIdentifier found = identifier();
    late_ = late;
    run(found, 6.0, Clock::kImu);
    EXPECT_NEAR(found.delay(Clock::kImu), 1e-3 * late, 5e-5);
    std::array<double, 16> by_crank{};  // displacements of the slowest mode, as the crank's stamps have them
    double error = 0.0, size = 0.0;
    for (std::size_t i = 0; i < 1000; ++i) {
      run(found, 1e-3, Clock::kImu);
      by_crank[i % 16] = truth_[0].x;
      if (i < 16) continue;
      const double truth = by_crank[(i - static_cast<std::size_t>(std::max(-late, 0))) % 16];
      error += square(found.motion(0).x - truth), size += square(truth);
    }
    EXPECT_LT(std::sqrt(error / size), 0.01) << late;
  }
}

TEST_F(IdentifiedOil, StampsAreNeverLaterThanTwelveMillisecondsNorEarlierThanFour) {
  for (const int late : {16, -6}) {
    ModeIdentifier found = identifier();
    run(found, 4.0);
    late_ = late;
    double most = 0.0;
    for (int i = 0; i < 6000; ++i) {
      run(found, 1e-3, Clock::kImu);
      most = std::max(most, std::copysign(1.0, late) * found.delay(Clock::kImu));
    }
    expectAround(most, late > 0 ? 0.012 : 0.004);
  }
}

TEST_F(IdentifiedOil, PressuresShowTheirDelayAfterASecondWithoutRock) {
  ModeIdentifier found = identifier();
  run(found, 4.0);
  found.followContact(JointVector::Constant(4, 1.0));
  wait(found, 0.8);
  hear(found, Clock::kPressures);
  EXPECT_EQ(found.delayDeviation(Clock::kPressures), 0.0);
  wait(found, 0.45);
  hear(found, Clock::kPressures);
  EXPECT_GT(found.delayDeviation(Clock::kPressures), 0.0);
}

}  // namespace
}  // namespace hammer_loads
