/// Cranks that differ from their parameters, on simulated machines: which loads are withheld and which warnings given.
#include <gtest/gtest.h>

#include <functional>

#include "hammer_loads/crank/consistency.h"
#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using simulation::CrankReading;

simulation::Session workingSession(double rate = 1000.0) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 8.0;
  machine.drive.stop_time = 7.5;
  machine.crank.rate = rate;
  machine.crank.drop_outs.clear();
  return simulation::recordSession(machine);
}

constexpr double kRecognised = 5.0;  ///< [s]; errors must have shown within three seconds of work

struct Played {
  std::size_t wrenches{}, at_rest{}, blows{}, late_blows{}, samples{};
  std::vector<Warning> warnings;
  SampleCounts counts;
};

/// change: applied to each reading. At rest: published before the drive starts, where only weight acts.
Played play(const simulation::Session& session, const std::string& parameters,
            const std::function<void(CrankReading&)>& change) {
  simulation::Session changed = session;
  for (CrankReading& r : changed.crank) change(r);
  test::Player player(test::settingsWith(parameters), false, changed);
  Played played;
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    ++played.samples;
    played.wrenches += !result.refusal;
    played.at_rest += !result.refusal && time < test::kSessionWorks;
    played.blows += result.turn_ends;
    played.late_blows += time > kRecognised ? result.turn_ends : 0;
  });
  played.blows += player.pipeline.end().turn_ends;
  played.warnings = warningsOf(player.pipeline);
  played.counts = player.pipeline.counts();
  return played;
}

std::string textOfWarning(const Played& played, const std::string& key) {
  for (const Warning& w : played.warnings)
    if (w.key == key) return w.text;
  return {};
}

TEST(CrankTrust, PublishesASoundCrank) {
  for (const double rate : {100.0, 1000.0}) {
    const Played played = play(workingSession(rate), "{}", [](CrankReading&) {});
    EXPECT_GT(static_cast<double>(played.wrenches), 0.99 * static_cast<double>(played.samples)) << rate;
    EXPECT_GT(played.blows, 15U) << rate;
    EXPECT_EQ(played.counts.contradicting(), 0U) << rate;
    EXPECT_EQ(played.counts.impossible_blows, 0U) << rate;
    for (const Warning& w : played.warnings) EXPECT_FALSE(isContradiction(w.key)) << w.text;
  }
}

/// Loads of the moving crank are published only until it is recognised: for a quarter of a second, half a revolution
/// from rest. No blow is published.
void expectWithheld(const Played& played, const std::string& key) {
  EXPECT_LT(played.wrenches - played.at_rest, 250U) << key;
  EXPECT_EQ(played.blows, 0U) << key;
  EXPECT_EQ(played.counts.blows, 0U) << key;
  EXPECT_TRUE(played.counts.contradictSince({})) << key;
  ASSERT_NE(textOfWarning(played, key), "") << key;
}

TEST(CrankTrust, WithholdsABackwardCrankWithAndWithoutSpeeds) {
  const simulation::Session session = workingSession();
  expectWithheld(play(session, "{}",
                      [](CrankReading& r) {
                        r.angle = -r.angle;
                        if (r.speed) r.speed = -*r.speed;
                      }),
                 "backward");
  expectWithheld(play(session, "{}",
                      [](CrankReading& r) {
                        r.angle = -r.angle;
                        r.speed.reset();
                      }),
                 "backward");
  const Played right = play(session, "crank_direction: -1\n", [](CrankReading& r) {
    r.angle = -r.angle;
    if (r.speed) r.speed = -*r.speed;
  });
  EXPECT_GT(right.blows, 15U) << "with its direction it is a sound one";
}

