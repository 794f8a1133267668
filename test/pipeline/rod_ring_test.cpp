// Vibration of an elastic connecting rod after a blow, in deviations of rigid levels and figures of level elastic.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/damage.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/util/functions.h"
#include "pipeline/shipped_machine.h"

namespace hammer_loads {
namespace {

/// Results of one run. error, said, elsewhere: root mean squares of Fz [N]; error and said 10 to 40 ms after the blows.
struct RingFound {
  double error{}, stated{}, elsewhere{};  ///< said: due to the vibration; elsewhere: this later than 70 ms
  double impulse_bias{};                  ///< relative error of a revolution's impulse along z [-]
  double impulse_covered{};
  double restitution_bias{}, restitution_covered{}, energy_covered{}, restitution_said{};
  double energy_bias{}, energy_said{};       ///< relative [-]
  double range_error[2]{}, range_said[2]{};  ///< equivalent range at slopes 3 and 5, relative [-]
};

double equivalentOf(const life::ExactCycles& cycles, double slope) {
  return life::equivalentLoad(life::rangesAndMeans(cycles), slope, 1.0, {}).value;
}

/// Returns a machine that works to the end of its duration [s].
simulation::MachineSettings ringingMachine(const simulation::RodSettings& rod, double duration, std::uint64_t seed) {
  simulation::MachineSettings machine = test::machineWithRod(rod, seed);
  machine.duration = duration;
  machine.drive.stop_time = 20.0;
  return machine;
}

using MachineKey = std::array<double, 6>;  ///< without the hammer, which all machines share

MachineKey keyOf(const simulation::MachineSettings& machine) {
  return {machine.rod.stiffness, machine.rod.damping_ratio,        machine.rod.play,
          machine.crank.rate,    machine.strike.contact_stiffness, machine.strike.rock_strength};
}

/// Returns the session, simulated once, since an elastic connecting rod takes seconds.
const simulation::Session& ringingSession(const simulation::MachineSettings& machine) {
  static std::map<MachineKey, simulation::Session> recorded;
  const auto [at, is_new] = recorded.try_emplace(keyOf(machine));
  if (is_new) at->second = simulation::recordSession(machine);
  return at->second;
}

/// Returns the cycles of the true Fz without those that contact with the tool adds.
const life::ExactCycles& trueCycles(const simulation::MachineSettings& machine) {
  static std::map<MachineKey, life::ExactCycles> counted;
  const auto [at, is_new] = counted.try_emplace(keyOf(machine));
  if (!is_new) return at->second;
  std::vector<double> times;
  for (double t = 4.0; t < machine.duration; t += 1e-4) times.push_back(t);
  for (const simulation::CrankTruth& truth : simulation::truthAt(machine, times))
    if (truth.tool_force == 0.0) at->second.add(truth.load.force_z);
  return at->second;
}

enum class Ranges { kLeftOut, kCounted };  ///< the true ranges need a second simulation

RingFound ringOf(const simulation::RodSettings& rod, Level level, Ranges ranges = Ranges::kLeftOut,
                 double rate = 1000.0, const simulation::StrikeSettings& struck = {},
                 const Mechanism& mechanism = test::shippedDrawing().mechanism) {
  simulation::MachineSettings machine = ringingMachine(rod, 12.0, 4711);
  machine.strike = struck;
  machine.crank.rate = rate;
  const simulation::Session& session = ringingSession(machine);
  PipelineSettings settings = test::shippedDrawing().pipeline;
  settings.level = level;
  Pipeline pipeline(mechanism, settings);
  life::LifeSettings counted;
  counted.channels = {{"hull_wrench/force_z", *life::LoadGrid::make(-2e5, 2e5, 4096).value}};
  counted.period = 1000;
  LifeFollower life(pipeline, counted);
  RingFound found;
  double n = 0.0, others = 0.0, turns = 0.0;
  std::size_t blow = 0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankReading& reading = session.crank[i];
    const simulation::CrankTruth& truth = session.truth[i];
    const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    while (blow < session.blows.size() && session.blows[blow].time <= truth.time) ++blow;
    if (truth.time < 4.0 || blow == 0) continue;
    life.follow();
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const TurnEnd& end = result.ends[k];
      for (const simulation::BlowTruth& b : session.blows) {
        if (std::abs(b.time - 1e-9 * static_cast<double>(end.stamp - machine.start_stamp)) > 0.05) continue;
        if (end.blow.impossible || !end.pulse || !b.whole_turn) continue;
        if (!std::isfinite(end.blow.restitution) || !std::isfinite(end.blow.energy)) continue;
        const double restitution = -b.strike.rocker_speed_after / b.strike.rocker_speed_before;
        const double off = end.blow.restitution - restitution;
        found.restitution_bias += off;
        found.restitution_said += end.blow.restitution_std;
        found.restitution_covered += std::abs(off) <= 2.0 * end.blow.restitution_std;
        found.energy_bias += end.blow.energy / b.strike.energy - 1.0;
        found.energy_said += end.blow.energy_std / b.strike.energy;
        found.energy_covered += std::abs(end.blow.energy - b.strike.energy) <= 2.0 * end.blow.energy_std;
        const double error = end.pulse->turn_impulse_z - b.turn_impulse_z;
        ++turns;
        found.impulse_bias += error / b.turn_impulse_z;
        found.impulse_covered += std::abs(error) <= 2.0 * end.pulse_errors.turn_impulse_z.deviation();
      }
    }
    if (!result.isPublished()) continue;
    const double since = truth.time - session.blows[blow - 1].time;
    if (since > 0.01 && since < 0.04) {
      ++n;
      found.error += square(result.wrench.force_z - truth.load.force_z);
      found.stated += square(result.rod_ring.force_z);
    } else if (since > 0.07) {
      ++others;
      found.elsewhere += square(result.rod_ring.force_z);
    }
  }
  found.error = std::sqrt(found.error / n), found.stated = std::sqrt(found.stated / n);
  found.elsewhere = std::sqrt(found.elsewhere / others);
  for (double* mean : {&found.impulse_bias, &found.impulse_covered, &found.restitution_bias, &found.restitution_said,
                       &found.restitution_covered, &found.energy_covered, &found.energy_bias, &found.energy_said})
    *mean /= turns;
  if (ranges == Ranges::kLeftOut) return found;
  const life::CycleCount count = life.take().counts[0];
  for (const int k : {0, 1}) {
    const double slope = k == 0 ? 3.0 : 5.0;
    const life::Figure figure =
        life::equivalentLoad(life::rangesAndMeans(count), slope, 1.0, life::rangeDeviation(count));
    const double right = equivalentOf(trueCycles(machine), slope);
    found.range_error[k] = figure.value / right - 1.0, found.range_said[k] = figure.deviation / right;
  }
  return found;
}

