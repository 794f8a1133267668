/// Loads per revolution and cycles of a session, against the pipeline's own values at every instant.
#include "hammer_loads/pipeline/life_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <tuple>
#include <utility>

#include "hammer_loads/settings/readers.h"
#include "pipeline/life_session.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

using test::kNothing;
using test::run;
using test::sessionAt;

/// Speeds pass a low-pass, and stamps jitter but keep their order. A filter that accepts both goes wrong, and its
/// values between two samples may fit neither of them.
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
  for (const auto& [lag, jitter, seed] : {std::tuple{0.01, 1e-3, 1U}, {5e-3, 3e-4, 3U}}) {
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

/// Returns (range, mean, count) of the counted cycles.
std::vector<std::array<double, 3>> cyclesOf(const life::CycleCount& count) {
  std::vector<std::array<double, 3>> cycles;
  for (const life::RangeMean& c : life::rangesAndMeans(count)) cycles.push_back({c.range, c.mean, c.count});
  return cycles;
}

TEST(LoadCyclesBelowABandwidth, AreThoseOfThePublishedMeans) {
  for (const double rate : {100.0, 1000.0}) {
    const simulation::Session session = sessionAt(rate);
    const Settings of_means = test::settingsWith("{output: mean, output_rate_Hz: 100.0}");
    life::CycleCounter counter(of_means.life.channels[1].grid);
    run(of_means, session, [&](const SampleResult& result, const LifeFollower&) {
      for (const WrenchOutput& output : result.outputs) counter.add(output.wrench.force_z);
    });
    const life::LifePiece piece = run(test::settingsWith("life_bandwidth_Hz: 50.0"), session, kNothing);
    EXPECT_EQ(cyclesOf(piece.counts[1]), cyclesOf(counter.take())) << rate;
  }
}

TEST(LoadCyclesBelowABandwidth, AreThoseOfTheTruthWhereARodRings) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = test::kSessionEnd;
  machine.crank.rate = 1000.0;
  machine.level = Level::kLinkage;
  machine.rod = {4e8, 0.05, 0.0};
  constexpr int kPerMean = 100;
  std::vector<double> times;
  for (double time = test::kSessionWorks; time < test::kSessionEnd - 0.1; time += 5e-5) times.push_back(time);
  const auto truth = simulation::truthAt(machine, times);
  const Settings settings = test::settingsWith("{level: elastic, life_bandwidth_Hz: 100.0}");
  life::CycleCounter below(settings.life.channels[1].grid), all(settings.life.channels[1].grid);
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    all.add(truth[i].load.force_z);
    sum += truth[i].load.force_z / kPerMean;
    if (i % kPerMean == kPerMean - 1) below.add(std::exchange(sum, 0.0));
  }
  const auto equivalent = [](const life::CycleCount& count) {
    return life::equivalentLoad(life::rangesAndMeans(count), 5.0, 1000.0, {}).value;
  };
  const double of_band = equivalent(below.take()), of_all = equivalent(all.take());
  RecordProperty("all_over_band", format("%.3f", of_all / of_band));
  EXPECT_GT(of_all, 1.2 * of_band) << "the ring of the rod is worth counting";
  const simulation::Session session = simulation::recordSession(machine);
  test::Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  std::optional<life::LifePiece> piece;
  player.playTo(test::kSessionEnd - 0.1, [&](double time, const SampleResult&) {
    if (time < test::kSessionWorks) return;
    follower.follow();
  });
  EXPECT_NEAR(equivalent(follower.take().counts[1]), of_band, 0.05 * of_band);
}

TEST(LoadCyclesBelowABandwidth, KeepTheIntegralOfTheBoomsTorques) {
  const Settings settings = test::settingsWith("boom: compliant\n");
  test::Player player(settings, true, sessionAt(1000.0));
  const Boom& boom = player.pipeline.boom()->boom();
  const std::size_t channels = channelNames(&boom).size(), torque = kHullChannels + 1;
  BandMeans means(player.pipeline, 100.0, channels);
  std::vector<double> values(channels), deviations(channels), common(channels);
  double of_samples = 0.0, of_means = 0.0, before = 0.0;
  StampNs last = 0, last_mean = 0;
  std::size_t count = 0;
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    if (time < test::kSessionWorks || result.refusal) return;
    channelValues(result, &boom, values.data(), deviations.data(), common.data());
    means.sample(values.data(), deviations.data(), common.data(),
                 [&](StampNs stamp, const double* mean, const double*, const double*) {
                   of_means += mean[torque] * 5e-3;
                   last_mean = stamp;
                   ++count;
                 });
    if (!result.isPublished()) return;
    if (last != 0 && result.stamp <= last_mean + 5000000)
      of_samples += 0.5 * (before + values[torque]) * seconds(result.stamp - last);
    last = result.stamp, before = values[torque];
  });
  EXPECT_GT(count, 300U);
  EXPECT_GT(std::abs(of_samples), 100.0);
  EXPECT_NEAR(of_means, of_samples, 1e-3 * std::abs(of_samples)) << "but for the last interval";
}

TEST(LoadCycles, AllocatesNothingPerSample) {
  const Settings settings = test::settingsWith("{boom: compliant, life_bandwidth_Hz: 100.0}");
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
