// Where level elastic follows an elastic connecting rod.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

class ElasticLevel : public testing::Test {
 protected:
  simulation::Session sessionOf(double stiffness, double duration, double rate = 1000.0) const {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.hammer = settings_.mechanism.parameters();
    machine.level = Level::kLinkage;
    machine.duration = duration;
    machine.drive.start_time = 0.1, machine.drive.stop_time = 100.0;
    machine.crank.rate = rate;
    machine.crank.drop_outs.clear();
    if (stiffness > 0.0) machine.rod = {stiffness, 0.5, 0.0};
    machine.seed = 5;
    return simulation::recordSession(machine);
  }
  /// each(pipeline, result) after each sample.
  void play(const simulation::Session& session, const std::function<void(const Pipeline&, const SampleResult&)>& each) {
    PipelineSettings pipeline = settings_.pipeline;
    pipeline.level = Level::kElastic;
    accuracy::SessionPlayer player(settings_.mechanism, pipeline, {}, session);
    player.playTo(1e9, [&](double, const SampleResult& result) { each(player.pipeline, result); });
  }

  Settings settings_ = test::heldHull(*load(configDirectory(), {}).value);
};

/// Where the tool is met is not known to a hundredth of a degree: a reading just after that has the force of the run-up
/// before it.
TEST_F(ElasticLevel, WithholdsAReadingWhereTheToolMayBeMet) {
  const simulation::Session session = sessionOf(1e9, 16.0);
  const auto sinceBlow = [&](double time) {
    const auto next = std::upper_bound(session.blows.begin(), session.blows.end(), time,
                                       [](double t, const simulation::BlowTruth& blow) { return t < blow.time; });
    return next == session.blows.begin() ? 1.0 : time - std::prev(next)->time;
  };
  std::size_t i = 0;
  int touching = 0, wrong = 0;
  play(session, [&](const Pipeline&, const SampleResult& result) {
    const simulation::CrankTruth& truth = session.truth[i++];
    if (truth.time < 3.0 || sinceBlow(truth.time) > 2e-4) return;
    ++touching;
    wrong += result.isPublished() && std::abs(result.wrench.force_x - truth.load.force_x) > 5e3;
  });
  EXPECT_GT(touching, 8);
  EXPECT_EQ(wrong, 0);
}

TEST_F(ElasticLevel, ForgetsARodThatWasReplaced) {
  constexpr StampNs kLater = 20'000'000'000;
  simulation::Session session = sessionOf(1e9, 3.5);
  const simulation::Session rigid = sessionOf(0.0, 3.0);
  const StampNs replaced = rigid.crank.front().stamp + kLater;
  for (std::size_t i = 0; i < rigid.crank.size(); ++i) {
    session.crank.push_back(rigid.crank[i]), session.truth.push_back(rigid.truth[i]);
    session.crank.back().stamp += kLater;
  }
  std::set<std::int64_t> blows;
  play(session, [&](const Pipeline& p, const SampleResult& result) {
    if (result.stamp >= replaced && p.elastic().runs()) blows.insert(p.elastic().crank().position.blow);
  });
  EXPECT_GT(blows.size(), 0U);
  EXPECT_LT(blows.size(), 6U);
}

}  // namespace
}  // namespace hammer_loads