/// Rigid levels state the size of the vibration while it acts, and the ranges of cycles that it may lengthen.
TEST(RodRing, RigidLevelsStateItsSize) {
  for (const simulation::RodSettings& rod :
       {simulation::RodSettings{1e9, 0.2, 0.0}, {6e8, 0.35, 0.0}, {1.4e9, 0.25, 0.0}}) {
    SCOPED_TRACE(rod.stiffness);
    const RingFound found = ringOf(rod, Level::kLinkage, Ranges::kCounted);
    EXPECT_GT(found.stated, 0.7 * found.error);
    EXPECT_LT(found.stated, 4.0 * found.error);  // a rod softer than assumed vibrates less
    EXPECT_LT(found.elsewhere, 0.05 * found.stated);
    for (const int k : {0, 1}) {
      EXPECT_LT(found.range_error[k], -0.1);  // the vibration is missing
      EXPECT_LT(std::abs(found.range_error[k]), 2.0 * found.range_said[k]);
    }
  }
}

/// Issue: bias at most 0.02, or within two standard deviations; a rigid machine's deviation does not grow by this.
TEST(RodRing, RestitutionIsCovered) {
  for (const simulation::RodSettings& rod : {simulation::RodSettings{1e9, 0.2, 0.0}, {1.4e9, 0.25, 0.0}}) {
    SCOPED_TRACE(rod.stiffness);
    const RingFound rigid = ringOf(rod, Level::kLinkage);
    EXPECT_GT(rigid.restitution_bias, 0.03);
    EXPECT_GT(rigid.restitution_covered, 0.88);
    EXPECT_LT(rigid.restitution_said, 0.08);
    EXPECT_GT(rigid.energy_covered, 0.88);
    EXPECT_GT(rigid.impulse_covered, 0.88);
    const RingFound elastic = ringOf(rod, Level::kElastic);
    EXPECT_LT(std::abs(elastic.restitution_bias), 0.02);
    EXPECT_GT(elastic.restitution_covered, 0.88);
    EXPECT_GT(elastic.energy_covered, 0.88);
  }
  EXPECT_LT(ringOf({}, Level::kLinkage).restitution_said, 0.025);
}

