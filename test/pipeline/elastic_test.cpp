// Machines with an elastic connecting rod, at level elastic through the pipeline. No constant was tuned on these rods.
#include <gtest/gtest.h>

#include <algorithm>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/session_run.h"
#include "pipeline/shipped_machine.h"
#include "support/counting_new.h"
#include "support/csv.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

accuracy::ElasticErrors rodErrors(const simulation::MachineSettings& machine, Level level) {
  return accuracy::elasticErrors(test::shippedDrawing(), {"", machine}, level);
}

/// Issue: 0.40 of the truth, 3.5 % over the whole revolution. The rigid level shows once that the flaw exists.
TEST(ElasticSession, PublishesTheVibrationAfterTheBlow) {
  EXPECT_GT(rodErrors(test::machineWithRod({6e8, 0.35, 0.0}, 701), Level::kLinkage).after.rms[1], 0.6);
  std::uint64_t seed = 700;
  for (const simulation::RodSettings& rod :
       {simulation::RodSettings{6e8, 0.35, 0.0}, {1.4e9, 0.25, 0.0}, {9e8, 1.5, 0.0}}) {
    const simulation::MachineSettings machine = test::machineWithRod(rod, ++seed);
    SCOPED_TRACE(rod.stiffness);
    const accuracy::ElasticErrors e = rodErrors(machine, Level::kElastic);
    EXPECT_LT(e.after.rms[1], 0.25);
    EXPECT_GT(e.after.covered[1], 0.85);
    EXPECT_LT(e.whole.rms[1], 0.035);
  }
}

/// Rock throws the rocker back with two thirds of its speed. The rod stops it 0.05 rad beside its rigid position, and
/// turns the crank by more than any torque does within a sample. Such samples are published like any others.
TEST(ElasticSession, LivelyRockThrowsTheRockerFar) {
  simulation::MachineSettings machine = test::machineWithRod({8e8, 0.5, 0.0}, 705);
  machine.strike.contact_stiffness = 6e7, machine.strike.rock_strength = 3e5;
  const accuracy::ElasticErrors e = rodErrors(machine, Level::kElastic);
  EXPECT_GT(e.after.scale[1], 8000.0);
  EXPECT_LT(e.after.rms[1], 0.10);
  EXPECT_GT(e.after.covered[1], 0.85);
  EXPECT_LT(e.after.rms[0], 0.06);  // the force follows the rocker's own direction
  EXPECT_GT(e.after.covered[0], 0.95);
  EXPECT_LT(std::abs(e.life.error), 0.05);
  EXPECT_GT(e.after.count, 0.95 * rodErrors(test::machineWithRod({8e8, 0.5, 0.0}, 705), Level::kElastic).after.count);
}

/// With 1024 counts and an unknown zero of the encoder, the deviations must hold. They are those of a rigid rod.
TEST(ElasticSession, ReadingsTooCoarseForARodLeaveLinkage) {
  simulation::MachineSettings machine = test::machineWithRod({8e8, 0.3, 0.0}, 731);
  machine.crank.counts = 1024;
  machine.crank.speed = false;
  machine.crank.zero = 0.5 * kTwoPi / 360.0;
  const accuracy::ElasticErrors e = rodErrors(machine, Level::kElastic);
  EXPECT_GT(e.after.covered[1], 0.85);
  EXPECT_GT(e.whole.covered[1], 0.85);
}

/// All stamps are up to a millisecond early, which is a seventh of a vibration period.
TEST(ElasticSession, StampsOfWholeMillisecondsAreInTheDeviation) {
  simulation::MachineSettings machine = test::machineWithRod({6e8, 0.25, 0.0}, 741);
  machine.crank.stamp_step = 1e-3;
  const accuracy::ElasticErrors e = rodErrors(machine, Level::kElastic);
  EXPECT_GT(e.after.covered[0], 0.90);
  EXPECT_GT(e.after.covered[1], 0.90);
  EXPECT_GT(e.after.covered[2], 0.90);
}

/// The joint clearance of the pins is not given.
TEST(ElasticSession, LearnsTheJointClearance) {
  const accuracy::ElasticErrors e = rodErrors(test::machineWithRod({1.1e9, 0.35, 4e-4}, 711), Level::kElastic);
  EXPECT_LT(e.after.rms[1], 0.5);
  EXPECT_GT(e.after.covered[1], 0.80);
}

/// A machine of other equations than ours (rod of three bodies, tool on rock): dead rod, joint clearance of 0.2 mm.
/// Tight pins imitate worn ones there by a soft rod with much damping. Its crank and rod have no mass.
TEST(ElasticSession, TightPinsDoNotPassForWornOnes) {
  HammerParameters hammer = test::shippedDrawing().mechanism.parameters();
  hammer.crank_mass = hammer.crank_inertia_about_com = hammer.rod_mass = hammer.rod_inertia_about_com = 0.0;
  PipelineSettings settings = test::shippedDrawing().pipeline;
  settings.level = Level::kElastic;
  const Mechanism mechanism = test::mechanismOf(hammer);
  Pipeline pipeline(mechanism, settings);
  const test::Csv recorded(HAMMER_LOADS_TEST_DATA "/worn_pins.csv");
  int samples = 0, worn = 0, covered = 0, surprising = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const StampNs stamp = std::stoll(recorded.text(i, "stamp_us")) * 1000;
    const SampleResult& r = pipeline.crankSample(
        stamp, {recorded.number(i, "counts") * kTwoPi / 4096.0, recorded.number(i, "speed_rad_s")});
    const RodFilter& rod = pipeline.elastic().filter();
    if (stamp < 4'000'000'000 || r.refusal || !pipeline.elastic().runs() || !(rod.sinceBlow() > 0.006)) continue;
    ++samples;
    worn += std::abs(rod.motion().rod.play - 2e-4) < 8e-5;
    const double error = std::abs(r.wrench.force_z - recorded.number(i, "force_z_N"));
    covered += error < 2.0 * r.deviation.wrench().force_z;
    surprising += error > 4.0 * r.deviation.wrench().force_z;
    largest = std::max(largest, std::abs(r.wrench.force_z));
  }
  EXPECT_GT(samples, 800);
  EXPECT_GT(worn, 0.8 * samples) << samples;
  EXPECT_GT(covered, 0.85 * samples) << samples;
  EXPECT_LT(surprising, 0.015 * samples);
  EXPECT_LT(largest, 20000.0);  // the instant at which the pins meet is unknown; the impact has up to 30 kN
}

