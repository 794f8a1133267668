// Ranges that a ledger counts on machines with an elastic connecting rod. The truth is integrated by independent
// equations every 0.1 ms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/damage.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "pipeline/shipped_machine.h"
#include "support/counting_new.h"

namespace hammer_loads {
namespace {

/// At 200 Hz a vibration of 150 to 250 Hz has all its peaks between samples. The true loads at the samples alone have
/// ranges that are a tenth to a fifth too small.
TEST(ElasticRanges, AVibrationBetweenSparseSamplesIsCounted) {
  std::uint64_t seed = 840;
  for (const simulation::RodSettings& rod : {simulation::RodSettings{8e8, 0.2, 0.0}, {1.3e9, 0.25, 0.0}}) {
    SCOPED_TRACE(rod.stiffness);
    simulation::MachineSettings machine = test::machineOfOutputs(rod, ++seed);
    machine.crank.rate = 200.0;
    const simulation::Session session = simulation::recordSession(machine);
    accuracy::SessionPlayer player = test::shippedPlayer(session, Level::kElastic);
    life::LifeSettings counted;
    counted.channels = {{"hull_wrench/force_z", *life::LoadGrid::make(-2e5, 2e5, 4096).value}};
    counted.period = 1;
    constexpr double kFrom = 4.0, kTo = 10.0;
    std::size_t allocated = 0;
    std::optional<LifeFollower> follower;  // from kFrom on, since earlier loads would stay in the residue
    player.playTo(kTo, [&](double time, const SampleResult&) {
      if (time < kFrom) return;
      if (!follower) follower.emplace(player.pipeline, counted);
      const std::size_t so_far = test::allocations;
      follower->follow();
      allocated += test::allocations - so_far;
    });
    EXPECT_EQ(allocated, 0U);
    const life::LifePiece piece = follower->take();
    std::vector<double> times;
    for (int i = 0; i < 60000; ++i) times.push_back(kFrom + i * 1e-4);
    life::ExactCycles fine, sparse;
    int step = 0;
    for (const simulation::CrankTruth& truth : simulation::truthAt(machine, times)) {
      if (truth.touches()) continue;
      fine.add(truth.load.force_z);
      if (step++ % 50 == 0) sparse.add(truth.load.force_z);
    }
    const life::RangeDeviation stated = life::rangeDeviation(piece.counts[0]);
    for (const double slope : {3.0, 5.0}) {
      const double right = life::equivalentLoad(life::rangesAndMeans(fine), slope, 1.0, {}).value;
      const life::Figure found = life::equivalentLoad(life::rangesAndMeans(piece.counts[0]), slope, 1.0, stated);
      EXPECT_NEAR(found.value, right, 0.07 * right) << slope;
      EXPECT_NEAR(found.value, right, 2.0 * found.deviation) << slope;
      EXPECT_LT(life::equivalentLoad(life::rangesAndMeans(sparse), slope, 1.0, {}).value, 0.92 * right) << slope;
    }
  }
}

/// A vibration and unknown forces after a blow do not add to the deviation of a load before it.
TEST(ElasticRanges, ALoadInFrontOfABlowIsMoreCertainThanThoseBehindIt) {
  const simulation::Session session = simulation::recordSession(test::machineOfOutputs({8e8, 0.25, 0.0}, 890));
  for (const Level level : {Level::kLinkage, Level::kElastic}) {
    SCOPED_TRACE(nameOf(level));
    accuracy::SessionPlayer player = test::shippedPlayer(session, level);
    LifeFollower follower(player.pipeline, {});
    std::vector<std::pair<StampNs, double>> samples;  // own deviations of Fx [N]
    int turns = 0;
    player.playTo(9.0, [&](double time, const SampleResult& result) {
      follower.follow();
      if (result.isPublished())
        samples.emplace_back(
            result.stamp,
            life::LoadError::of(result.deviation.wrench().force_x, result.deviation.common().force_x).own);
      for (std::size_t i = 0; i < result.turn_ends && time > 5.0; ++i) {
        const life::TurnLoads* loads = follower.turnLoads(result.ends[i]);
        const auto behind = std::lower_bound(samples.begin(), samples.end(), std::pair(result.ends[i].stamp, 0.0));
        constexpr int kSamples = 5;
        ASSERT_NE(loads, nullptr);
        ASSERT_GT(std::distance(behind, samples.end()), kSamples);
        // The extreme is between the last sample and the blow.
        if (behind == samples.begin() || loads->channels[0].minimum.instant < std::prev(behind)->first) continue;
        double largest = 0.0;
        for (auto sample = behind; sample != behind + kSamples; ++sample) largest = std::max(largest, sample->second);
        EXPECT_LT(loads->channels[0].minimum.error.own, largest) << time;
        ++turns;
      }
    });
    EXPECT_GT(turns, 3);
  }
}

/// With much damping worn pins meet hard for 0.3 ms. The samples hardly show the moment, but the two bodies show how
/// hard.
TEST(ElasticRanges, ImpactsInWornPinsAreCountedByTheirSizeNotByTheirMoment) {
  constexpr std::uint64_t kSeeds[] = {881, 882, 883};
  double mean = 0.0;
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(seed);
    const accuracy::ElasticKind kind{"", test::machineOfOutputs({1e9, 3.0, 2e-4}, seed)};
    const accuracy::LifeFigure life = accuracy::elasticErrors(test::shippedDrawing(), kind, Level::kElastic).life;
    EXPECT_LT(std::abs(life.error), 2.0 * std::hypot(life.own, life.common));
    mean += life.error / static_cast<double>(std::size(kSeeds));
  }
  EXPECT_LT(std::abs(mean), 0.2);
}

/// At a level without the spring the phase of the vibration is unknown. The deviation of an extreme is then its crest.
TEST(ElasticRanges, ARigidLevelsRangesHaveTheVibrationsCrestInTheirDeviation) {
  for (const simulation::RodSettings& rod :
       {simulation::RodSettings{8e8, 0.3, 0.0}, {8e8, 0.3, 2e-4}, {1e9, 0.3, 5e-4}}) {
    SCOPED_TRACE(rod.play);
    const accuracy::ElasticKind kind{"", test::machineOfOutputs(rod, 885)};
    const accuracy::LifeFigure life = accuracy::elasticErrors(test::shippedDrawing(), kind, Level::kLinkage).life;
    EXPECT_LT(life.error, -0.1);
    EXPECT_LT(std::abs(life.error), 2.0 * std::hypot(life.own, life.common));
  }
}

}  // namespace
}  // namespace hammer_loads
