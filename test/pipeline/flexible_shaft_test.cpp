// Machines with a flexible coupling, the encoder on the motor, through the whole pipeline.
#include <gtest/gtest.h>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/settings/load.h"
#include "support/counting_new.h"
#include "support/exact_hammer.h"

namespace hammer_loads {
namespace {

const Settings& shipped() {
  static const Settings settings = test::withExactHammer(*load(configDirectory(), {}).value);
  return settings;
}

simulation::MachineSettings machineWith(double frequency, double share, std::uint64_t seed) {
  simulation::MachineSettings s = simulation::workingMo100();
  s.hammer = shipped().mechanism.parameters();
  s.duration = 11.0;
  s.drive.stop_time = 9.5;
  s.drive.coupling_frequency = frequency;
  s.drive.motor_share = share;
  s.drive.coupling_damping = 0.02;
  s.seed = seed;
  return s;
}

PipelineSettings settingsWith(const std::optional<Coupling>& coupling) {
  PipelineSettings settings = shipped().pipeline;
  settings.coupling = coupling;
  return settings;
}

accuracy::SessionErrors errorsOf(const simulation::MachineSettings& machine, const std::optional<Coupling>& coupling) {
  const simulation::Session session = simulation::recordSession(machine);
  return judge(accuracy::runSession(session, machine.start_stamp, shipped().mechanism, settingsWith(coupling)), session,
               machine);
}

void expectGood(const accuracy::SessionErrors& e, double rms) {
  EXPECT_LT(e.rms_z, rms);
  EXPECT_LT(e.rms_torque, 1.5 * rms);  // the drive's part included
  EXPECT_GT(e.covered_z, 0.88);
  EXPECT_GT(e.blows, 20);
  EXPECT_EQ(e.unseen_blows, 0);
  EXPECT_EQ(e.false_blows, 0);
}

/// What a rigid shaft makes of it shows that the flaw is there.
TEST(FlexibleShaftSession, IsAsGoodAsARigidOne) {
  std::uint64_t seed = 900;
  for (const double frequency : {30.0, 50.0, 80.0}) {
    for (const double rate : {1000.0, 200.0}) {
      simulation::MachineSettings machine = machineWith(frequency, 0.3, ++seed);
      machine.crank.rate = rate;
      SCOPED_TRACE(testing::Message() << frequency << " Hz at " << rate << " Hz");
      const accuracy::SessionErrors e = errorsOf(machine, Coupling{frequency, 0.3, 0.02, 0.3, 0.03});
      expectGood(e, 0.004);
      EXPECT_LT(e.energy, 0.03);
      EXPECT_LT(e.blow_time, 5e-4);
      // A rigid shaft's model is far off, or so far that its readings contradict it and nothing is published.
      EXPECT_FALSE(errorsOf(machine, {}).rms_z <= 4.0 * e.rms_z);
    }
  }
}

TEST(FlexibleShaftSession, AGuessedFrequencyMayBeWrong) {
  std::uint64_t seed = 930;
  for (const double frequency : {30.0, 50.0, 80.0}) {
    for (const double part : {0.8, 1.2}) {
      SCOPED_TRACE(testing::Message() << frequency << " Hz by " << part);
      expectGood(errorsOf(machineWith(frequency, 0.3, ++seed), Coupling{part * frequency, 0.3, 0.02, 0.3, 0.03}),
                 0.004);
    }
  }
}

TEST(FlexibleShaftSession, AWrongShareIsWithinTheDeviations) {
  for (const double part : {0.8, 1.2}) {
    SCOPED_TRACE(part);
    expectGood(errorsOf(machineWith(50.0, 0.2, 940), Coupling{50.0, part * 0.2, 0.02, 0.3, 0.03}), 0.015);
  }
}

/// Without a deviation of its own a wrong damping is outside of all others; a right one is not.
TEST(FlexibleShaftSession, AWrongDampingIsWithinTheDeviations) {
  const auto coveredAt = [](double truth, double deviation) {
    simulation::MachineSettings machine = machineWith(85.0, 0.3, 945);
    machine.drive.coupling_damping = truth;
    machine.crank.speed = false;
    machine.crank.stamp_noise = 1e-4;
    machine.blow.restitution_drawn = true;
    machine.blow.restitution_high = 0.3;
    return errorsOf(machine, Coupling{85.0, 0.3, 0.02, 0.03, 0.0, deviation}).covered_z;
  };
  EXPECT_GT(coveredAt(0.02, 0.0), 0.88);
  for (const double truth : {0.01, 0.045}) {
    EXPECT_LT(coveredAt(truth, 0.0), 0.75) << truth;
    EXPECT_GT(coveredAt(truth, 0.7), 0.88) << truth;
  }
}

/// A zero half a degree off hardly shows through a coupling: what is published is still on the right side of each blow,
/// where Fx jumps by all of its peak.
TEST(FlexibleShaftSession, NothingIsPublishedOnTheWrongSideOfABlow) {
  for (const std::uint64_t seed : {970U, 971U, 972U}) {
    simulation::MachineSettings machine = machineWith(50.0, 0.2, seed);
    machine.drive.coupling_damping = 0.04;
    machine.crank.counts = 1024;
    machine.crank.zero = 0.5 * kDegree;
    machine.crank.stamp_noise = 3e-4;
    machine.crank.speed = false;
    machine.blow.restitution_drawn = true;
    machine.blow.restitution_low = 0.1;
    machine.blow.restitution_high = 0.25;
    machine.duration = 20.0;
    machine.drive.stop_time = 18.5;
    const simulation::Session session = simulation::recordSession(machine);
    HammerParameters guess = shipped().mechanism.parameters();
    guess.drive_inertia *= 1.3;
    const accuracy::SessionRun run = accuracy::runSession(session, machine.start_stamp, *Mechanism::make(guess).value,
                                                          settingsWith(Coupling{45.0, 0.2, 0.02, 0.3, 0.03, 0.7}));
    EXPECT_LT(accuracy::judgeAtStamps(run, session, machine, 0.0).worst_x, 0.3) << seed;
  }
}

TEST(FlexibleShaftSession, BlowsThatDifferAndStampsThatJitter) {
  simulation::MachineSettings machine = machineWith(50.0, 0.3, 950);
  machine.blow.restitution_drawn = true;
  machine.blow.restitution_high = 0.3;
  machine.crank.stamp_noise = 2e-4;
  machine.crank.speed = false;
  expectGood(errorsOf(machine, Coupling{50.0, 0.3, 0.02, 0.3, 0.03}), 0.012);
}

TEST(FlexibleShaftSession, TheWarningNamesTheParameter) {
  const simulation::MachineSettings machine = machineWith(50.0, 0.5, 960);
  const simulation::Session session = simulation::recordSession(machine);
  const auto said = [&](const std::optional<Coupling>& coupling) {
    Pipeline pipeline(shipped().mechanism, settingsWith(coupling));
    for (const simulation::CrankReading& r : session.crank) pipeline.crankSample(r.stamp, {r.angle, r.speed});
    std::string all;
    for (const Warning& w : warningsOf(pipeline)) all += std::string(w.key) == "inconsistent" ? w.text : "";
    return all;
  };
  EXPECT_NE(said({}).find("shaft: flexible"), std::string::npos) << said({});
  EXPECT_EQ(said(Coupling{50.0, 0.5, 0.02, 0.3, 0.03}), "");
}

TEST(FlexibleShaftSession, AllocatesNothingPerSample) {
  const simulation::MachineSettings machine = machineWith(50.0, 0.3, 970);
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(shipped().mechanism, settingsWith(Coupling{50.0, 0.3, 0.02, 0.3, 0.03}));
  const std::size_t before = test::allocations;
  for (const simulation::CrankReading& r : session.crank) pipeline.crankSample(r.stamp, {r.angle, r.speed});
  EXPECT_EQ(test::allocations, before);
}

}  // namespace
}  // namespace hammer_loads