std::vector<accuracy::WrenchAt> rodWrenches(const simulation::MachineSettings& machine, Level level) {
  PipelineSettings pipeline = test::shippedDrawing().pipeline;
  pipeline.level = level;
  return accuracy::runSession(simulation::recordSession(machine), machine.start_stamp, test::shippedDrawing().mechanism,
                              pipeline)
      .wrenches;
}

/// A rod too stiff for the readings to show is treated as rigid. The results are equal to the bit.
TEST(ElasticSession, UsesLinkageForARigidMachine) {
  const simulation::MachineSettings machine = test::machineWithRod({}, 720);
  const auto elastic = rodWrenches(machine, Level::kElastic), linkage = rodWrenches(machine, Level::kLinkage);
  ASSERT_EQ(elastic.size(), linkage.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < elastic.size(); ++i) others += elastic[i].force_z != linkage[i].force_z;
  EXPECT_EQ(others, 0U);
}

TEST(ElasticSession, TheSameReadingsGiveTheSameBitsAndNothingIsAllocated) {
  simulation::MachineSettings machine = test::machineWithRod({8e8, 0.3, 0.0}, 730);
  machine.duration = 6.0;
  const simulation::Session session = simulation::recordSession(machine);
  const auto play = [&] {
    std::vector<double> forces;
    forces.reserve(session.crank.size());
    accuracy::SessionPlayer player = test::shippedPlayer(session, Level::kElastic);
    bool ran = false;
    std::size_t allocated = 0, before = test::allocations;
    player.playTo(100.0, [&](double, const SampleResult& r) {
      allocated += test::allocations - before;
      if (!r.refusal) forces.push_back(r.wrench.force_z);
      ran = ran || player.pipeline.elastic().runs();
      before = test::allocations;
    });
    EXPECT_TRUE(ran);
    EXPECT_LT(allocated, 10U);  // strings of the player
    return forces;
  };
  EXPECT_EQ(play(), play());
}

/// A blank firing contradicts the rod's model, and the machine is then treated as rigid.
TEST(ElasticSession, AMissedToolIsNoVibration) {
  simulation::MachineSettings machine = test::machineWithRod({1e9, 0.3, 0.0}, 740);
  machine.blow.blank_share = 0.2;
  const accuracy::ElasticErrors e = rodErrors(machine, Level::kElastic), rigid = rodErrors(machine, Level::kLinkage);
  EXPECT_LT(e.whole.rms[1], rigid.whole.rms[1]);
  EXPECT_GT(e.whole.covered[1], 0.85);
}

/// The drive has stopped. The crank stands within three degrees of the dead centre, and the tool carries the rocker.
/// Half of the rocker's weight is not on the hull.
TEST(ElasticSession, AToolThatCarriesTheRockerIsInTheDeviation) {
  int samples = 0, covered_force = 0, covered_torque = 0, less = 0;
  for (std::uint64_t seed = 760; seed < 772; ++seed) {
    simulation::MachineSettings machine = test::machineWithRod({8e8, 0.4, 0.0}, seed);
    machine.drive.stop_time = 5.0 + 0.02 * static_cast<double>(seed - 760);
    machine.duration = 7.0;
    const simulation::Session session = simulation::recordSession(machine);
    accuracy::SessionPlayer player(test::shippedDrawing().mechanism, test::shippedDrawing().pipeline, {}, session);
    std::size_t i = 0;
    player.playTo(1e9, [&](double time, const SampleResult& r) {
      const simulation::CrankTruth& truth = session.truth[i++];
      if (time < 6.0 || std::abs(CrankAngle::wrapToPi(truth.angle)) > 0.05 || std::abs(truth.speed) > 0.1) return;
      if (r.refusal) return;
      ++samples;
      const double off = r.wrench.force_z - truth.load.force_z;
      less += off < -100.0;
      covered_force += std::abs(off) < 2.0 * r.deviation.wrench().force_z;
      covered_torque += std::abs(r.wrench.torque_y - truth.load.torque_y - truth.drive_reaction_y) <
                        2.0 * r.deviation.wrench().torque_y;
    });
  }
  EXPECT_GT(less, 1000) << "what there is to doubt";
  EXPECT_GT(covered_force, 0.9 * samples) << samples;
  EXPECT_GT(covered_torque, 0.9 * samples) << samples;
}

}  // namespace
}  // namespace hammer_loads
