// Warnings about machines with elastic connecting rods and about their faulty sensors, for rods not used in tuning.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "pipeline/shipped_machine.h"

namespace hammer_loads {
namespace {

/// Draws stiffness 2e8 to 1e10 N/m, damping ratio 0.2 to 3, joint clearance up to 0.5 mm, none for every third seed.
simulation::MachineSettings drawnMachine(std::mt19937_64& random, std::uint64_t seed) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  simulation::MachineSettings s = test::machineWithRod({}, seed);
  s.duration = 14.0;
  s.drive.stop_time = 20.0;
  s.rod.stiffness = 2e8 * std::pow(50.0, part(random));
  s.rod.damping_ratio = 0.2 * std::pow(15.0, part(random));
  s.rod.play = seed % 3 == 0 ? 0.0 : 5e-4 * part(random);
  s.crank.speed = seed % 2 == 0;
  for (simulation::JointMotion& joint : s.boom) joint.mean = joint.amplitude = 0.0;
  return s;
}

/// Returns the texts of all warnings, one line each, except that of the pose.
std::string heardOf(const simulation::MachineSettings& machine, Level level) {
  PipelineSettings pipeline_settings = test::shippedDrawing().pipeline;
  pipeline_settings.level = level;
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(test::shippedDrawing().mechanism, pipeline_settings);
  for (const simulation::CrankReading& reading : session.crank)
    pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
  std::string text;
  for (const Warning& warning : warningsOf(pipeline))
    if (std::string(warning.key) != "pitch joints") text += std::string(warning.key) + ": " + warning.text + "\n";
  return text;
}

bool names(const std::string& text, const char* what) { return text.find(what) != std::string::npos; }

TEST(RodWarnings, ACorrectSensorIsNotBlamedForAnElasticRod) {
  std::mt19937_64 random(4301);
  for (std::uint64_t i = 0; i < 6; ++i) {
    const simulation::MachineSettings machine = drawnMachine(random, 4300 + i);
    const std::string text = heardOf(machine, i % 2 == 0 ? Level::kLinkage : Level::kElastic);
    SCOPED_TRACE(testing::Message() << machine.rod.stiffness << " N/m, " << machine.rod.damping_ratio << ", "
                                    << machine.rod.play << " m\n"
                                    << text);
    EXPECT_TRUE(names(text, "crank: connecting rod or pins are elastic") ||
                names(text, "crank: an unknown force of ") || names(text, "crank: level elastic is not used"));
    for (const char* innocent :
         {"run calibrate", "eccentric", "coupling", "masses", "hammer file", "slipped", "behind"})
      EXPECT_FALSE(names(text, innocent)) << innocent;
  }
}

/// An unmodelled vibration shakes the crank for twelve seconds, in the half revolution after the blow. Then the
/// readings agree with the model again.
TEST(RodWarnings, ReportsNoCauseThatHasPassed) {
  simulation::MachineSettings machine = test::machineWithRod({}, 4401);
  machine.duration = 18.0;
  machine.drive.stop_time = 25.0;
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(test::shippedDrawing().mechanism, test::shippedDrawing().pipeline);
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankReading& r = session.crank[i];
    const double time = session.truth[i].time, since_blow = CrankAngle::wrapToPi(session.truth[i].angle);
    const bool shaken = time > 4.0 && time < 16.0 && since_blow > 0.3 && since_blow < 2.8;
    pipeline.crankSample(r.stamp, {r.angle + (shaken ? 0.004 * std::sin(600.0 * time) : 0.0), r.speed});
  }
  const std::vector<Warning> warnings = warningsOf(pipeline);
  const auto stated = std::find_if(warnings.begin(), warnings.end(),
                                   [](const Warning& w) { return std::string(w.key) == "inconsistent"; });
  ASSERT_NE(stated, warnings.end());
  EXPECT_LT(pipeline.crank().tracker().consistency(), 1.5);
  EXPECT_TRUE(names(stated->text, "readings differed from the model")) << stated->text;
  EXPECT_FALSE(names(stated->text, "readings differ ")) << stated->text;
}

