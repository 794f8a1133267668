// Oil and delays that the mode identifier finds on the shipped boom, without any pipeline.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "boom/booms.h"
#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

/// Shaken by pulses that are known exactly, seen by the joints' accelerations.
class IdentifiedOil : public testing::Test {
 protected:
  IdentifiedOil() : boom_(*Boom::make(test::shippedUrdf(), test::shippedBoomParameters()).value) {
    const JointMotion held{test::workingPosition(), test::kZero, test::kZero};
    boom_.moveCompliant(held, test::kLevel);
    boom_.vibration().rest();
    boom_.moveCompliant(held, test::kLevel);
    modes_ = boom_.vibration().modes();
    past_.fill(test::kZero), forces_.fill(JointVector::Zero(modes_.count));
  }
  ModeIdentifier identifier() const {
    ModeIdentifier found(0.07, true);
    found.setModes(modes_);
    return found;
  }
  /// Without any force.
  void wait(ModeIdentifier& found, double time) const {
    const JointVector none = JointVector::Zero(modes_.count);
    for (int i = 0; i < std::lround(time / 1e-3); ++i) found.advance(1e-3, {none, none, none});
  }
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

  Boom boom_;
  BoomModes modes_;
  std::array<ModeState, kMaxJoints> truth_{};
  std::array<JointVector, 64> past_;    ///< accelerations of the joints
  std::array<JointVector, 64> forces_;  ///< modal
  JointVector force_ = JointVector::Zero(3);
  int samples_{}, late_{};  ///< late_: readings by which a clock is late; below 0: by which the hammer is
};

/// Readings 3 ms late, in mid air and on rock.
TEST_F(IdentifiedOil, FindsADelayWithinItsDeviation) {
  for (const bool rock : {false, true}) {
    ModeIdentifier found = identifier();
    late_ = 3;
    found.bear(rock);
    run(found, 8.0, Clock::kImu);
    EXPECT_NEAR(found.delay(Clock::kImu), 3e-3, 3e-4) << rock;
    const double soon = found.delayDeviation(Clock::kImu);
    EXPECT_LT(std::abs(found.delay(Clock::kImu) - 3e-3), 2.0 * soon) << rock;
    wait(found, 0.2);
    EXPECT_GT(found.delayDeviation(Clock::kImu), soon) << "without readings it is known less well";
  }
}

/// Whichever way a clock is off, the motion is what the modes do at the crank's stamps.
TEST_F(IdentifiedOil, GivesTheMotionAtTheCrankForAClockThatIsOff) {
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

}  // namespace
}  // namespace hammer_loads