/// Worn pins release the rocker before it strikes: it is slower than in a rigid linkage, and the crank leads. The
/// deviations of a rigid level contain this effect; tight pins leave its figures unchanged.
TEST(RodRing, WornPinsThatLetGoOfTheRockerAreInTheBlow) {
  const auto check = [](const simulation::RodSettings& rod, double rate) {
    SCOPED_TRACE(rod.play);
    const RingFound found = ringOf(rod, Level::kLinkage, Ranges::kLeftOut, rate);
    EXPECT_GT(found.energy_bias, 0.1);
    EXPECT_GT(found.energy_covered, 0.88);
    EXPECT_GT(found.restitution_bias, 0.05);
    EXPECT_GT(found.restitution_covered, 0.88);
    EXPECT_GT(found.impulse_bias, 0.2);
    EXPECT_GT(found.impulse_covered, 0.88);
  };
  check({1e9, 0.3, 2e-4}, 1000.0);
  check({1e9, 3.0, 2e-4}, 1000.0);
  check({1e9, 3.0, 5e-4}, 1000.0);
  check({1e9, 1.0, 3e-4}, 500.0);
  EXPECT_LT(ringOf({}, Level::kLinkage).energy_said, 0.05);  // 0.045 with nominal parameters
}

TEST(RodRing, ReadingsThatShowNoneLeaveLittleOfIt) {
  const RingFound rigid = ringOf({}, Level::kLinkage, Ranges::kCounted);
  EXPECT_LT(rigid.stated, 0.35 * ringOf({1e9, 0.6, 0.0}, Level::kLinkage).stated);
  EXPECT_LT(rigid.range_said[0], 0.2);
  HammerParameters p = test::shippedDrawing().mechanism.parameters();
  p.rod_std = {};
  const Mechanism exact = *Mechanism::make(p).value;
  EXPECT_EQ(ringOf({}, Level::kLinkage, Ranges::kLeftOut, 1000.0, {}, exact).stated, 0.0);
}

/// The rocker rebounds from this rock with half its speed; a rigid mechanism derives a quarter from the crank. Rigid
/// levels state the restitution as unknown; level elastic identifies it.
TEST(RodRing, RigidLevelsKnowNoRestitutionOnLivelyRock) {
  simulation::StrikeSettings lively;
  lively.contact_stiffness = 1.2e8, lively.rock_strength = 3e5;
  for (const simulation::RodSettings& rod : {simulation::RodSettings{1e9, 0.6, 0.0}, {5e8, 1.0, 0.0}}) {
    SCOPED_TRACE(rod.stiffness);
    const RingFound rigid = ringOf(rod, Level::kLinkage, Ranges::kLeftOut, 1000.0, lively);
    EXPECT_GT(std::abs(rigid.restitution_bias), 0.1);
    EXPECT_GT(rigid.restitution_covered, 0.9);
    EXPECT_GT(rigid.energy_covered, 0.9);
    EXPECT_NEAR(rigid.restitution_said, std::hypot(0.29, 0.2 - 0.5), 0.05);  // unknown within 0 to 1; 0.2 is read
    EXPECT_GT(rigid.stated, rigid.error);
    const RingFound elastic = ringOf(rod, Level::kElastic, Ranges::kLeftOut, 1000.0, lively);
    EXPECT_LT(std::abs(elastic.restitution_bias), 0.02);
    EXPECT_GT(elastic.restitution_covered, 0.88);
    EXPECT_GT(elastic.energy_covered, 0.88);
    EXPECT_LT(elastic.restitution_said, 0.05);
  }
}

