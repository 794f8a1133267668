// The line through the stamps of a sensor that samples by its own clock.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "hammer_loads/crank/stamp_sequence.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
constexpr std::int64_t kClockStart = 1700000000000000000;

/// Bursts of ten whose stamps wander slowly: a clock by a tenth of the time between them.
TEST(SteadyClockFit, ExplainsBurstsThatComeRegularly) {
  for (const double part : {0.075, 0.135}) {
    SteadyClockFit fit;
    fit.begin(kClockStart);
    for (int i = 1; i < 20000; ++i) {
      const double wander = std::sqrt(2.0) * part * 10.0 * std::sin(0.3 * (i / 10));
      fit.add(kClockStart + static_cast<std::int64_t>((10 * (i / 10) + wander) * static_cast<double>(kMs)));
    }
    EXPECT_NEAR(fit.scatter() / (10.0 * static_cast<double>(kMs)), part, 0.012);
    EXPECT_EQ(fit.explains(), part < 0.1) << part;
  }
}

/// Every other stamp is early by a fifth of an interval, every other late.
class EvenClock {
 public:
  explicit EvenClock(int samples) {
    fit_.begin(kClockStart);
    for (int i = 1; i < samples; ++i) add(i, i % 2 == 0 ? 0.2 : -0.2);
    next_ = samples;
  }
  /// The next stamp, so many intervals late.
  SteadyClockFit next(double late) const {
    EvenClock other = *this;
    other.add(next_, late);
    return other.fit_;
  }
  void goOn(int samples, double interval) {
    double at = next_;
    for (int i = 0; i < samples; ++i) add(at += interval, 0.0);
  }
  const SteadyClockFit& fit() const { return fit_; }

 private:
  void add(double at, double late) {
    fit_.add(kClockStart + static_cast<std::int64_t>((at + late) * static_cast<double>(kMs)));
  }
  SteadyClockFit fit_;
  int next_{};
};

/// Odds of 20 to 1 by their scatter.
TEST(SteadyClockFit, AStampInItsPlaceContradictsALoss) {
  const EvenClock clock(2001);
  EXPECT_NEAR(clock.fit().scatter(), 0.2 * static_cast<double>(kMs), 0.01 * static_cast<double>(kMs));
  EXPECT_TRUE(clock.next(0.33).contradictsLoss());
  EXPECT_FALSE(clock.next(0.42).contradictsLoss());
}

/// One that is half an interval late among stamps without scatter counts as four hundredths of it, and moves a line
/// through n of them by four over n of that.
TEST(SteadyClockFit, OneStampAmongExactOnesHardlyMovesTheLine) {
  constexpr int kStamps = 200;
  SteadyClockFit fit;
  fit.begin(0);
  for (int i = 1; i < kStamps; ++i) fit.add(i * kMs);
  fit.add(kStamps * kMs + kMs / 2);
  const std::int64_t moved = fit.add((kStamps + 1) * kMs) - (kStamps + 1) * kMs;
  const double expected = 0.04 * static_cast<double>(kMs) * 4.0 / kStamps;
  EXPECT_NEAR(static_cast<double>(moved), expected, 0.1 * expected);
}

/// A quarter of the drift after 1500 samples of a line through 4096.
TEST(SteadyClockFit, FollowsAClockThatDriftsWithinFourThousandSamples) {
  EvenClock clock(30000);
  clock.goOn(1500, 1.0001);
  EXPECT_NEAR((clock.fit().interval() / static_cast<double>(kMs) - 1.0) / 1e-4, 0.25, 0.1);
}

}  // namespace
}  // namespace hammer_loads