TEST(CrankTrust, AnotherUnitIsWithheldAndNamed) {
  const simulation::Session session = workingSession();
  const double degrees = 360.0 / kTwoPi;
  const auto units = [](double angle, double speed) {
    return [=](CrankReading& r) {
      r.angle *= angle;
      if (r.speed) *r.speed *= speed;
    };
  };
  const Played rpm = play(session, "{}", units(1.0, 60.0 / kTwoPi));
  expectWithheld(rpm, "speed unit");
  EXPECT_NE(textOfWarning(rpm, "speed unit").find("rpm"), std::string::npos);
  const Played turns = play(session, "{}", units(1.0, 1.0 / kTwoPi));
  expectWithheld(turns, "speed unit");
  EXPECT_NE(textOfWarning(turns, "speed unit").find("turns per second"), std::string::npos);
  const Played angle = play(session, "{}", units(1.0 / kTwoPi, 1.0));
  expectWithheld(angle, "angle unit");
  EXPECT_NE(textOfWarning(angle, "angle unit").find("angle is in turns"), std::string::npos);
  for (const double speed : {degrees, 1.0}) {
    const Played in_degrees = play(session, "{}", units(degrees, speed));
    expectWithheld(in_degrees, "degrees");
    for (const Warning& w : in_degrees.warnings) EXPECT_STREQ(w.key, "degrees") << "and nothing else: " << w.text;
  }
}

/// The readings of the encoder wrap at one revolution, or continue to count.
TEST(CrankTrust, NamesAnAngleInTurnsOrCountsWhateverTheSpeeds) {
  const simulation::Session session = workingSession();
  for (const bool wrapped : {true, false}) {
    for (const double revolution : {1.0, 2000.0}) {
      for (const double speed : {0.0, revolution / kTwoPi}) {
        double turns = 0.0, before = session.crank.front().angle;
        const Played played = play(session, "{}", [&](CrankReading& r) {
          turns += CrankAngle::wrapToPi(r.angle - before) / kTwoPi;
          before = r.angle;
          r.angle = revolution * (wrapped ? turns - std::floor(turns) : turns);
          if (speed == 0.0) r.speed.reset();
          if (r.speed) *r.speed *= speed;
        });
        const std::string what = (wrapped ? "wrapped " : "counting on ") + std::to_string(revolution);
        const std::string text = textOfWarning(played, "angle unit");
        EXPECT_NE(text.find(revolution == 1.0 ? "is in turns" : "is in encoder counts"), std::string::npos)
            << what << ", speed " << speed << ": " << text;
        EXPECT_TRUE(played.counts.contradictSince({})) << what << ", speed " << speed;
        EXPECT_LE(played.counts.blows, 3U) << what << ", speed " << speed;
      }
    }
  }
}

TEST(CrankTrust, NamesASpeedOfTheWrongSign) {
  const Played played = play(workingSession(), "{}", [](CrankReading& r) {
    if (r.speed) *r.speed = -*r.speed;
  });
  EXPECT_NE(textOfWarning(played, "speed unit").find("opposite sign"), std::string::npos);
  EXPECT_EQ(played.blows, 0U);
  EXPECT_TRUE(played.counts.contradictSince({}));
}

/// Withheld samples remain counted. The warning of an earlier contradiction does not mention the hammer file any more.
TEST(CrankTrust, ACrankThatAgreesAgainIsNamedAsThat) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 14.0;
  const simulation::Session session = simulation::recordSession(machine);
  const auto until = session.crank.front().stamp + 5'000'000'000;
  const Played played = play(session, "{}", [until](CrankReading& r) { r.angle += r.stamp < until ? 0.5 : 0.0; });
  const std::string text = textOfWarning(played, "inconsistent before");
  EXPECT_NE(text.find("samples withheld while readings contradicted the model"), std::string::npos) << text;
  EXPECT_EQ(text.find("hammer file"), std::string::npos) << text;
}

simulation::MachineSettings elasticMachine(double stiffness, double damping_ratio) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.rod = {stiffness, damping_ratio, 0.0};
  machine.duration = 8.0;
  machine.drive.stop_time = 7.5;
  machine.crank.drop_outs.clear();
  return machine;
}

