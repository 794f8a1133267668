#include "hammer_loads/crank/stamp_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "support/constants.h"

namespace hammer_loads {
namespace {

using Kind = StampSequence::Kind;
using Repeats = StampSequence::Repeats;
constexpr std::int64_t kStart = 1700000000000000000;
using test::kMs;

/// Samples every millisecond, some of them lost; stamps as the way to the computer makes them.
struct Stream {
  std::vector<std::int64_t> taken, stamp;
};

Stream stream(int samples, double lost, const std::function<std::int64_t(std::int64_t, std::mt19937&)>& way) {
  std::mt19937 random(9);
  std::uniform_real_distribution<> any(0.0, 1.0);
  Stream s;
  for (int i = 0; i < samples; ++i) {
    if (any(random) < lost) continue;
    s.taken.push_back(kStart + i * kMs);
    s.stamp.push_back(way(s.taken.back(), random));
  }
  return s;
}

/// Root mean square of instant less taken about its mean, from a second on [s]; expects that instants increase. In the
/// first 0.1 s equal stamps may have none: whether they come in bursts is not known yet.
double scatterOf(StampSequence& sequence, const Stream& s) {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  std::int64_t last = 0;
  for (std::size_t i = 0; i < s.stamp.size(); ++i) {
    const StampSequence::Place place = sequence.place(s.stamp[i], Repeats::kNo);
    if (i > 0 && i < 100 && place.kind == Kind::kDuplicate && s.stamp[i] == s.stamp[i - 1]) continue;
    EXPECT_TRUE(place.kind == Kind::kPlaced || i == 0);
    EXPECT_GT(place.stamp, last);
    last = place.stamp;
    if (i < 1000) continue;
    const double error = 1e-9 * static_cast<double>(place.stamp - s.taken[i]);
    sum += error;
    squares += error * error;
    ++count;
  }
  return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

TEST(StampSequence, ExactStampsStayAsTheyAreAtAnyInterval) {
  StampSequence sequence(CrankStamps::kAuto, 0.25);
  std::mt19937 random(1);
  std::exponential_distribution<> interval(500.0);
  std::int64_t stamp = kStart;
  for (int i = 0; i < 20000; ++i) {
    const StampSequence::Place place = sequence.place(stamp, Repeats::kNo);
    ASSERT_EQ(place.stamp, stamp);
    stamp += 1 + static_cast<std::int64_t>(1e9 * interval(random));
  }
  EXPECT_FALSE(sequence.isSteady());
}

TEST(StampSequence, WholeMillisecondsAndBurstsGetTheirInstantsBack) {
  const auto whole = [](std::int64_t t, std::mt19937& random) {
    const auto jitter = static_cast<std::int64_t>(6e4 * std::normal_distribution<>()(random));
    return (t + jitter) / kMs * kMs;
  };
  StampSequence whole_milliseconds(CrankStamps::kAuto, 0.25);
  EXPECT_LT(scatterOf(whole_milliseconds, stream(15000, 0.002, whole)), 2.5e-4);
  for (const int length : {4, 10}) {
    Stream bursts = stream(15000, 0.002, [](std::int64_t t, std::mt19937&) { return t + 20000; });
    const auto n = static_cast<std::size_t>(length);
    for (std::size_t i = 0; i < bursts.stamp.size(); ++i)
      bursts.stamp[i] = bursts.stamp[std::min(bursts.stamp.size() - 1, i / n * n + n - 1)];
    StampSequence sequence(CrankStamps::kAuto, 0.25);
    EXPECT_LT(scatterOf(sequence, bursts), 2.5e-4) << length;
    EXPECT_TRUE(sequence.isSteady());
  }
}

/// Their first instants would be a microsecond apart: for a crank filter a machine that breaks all bounds, for seconds.
TEST(StampSequence, InstantsOfBurstsAreRightOrNone) {
  for (const int interval : {1, 5}) {
    StampSequence sequence(CrankStamps::kAuto, 0.25);
    double worst = 0.0;
    int placed = 0;
    for (int i = 0; i < 200; ++i) {
      const StampSequence::Place place = sequence.place(kStart + (i / 10 * 10 + 9) * interval * kMs, Repeats::kNo);
      if (i % 10 == 0 || place.kind != Kind::kPlaced) continue;  // the first of each has its stamp
      const double late = static_cast<double>(place.stamp - (kStart + i * interval * kMs));
      worst = std::max(worst, std::abs(late / static_cast<double>(interval * kMs)));
      ++placed;
    }
    EXPECT_GT(placed, 100) << interval;
    EXPECT_LT(worst, 0.05) << interval << ": of an interval";
  }
}

TEST(StampSequence, FollowsTheLineWhereManyChangePlaces) {
  const auto jitter = [](std::int64_t t, std::mt19937& random) {
    return t + static_cast<std::int64_t>(1e6 * std::normal_distribution<>()(random));
  };
  StampSequence sequence(CrankStamps::kAuto, 0.25);
  EXPECT_LT(scatterOf(sequence, stream(15000, 0.0, jitter)), 2e-4);
  EXPECT_TRUE(sequence.isSteady());
}

/// While the readings exclude a loss, stamps that wander by whole intervals move no line.
TEST(StampSequence, ReadingsThatCountOutweighStampsThatWander) {
  for (const bool counted : {false, true}) {
    StampSequence sequence(CrankStamps::kSteady, 0.25);
    double worst = 0.0;
    for (int i = 0; i < 6000; ++i) {
      const std::int64_t wander = i >= 4000 && i < 4060 ? 3 * kMs / 2 : 0;
      const std::int64_t instant = sequence.place(kStart + i * kMs + wander, Repeats::kNo).stamp;
      sequence.confirm(counted);
      if (i > 1000) worst = std::max(worst, std::abs(1e-9 * static_cast<double>(instant - kStart - i * kMs)));
    }
    if (counted)
      EXPECT_LT(worst, 0.3e-3);
    else
      EXPECT_GT(worst, 0.9e-3) << "lost samples, as far as stamps alone show";
  }
}

TEST(StampSequence, AGapGoesOnByWholeIntervals) {
  Stream s = stream(8000, 0.0, [](std::int64_t t, std::mt19937&) { return t / (10 * kMs) * 10 * kMs; });
  const auto from = static_cast<std::ptrdiff_t>(5000), to = from + 100;
  s.taken.erase(s.taken.begin() + from, s.taken.begin() + to);
  s.stamp.erase(s.stamp.begin() + from, s.stamp.begin() + to);
  StampSequence sequence(CrankStamps::kSteady, 0.25);
  EXPECT_LT(scatterOf(sequence, s), 1e-4);
}

TEST(StampSequence, EqualStampsOfIrregularSamplesOnlyStepOn) {
  StampSequence sequence(CrankStamps::kAuto, 0.25);
  std::mt19937 random(2);
  std::uniform_real_distribution<> any(0.0, 1.0);
  std::int64_t stamp = kStart, last = 0;
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t instant = sequence.place(stamp, Repeats::kNo).stamp;
    ASSERT_GT(instant, last);
    ASSERT_LT(std::abs(instant - stamp), 20 * kMs);
    last = instant;
    if (any(random) > 0.1) stamp += static_cast<std::int64_t>(1e9 * 0.02 * any(random) * any(random));
  }
  EXPECT_FALSE(sequence.isSteady());
}

TEST(StampSequence, KnowsDuplicatesLateOnesAndTimeThatRanBack) {
  StampSequence sequence(CrankStamps::kAuto, 0.25);
  EXPECT_EQ(sequence.place(kStart, Repeats::kNo).kind, Kind::kRestart);
  for (int i = 1; i < 200; ++i) EXPECT_EQ(sequence.place(kStart + i * kMs, Repeats::kNo).kind, Kind::kPlaced);
  const std::int64_t last = kStart + 199 * kMs;
  EXPECT_EQ(sequence.place(last, Repeats::kWithinCount).kind, Kind::kDuplicate);
  const StampSequence::Place late = sequence.place(last - 3 * kMs, Repeats::kNo);
  EXPECT_EQ(late.kind, Kind::kPlaced);
  EXPECT_GT(late.stamp, last);
  EXPECT_LE(late.stamp, last + kMs);
  EXPECT_EQ(sequence.place(last + 2 * kMs, Repeats::kNo).stamp, last + 2 * kMs);
  EXPECT_EQ(sequence.place(last - 400 * kMs, Repeats::kNo).kind, Kind::kOutOfOrder);
  EXPECT_EQ(sequence.place(last + 3 * kMs, Repeats::kNo).stamp, last + 3 * kMs) << "a single one was only late";
  EXPECT_EQ(sequence.place(last - 900 * kMs, Repeats::kNo).kind, Kind::kOutOfOrder);
  EXPECT_EQ(sequence.place(last - 899 * kMs, Repeats::kNo).kind, Kind::kRestart);
  EXPECT_EQ(sequence.place(last, Repeats::kNo).kind, Kind::kRestart) << "a gap";
}

/// Samples at `rate` [Hz] whose instants scatter [ns], stamped in steps [ns].
double roundingOf(double rate, std::int64_t step, std::int64_t scatter) {
  StampRounding rounding;
  std::mt19937 random(9);
  std::normal_distribution<> normal;
  std::int64_t last = 0;
  for (int i = 1; i < 2000; ++i) {
    const double instant = 1e9 * i / rate + static_cast<double>(scatter) * normal(random);
    const std::int64_t stamp = static_cast<std::int64_t>(instant) / step * step;
    rounding.add(stamp - last);
    last = stamp;
  }
  return rounding.step();
}

TEST(StampRounding, IsThatOfRoundedStampsAlone) {
  EXPECT_EQ(roundingOf(200.0, 1000000, 30000), 1e-3);
  EXPECT_EQ(roundingOf(330.0, 100000, 30000), 1e-4);
  EXPECT_EQ(roundingOf(1000.0, 10000, 30000), 0.0) << "fine stamps";
  EXPECT_EQ(roundingOf(1000.0, 1000000, 0), 0.0) << "a controller that samples by its own clock is right";
}

}  // namespace
}  // namespace hammer_loads
