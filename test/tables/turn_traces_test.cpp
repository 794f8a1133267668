// Which revolutions are kept, and the memory used.
#include "hammer_loads/tables/turn_traces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hammer_loads {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Plays revolutions of `samples` samples 1 ms apart, each known 50 samples after its end; force_z names each.
void play(TurnTraces& traces, const std::vector<double>& amplitudes, int samples) {
  std::int64_t stamp = 0;
  std::size_t ended = 0;
  const auto end_turn = [&] {
    const std::int64_t end = static_cast<std::int64_t>(ended + 1) * samples * kMs;
    traces.turnEnded(ended + 1, end, 1e-3 * samples, amplitudes[ended]);
    ++ended;
  };
  for (std::size_t turn = 0; turn < amplitudes.size(); ++turn) {
    for (int i = 0; i < samples; ++i) {
      stamp += kMs;
      traces.add({stamp, 0.0, static_cast<double>(turn + 1), 0.0, 0.0, 0.0});
      if (i == 50 && turn > 0) end_turn();
    }
  }
  end_turn();
}

void expectWhole(const TurnTrace& trace, int samples) {
  ASSERT_EQ(trace.samples.size(), static_cast<std::size_t>(samples));
  for (const TraceSample& sample : trace.samples) EXPECT_EQ(sample.force_z, static_cast<double>(trace.turn));
  EXPECT_EQ(trace.samples.front().stamp - trace.start, kMs);
  EXPECT_EQ(trace.samples.back().stamp - trace.start, samples * kMs);
}

/// For runs of any length, the typical revolution lies near the median of all.
TEST(TurnTraces, TypicalIsNearTheMedian) {
  std::mt19937 random(1);
  std::lognormal_distribution<> amplitude(0.0, 0.5);
  for (const std::size_t turns : {1U, 2U, 5U, 33U, 1000U, 20000U}) {
    std::vector<double> amplitudes(turns);
    for (double& value : amplitudes) value = amplitude(random);
    TurnTraces traces;
    play(traces, amplitudes, 60);
    const TurnTrace* typical = traces.typical();
    ASSERT_NE(typical, nullptr);
    expectWhole(*typical, 60);
    EXPECT_EQ(typical->amplitude, amplitudes[typical->turn - 1]);
    const auto below =
        std::count_if(amplitudes.begin(), amplitudes.end(), [&](double value) { return value <= typical->amplitude; });
    // The rank of a median of at least 16 revolutions scatters by 0.5/sqrt(16) at most; the bound is three of these.
    EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(turns), 0.5, turns < 16 ? 0.5 : 0.38) << turns;
  }
}

TEST(TurnTraces, DoNotKeepATurnThatIsTooLong) {
  TurnTraces traces;
  play(traces, {1.0, 2.0, 3.0}, 5000);
  EXPECT_FALSE(traces.worst());
  play(traces, {1.0}, 9000);
  EXPECT_FALSE(traces.worst()) << "its beginning is gone";
}

}  // namespace
}  // namespace hammer_loads