/// Past the dead centre the linkage stops the rocker in some 10 ms, with more force than at a blow: the rod vibrates.
TEST(RodRing, OccursWithoutAToolAsWell) {
  simulation::MachineSettings machine = ringingMachine({6e8, 0.2, 0.0}, 14.0, 4712);
  machine.blow.blank_share = 0.2;
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(test::shippedDrawing().mechanism, test::shippedDrawing().pipeline);
  struct Found {
    int samples{}, covered{};
    double error{};
  } blank, after;  // blank: no tool is met; after: after the next revolution's blow, the crank being known again
  std::size_t blow = 0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankTruth& truth = session.truth[i];
    const SampleResult& result =
        pipeline.crankSample(session.crank[i].stamp, {session.crank[i].angle, session.crank[i].speed});
    while (blow < session.blows.size() && session.blows[blow].time <= truth.time) ++blow;
    const double way = result.crank.position.angle.offset;
    if (truth.time < 4.0 || blow < 2 || !(way > 0.2 && way < 1.0) || result.refusal) continue;
    const bool struck = truth.time < session.blows[blow - 1].time + 0.1;
    if (struck && session.blows[blow - 1].time < session.blows[blow - 2].time + 0.3) continue;
    Found& found = struck ? after : blank;
    const double off = result.wrench.force_z - truth.load.force_z;
    ++found.samples, found.error += square(off);
    found.covered += std::abs(off) < 2.0 * result.deviation.wrench().force_z;
  }
  for (const Found& found : {blank, after}) {
    SCOPED_TRACE(found.samples);
    EXPECT_GT(found.samples, 100);
    EXPECT_GT(std::sqrt(found.error / found.samples), 1000.0);
    EXPECT_GT(found.covered, 0.85 * found.samples);
  }
}

/// The rod has no lever arm just before the blow: the rocker lags, and the crank, no longer braked by it, leads.
TEST(RodRing, BeginsBeforeTheBlow) {
  const simulation::Session session = simulation::recordSession(ringingMachine({5e8, 0.65, 0.0}, 10.0, 4713));
  Pipeline pipeline(test::shippedDrawing().mechanism, test::shippedDrawing().pipeline);
  int samples = 0, covered = 0;
  double error = 0.0, stated = 0.0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankTruth& truth = session.truth[i];
    const SampleResult& r =
        pipeline.crankSample(session.crank[i].stamp, {session.crank[i].angle, session.crank[i].speed});
    const double offset = CrankAngle::wrapToPi(truth.angle);
    if (truth.time < 4.0 || !r.isPublished() || !(offset > -0.15 && offset < 0.0)) continue;
    const double off = r.wrench.torque_y - truth.load.torque_y - truth.drive_reaction_y;
    ++samples, error += square(off), stated += square(r.deviation.wrench().torque_y);
    covered += std::abs(off) < 2.0 * r.deviation.wrench().torque_y;
  }
  ASSERT_GT(samples, 150);
  EXPECT_GT(std::sqrt(error / samples), 20.0) << "what there is to cover";
  EXPECT_GT(covered, 0.9 * samples);
  EXPECT_LT(stated, square(4.0) * error);
}

/// Issue: counted damage 0.7 to 1.4 of the true one; picking up the rocker is part of the revolution's impulse.
TEST(RodRing, LevelElasticCountsItAndItsImpulse) {
  for (const simulation::RodSettings& rod :
       {simulation::RodSettings{1e9, 0.2, 0.0}, {6e8, 0.35, 0.0}, {1.4e9, 0.25, 0.0}}) {
    SCOPED_TRACE(rod.stiffness);
    const RingFound found = ringOf(rod, Level::kElastic, Ranges::kCounted);
    for (const int k : {0, 1}) {
      const double damage = std::pow(1.0 + found.range_error[k], k == 0 ? 3.0 : 5.0);
      EXPECT_GT(damage, 0.7);
      EXPECT_LT(damage, 1.4);
      EXPECT_LT(std::abs(found.range_error[k]), 2.0 * found.range_said[k]);
    }
    EXPECT_LT(std::abs(found.impulse_bias), 0.02);  // without the load on the hull during the contact
    EXPECT_GT(found.impulse_covered, 0.88);
  }
}

}  // namespace
}  // namespace hammer_loads
