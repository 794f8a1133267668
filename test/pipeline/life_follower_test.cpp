/// Turn loads and cycles of a session against what the pipeline itself knows at every instant.
#include "hammer_loads/pipeline/life_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "hammer_loads/pipeline/step_wrenches.h"
#include "pipeline/life_session.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

using test::kNothing;
using test::kPeak;
using test::run;
using test::sessionAt;

TEST(StepWrenches, NoInstantOfAStepIsBeyondThem) {
  for (const double rate : {50.0, 1000.0}) {
    const simulation::Session session = sessionAt(rate);
    test::Player player(test::settingsWith("{}"), true, session);
    const Pipeline& pipeline = player.pipeline;
    double beyond = 0.0;
    std::size_t blows = 0;
    player.playTo(1e9, [&](double time_of_session, const SampleResult& result) {
      const CrankStep& step = pipeline.crank().step();
      if (time_of_session < test::kSessionWorks || result.refusal || !step.known()) return;
      const DriveReaction drive = driveReaction(pipeline.model(), step.driveInertia());
      const StepLoad load{pipeline.model(), drive, result.hull.motion};
      std::vector<double> times{0.0}, forces{load.at(step.at(0.0)).force_z};
      forEachStepExtreme(
          load, step,
          [&](const StepPlace& place, const CrankEstimate& crank) {
            EXPECT_GE(place.time, times.back());
            times.push_back(place.time);
            forces.push_back(load.at(crank).force_z);
          },
          [&](double) { ++blows; });
      EXPECT_LE(times.back(), step.length());
      forces.push_back(result.wrench.force_z);
      const auto [least, greatest] = std::minmax_element(forces.begin(), forces.end());
      for (int i = 1; i < 50; ++i) {
        const double force = load.at(step.at(step.length() * i / 50.0)).force_z;
        beyond = std::max({beyond, force - *greatest, *least - force});
      }
    });
    EXPECT_GT(blows, 8U);
    EXPECT_LT(beyond, 3e-4 * kPeak) << rate;  // the cubic's extreme is some 1 % of 1.25 ms off
  }
}

/// Speeds through a low-pass, stamps that jitter but keep their order: a filter that trusts both is led astray, and
/// what lies between two of its samples may be of neither.
simulation::Session disturbed(double lag, double jitter, unsigned seed) {
  simulation::Session session = sessionAt(1000.0);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, jitter);
  std::vector<StampNs> stamps;
  double filtered = 0.0;
  StampNs last = session.crank.front().stamp;
  for (simulation::CrankReading& r : session.crank) {
    if (r.speed) {
      filtered += (1.0 - std::exp(-seconds(r.stamp - last) / lag)) * (*r.speed - filtered);
      r.speed = filtered;
    }
    last = r.stamp;
    stamps.push_back(r.stamp + static_cast<StampNs>(std::llround(1e9 * noise(random))));
  }
  std::sort(stamps.begin(), stamps.end());
  for (std::size_t i = 0; i < stamps.size(); ++i) session.crank[i].stamp = stamps[i];
  return session;
}

TEST(LoadCycles, NothingIsCountedFarBeyondWhatIsPublished) {
  for (const auto& [lag, jitter, seed] : {std::tuple{0.01, 1e-3, 1U}, {0.01, 1e-3, 2U}, {5e-3, 3e-4, 3U}}) {
    std::array<double, kHullChannels> least, greatest, values;
    least.fill(0.0);
    greatest.fill(0.0);
    std::size_t published = 0;
    const life::LifePiece piece = run(test::settingsWith("{}"), disturbed(lag, jitter, seed),
                                      [&](const SampleResult& result, const LifeFollower&) {
                                        if (result.refusal) return;
                                        for (const WrenchOutput& output : result.outputs) {
                                          ++published;
                                          wrenchValues(output.wrench, values.data());
                                          for (std::size_t i = 0; i < kHullChannels; ++i) {
                                            least[i] = std::min(least[i], values[i]);
                                            greatest[i] = std::max(greatest[i], values[i]);
                                          }
                                        }
                                      });
    EXPECT_GT(published, 2000U) << seed;
    for (std::size_t i = 0; i < kHullChannels; ++i) {
      EXPECT_LE(piece.counts[i].extremes.greatest, 1.02 * greatest[i]) << seed << ", channel " << i;
      EXPECT_GE(piece.counts[i].extremes.least, 1.02 * least[i]) << seed << ", channel " << i;
    }
  }
}

TEST(LoadCycles, AreThoseOfDenseSamplesForSparseOnes) {
  const Settings settings = test::settingsWith("{}");
  const life::LifePiece sparse = run(settings, sessionAt(100.0), kNothing);
  const life::LifePiece dense = run(settings, sessionAt(1000.0), kNothing);
  for (const std::size_t channel : {0U, 1U}) {
    const auto largest = [&](const life::LifePiece& piece) {
      return life::rangesAndMeans(piece.counts[channel]).back().range;
    };
    EXPECT_NEAR(largest(sparse), largest(dense), 0.01 * largest(dense)) << channel;
  }
  EXPECT_EQ(sparse.turns, dense.turns);
  EXPECT_GT(dense.counts[1].tally.counted, 3000U);
  EXPECT_EQ(dense.counts[1].tally.skipped, 0U);
  EXPECT_EQ(dense.counts[1].tally.gaps, 0U);
  EXPECT_GT(dense.counts[1].tally.deviations, 3000U);
}

TEST(LoadCycles, AGapIsCountedAndItsTurnIsNotWhole) {
  std::vector<bool> whole;
  const life::LifePiece piece = run(test::settingsWith("{}"), sessionAt(1000.0, {{3.5, 3.9}}),
                                    [&](const SampleResult& result, const LifeFollower& follower) {
                                      for (std::size_t i = 0; i < result.turn_ends; ++i) {
                                        const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
                                        whole.push_back(turn != nullptr && turn->whole);
                                      }
                                    });
  EXPECT_EQ(piece.counts[1].tally.gaps, 1U);
  EXPECT_EQ(std::count(whole.begin() + 1, whole.end(), false), 1);
  EXPECT_EQ(piece.turns, whole.size());
}

TEST(LoadCycles, AllocatesNothingPerSample) {
  const Settings settings = test::settingsWith("boom: compliant\n");
  const simulation::Session session = sessionAt(1000.0);
  test::Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  std::size_t allocated = 0, samples = 0;
  player.playTo(1e9, [&](double, const SampleResult& result) {
    ASSERT_FALSE(follower.due()) << "the session is shorter than the period";
    const std::size_t before = test::allocations;
    follower.follow();
    for (std::size_t i = 0; i < result.turn_ends; ++i) EXPECT_NE(follower.turnLoads(result.ends[i]), nullptr);
    allocated += test::allocations - before;
    ++samples;
  });
  EXPECT_EQ(allocated, 0U);
  EXPECT_GT(samples, 4000U);
}

}  // namespace
}  // namespace hammer_loads