/// An elastic rod, a coarse encoder and missing speeds keep the innovations within their expected size.
TEST(CrankTrust, WithholdsAZeroFarOffOnAMachineWithAnElasticRod) {
  simulation::MachineSettings machine = elasticMachine(8e8, 0.3);
  machine.crank.speed = false;
  machine.crank.counts = 1024;
  machine.crank.stamp_noise = 3e-4;
  machine.crank.stamps_ordered = true;
  const simulation::Session session = simulation::recordSession(machine);
  EXPECT_GT(play(session, "{}", [](CrankReading&) {}).late_blows, 8U) << "with its zero it is a sound one";
  for (const double off : {-0.5, 0.5}) {
    const Played played = play(session, "{}", [off](CrankReading& r) { r.angle += off; });
    EXPECT_LE(played.late_blows, 2U) << off << ": the zero is found after some turns that are like each other";
    EXPECT_NE(textOfWarning(played, "zero off").find("crank_zero_rad is off by"), std::string::npos);
    EXPECT_EQ(textOfWarning(played, "eccentricity"), "") << "what a zero far off looks like besides";
  }
}

/// The machine runs away, three times as fast as at work.
TEST(CrankTrust, AMachineThatRunsAwayWithoutAToolStrikesNoBlows) {
  simulation::MachineSettings machine = elasticMachine(1e9, 0.2);
  machine.strike.no_tool_from = 4.0;
  machine.strike.no_tool_to = 6.0;
  const simulation::Session session = simulation::recordSession(machine);
  std::size_t before = 0, without = 0;
  double hardest = 0.0;
  test::Player player(test::settingsWith("{}"), false, session);
  player.playTo(1e9, [&](double, const SampleResult& result) {
    for (std::size_t i = 0; i < result.turn_ends; ++i) {
      const double time = seconds(result.ends[i].stamp - machine.start_stamp);
      before += time < 4.0;
      without += time > 4.3 && time < 6.0;
      hardest = std::max(hardest, result.ends[i].blow.energy);
    }
  });
  EXPECT_GT(before, 5U);
  EXPECT_LE(without, 1U) << "the first of them may look like a soft blow";
  EXPECT_LT(hardest, 1500.0);
}

/// First blank firing of a machine with an elastic connecting rod. Near the dead centre the readings support either
/// branch alternately; half a radian behind it they support the right one.
TEST(CrankTrust, TheFirstStrokeWithoutAToolIsFollowedOnTheRightBranch) {
  for (const double stiffness : {4e8, 1e9, 4e9}) {
    const double tool_lost = 4.2;
    simulation::MachineSettings machine = elasticMachine(stiffness, 0.6);
    machine.crank.counts = 4096;
    machine.strike.no_tool_from = tool_lost;
    machine.strike.no_tool_to = tool_lost + 1.0;
    const simulation::Session session = simulation::recordSession(machine);
    test::Player player(test::settingsWith("{}"), false, session);
    std::size_t published = 0, samples = 0, i = 0;
    double square_error = 0.0, square_true = 0.0;
    player.playTo(1e9, [&](double time, const SampleResult& result) {
      const simulation::CrankTruth& truth = session.truth[i++];
      const double offset = CrankAngle::wrapToPi(truth.angle);
      if (!(time > tool_lost && time < tool_lost + 0.9) || !(offset > 0.8)) return;
      ++samples;
      if (result.refusal) return;
      ++published;
      square_error += square(result.wrench.force_x - truth.load.force_x);
      square_true += square(truth.load.force_x);
    });
    EXPECT_GT(samples, 100U);
    EXPECT_GT(10 * published, 9 * samples) << stiffness;
    EXPECT_LT(square_error, square(0.02) * square_true) << stiffness;
  }
}

TEST(CrankTrust, AZeroGivenInDegreesIsNamed) {
  const simulation::Session session = workingSession();
  const double degrees = 140.0;
  const Played played =
      play(session, "crank_zero_rad: 140.0\n", [=](CrankReading& r) { r.angle += degrees * kTwoPi / 360.0; });
  const std::string text = textOfWarning(played, "zero off");
  EXPECT_NE(text.find("140 degrees"), std::string::npos) << text;
}

}  // namespace
}  // namespace hammer_loads
