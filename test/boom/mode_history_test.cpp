// What a mode did some ms ago, against its closed solution.
#include "hammer_loads/boom/mode_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kSwing = 60.0, kStep = 1e-3;  // [rad/s]; [s]
constexpr int kSecondMode = 1;

/// Swings freely, from a time on by a blow as well.
struct SwingOfMode {
  double size{1.0}, phase{}, blow{}, blow_time{1e9};

  ModeState at(double t) const {
    const double s = kSwing * t + phase, after = t > blow_time ? kSwing * (t - blow_time) : 0.0;
    return {size * std::cos(s) + blow / kSwing * std::sin(after),
            -kSwing * size * std::sin(s) + (t > blow_time ? blow * std::cos(after) : 0.0)};
  }
};

class History : public testing::Test {
 protected:
  /// Steps of 1 ms to the given end, as the estimate has them.
  void follow(const SwingOfMode& estimate, double end) {
    for (; time_ < end - 1e-9; time_ += kStep) {
      history_.begin(kStep);
      const double before_blow = time_ + kStep - 1e-12;
      history_.set(kSecondMode, estimate.at(time_ + 1e-12), estimate.at(before_blow), time_, time_ + kStep);
      if (std::abs(time_ + kStep - estimate.blow_time) < 1e-9) history_.strike(kSecondMode, estimate.blow);
    }
  }
  void expectAt(double ago, const SwingOfMode& truth, double tolerance) {
    ModeHistory::Place place;
    ASSERT_TRUE(history_.find(ago, place)) << ago;
    const ModeHistory::Moment then = history_.at(place, kSecondMode, kSwing, truth.at(time_ + 1e-12));
    const ModeState right = truth.at(time_ - ago);
    EXPECT_NEAR(then.state.x, right.x, tolerance) << ago;
    EXPECT_NEAR(then.state.v, right.v, kSwing * tolerance) << ago;
    EXPECT_NEAR(then.force, time_ - ago, 1e-12) << ago;
    EXPECT_NEAR(then.force_rate, 1.0, 1e-9) << ago;
  }

  ModeHistory history_;
  double time_{};
};

TEST_F(History, IsWhatTheModeDid) {
  const SwingOfMode swing{1.0, 0.3};
  follow(swing, 0.02);
  for (const double ago : {0.0, 1e-5, 0.4e-3, 1e-3, 3.7e-3, 0.015}) expectAt(ago, swing, 2e-6);
}

TEST_F(History, KnowsOfABlowThatItWasNotBefore) {
  const SwingOfMode swing{1.0, 0.3, 50.0, 0.017};
  follow(swing, 0.02);
  for (const double ago : {0.5e-3, 2.5e-3, 3.5e-3, 9.3e-3}) expectAt(ago, swing, 1e-5);
}

/// An estimate that was wrong was so before as well.
TEST_F(History, CountsWhatReadingsHaveShownSince) {
  follow({0.7, 0.1, 50.0, 0.017}, 0.02);
  for (const double ago : {1e-5, 2.5e-3, 3.5e-3, 9.3e-3}) expectAt(ago, {1.0, 0.3, 50.0, 0.017}, 1e-4);
}

TEST_F(History, EndsSomewhere) {
  ModeHistory::Place place;
  EXPECT_FALSE(history_.find(0.0, place));
  follow({}, 0.005);
  EXPECT_TRUE(history_.find(4.9e-3, place));
  EXPECT_FALSE(history_.find(5.1e-3, place));
  follow({}, 0.2);
  EXPECT_TRUE(history_.find(kStep * (ModeHistory::kSteps - 0.5), place));
  EXPECT_FALSE(history_.find(kStep * (ModeHistory::kSteps + 0.5), place));
  history_.clear();
  EXPECT_FALSE(history_.find(1e-3, place));
}

}  // namespace
}  // namespace hammer_loads