/// Coarse or rare readings show less of the rod and of the zero. If the rigid model follows less than half of such a
/// recording, other possible causes are named after the rod.
TEST(RodWarnings, ACorrectSensorIsNotBlamedForCoarseOrRareReadings) {
  std::mt19937_64 random(4302);
  int lost_most = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    simulation::MachineSettings machine = drawnMachine(random, 4330 + i);
    const double rates[] = {1000.0, 500.0, 200.0};
    machine.crank.rate = rates[i % 3];
    machine.crank.counts = i % 3 == 0 ? 1024 : 4096;
    const std::string text = heardOf(machine, Level::kLinkage);
    SCOPED_TRACE(testing::Message() << machine.rod.stiffness << " N/m, " << machine.rod.damping_ratio << ", "
                                    << machine.rod.play << " m\n"
                                    << text);
    const bool lost = names(text, "rod or pins may be elastic");
    lost_most += lost;
    for (const char* innocent :
         {"run calibrate", "eccentric", "coupling", "masses", "hammer file", "slipped", "behind"})
      EXPECT_FALSE(!lost && names(text, innocent)) << innocent;
  }
  EXPECT_LE(lost_most, 1);
}

/// A rigid rod is not blamed for an error of a sensor or a shaft.
TEST(RodWarnings, ARigidRodIsNotBlamed) {
  std::mt19937_64 random(4303);
  const simulation::MachineSettings base = drawnMachine(random, 4350);
  const auto rigid = [&](const auto& flaw) {
    simulation::MachineSettings machine = base;
    machine.rod = {};
    flaw(machine);
    return heardOf(machine, Level::kLinkage);
  };
  for (const double off : {1.0, -1.0, 2.0}) {
    const std::string text = rigid([&](auto& m) { m.crank.zero = off * kDegree; });
    EXPECT_TRUE(names(text, "zero: ")) << off << text;
    EXPECT_FALSE(names(text, "rod, pins")) << off << text;
  }
  for (const double off : {6.0, 10.0}) {  // withheld: an error before the blow is not due to a rod
    const std::string text = rigid([&](auto& m) { m.crank.zero = -off * kDegree; });
    EXPECT_TRUE(names(text, "crank_zero_rad")) << off << text;
    EXPECT_FALSE(names(text, "level: elastic")) << off << text;
  }
  EXPECT_FALSE(names(rigid([](auto& m) { m.crank.eccentricity[0] = {1.2 * kDegree, 0.7}; }), "rod, pins"));
  EXPECT_FALSE(names(rigid([](auto& m) { m.strike = {}, m.blow.tool_early = 0.05; }), "rod, pins"));
  EXPECT_FALSE(names(rigid([](auto& m) { m.blow.blank_share = 0.1; }), "rod, pins"));
  EXPECT_EQ(rigid([](auto&) {}), "");
  const std::string coupling = rigid([](auto& m) { m.drive.coupling_frequency = 50.0; });
  EXPECT_FALSE(names(coupling, "rod, pins")) << coupling;
  EXPECT_TRUE(names(coupling, "coupling")) << coupling;
}

/// Such a rod explains up to 3 deg of the zero and 1.5 deg of the eccentricity; a notable error beyond is named.
TEST(RodWarnings, NamesACauseThatNoRodExplainsBesideIt) {
  const auto heard = [](double zero, double eccentricity) {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.hammer = test::shippedDrawing().mechanism.parameters();
    machine.level = Level::kLinkage;
    machine.duration = 8.0;
    machine.drive.start_time = 0.1, machine.drive.stop_time = 20.0;
    machine.rod = {1e9, 0.5, 0.0};
    machine.crank.zero = zero * kDegree;
    machine.crank.eccentricity[0] = {eccentricity * kDegree, 0.7};
    for (simulation::JointMotion& joint : machine.boom) joint.mean = joint.amplitude = 0.0;
    return heardOf(machine, Level::kLinkage);
  };
  for (const double off : {-2.0, -4.0}) {
    const std::string text = heard(off, 0.0);
    EXPECT_EQ(names(text, "connecting rod or pins are elastic"), off > -3.0) << text;
    EXPECT_EQ(names(text, "crank_zero_rad is off by"), off < -3.0) << text;
  }
  for (const double off : {2.0, 3.5}) {
    const std::string text = heard(0.0, off);
    EXPECT_TRUE(names(text, "connecting rod or pins are elastic")) << text;
    EXPECT_EQ(names(text, "eccentricity: "), off > 3.0) << text;
  }
}

}  // namespace
}  // namespace hammer_loads
