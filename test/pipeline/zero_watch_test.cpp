/// A zero that is wrong by any angle, on simulated machines: what is published, and what is stated of it.
#include "hammer_loads/pipeline/zero_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kImpossibleError = 6.0;  // standard deviations
constexpr double kNearTouch = 1.0e-3;     // [s]: a contact is not part of the wrench

simulation::Session zeroSession(double rate, std::uint64_t seed, double duration = 8.0) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = duration;
  machine.drive.stop_time = duration;
  machine.crank.rate = rate;
  machine.crank.drop_outs.clear();
  machine.seed = seed;
  return simulation::recordSession(machine);
}

struct ZeroPlayed {
  std::size_t published{}, beyond{};
  double worst{};                ///< error over standard deviation
  double worst_of_peak{};        ///< error of Fx over its peak, after the start
  double stated{}, deviation{};  ///< error of the zero [rad]
  bool withholds{};
  std::vector<Warning> warnings;
};

/// zero: added to each reading [rad]; from: instant of the first sample that is judged [s].
ZeroPlayed playWithZero(const simulation::Session& session, double zero, bool speeds, double from = 4.2) {
  simulation::Session changed = session;
  for (simulation::CrankReading& r : changed.crank) {
    r.angle += zero;
    if (!speeds) r.speed.reset();
  }
  test::Player player(test::settingsWith("{}"), false, changed);
  ZeroPlayed played;
  std::size_t i = 0;
  double peak = 0.0, worst = 0.0;
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    const simulation::CrankTruth& truth = session.truth[i++];
    peak = std::max(peak, std::abs(truth.load.force_x));
    if (result.refusal || result.outputs.empty()) return;
    ++played.published;
    const bool touches = std::any_of(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
      return std::abs(b.time - time) < kNearTouch;
    });
    if (touches || truth.touches() || time < from) return;
    const WrenchOutput& output = result.outputs.front();
    const Eigen::Vector3d is(truth.load.force_x, truth.load.force_z, truth.load.torque_y + truth.drive_reaction_y);
    const Eigen::Vector3d error = (vectorOf(output.wrench) - is).cwiseAbs();
    const double ratio = error.cwiseQuotient(vectorOf(output.deviation.wrench)).maxCoeff();
    played.worst = std::max(played.worst, ratio);
    played.beyond += ratio > kImpossibleError;
    if (time > 4.0) worst = std::max(worst, error[0]);
  });
  const ConstantErrors& errors = player.pipeline.crank().tracker().constantErrors();
  played.worst_of_peak = worst / peak;
  played.withholds = player.pipeline.zeroWatch().withholds();
  played.stated = player.pipeline.zeroWatch().moved() + errors.estimate()[ConstantErrors::kZero];
  played.deviation = std::hypot(errors.deviation()[ConstantErrors::kZero], errors.zeroNotLinear());
  played.warnings = warningsOf(player.pipeline);
  return played;
}

/// Within ten turns a wrong zero has shown itself.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationAfterTenTurns) {
  for (const double rate : {1000.0}) {
    const simulation::Session session = zeroSession(rate, 5);
    for (const double degrees : {-10.0, -6.0, -2.0, -0.7, 0.7, 6.0, 10.0}) {
      const ZeroPlayed played = playWithZero(session, degrees * kDegree, degrees > -3.0);
      EXPECT_EQ(played.beyond, 0U) << rate << " Hz, " << degrees << " deg: " << played.worst << " deviations";
      EXPECT_GT(played.published, 0U) << "the crank at rest";
    }
  }
}

/// Before the first blow nothing shows the zero: its prior stands in the deviations, then what the first turns show.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationFromTheFirstTurnOn) {
  const simulation::Session session = zeroSession(1000.0, 5);
  const double first_turn = session.blows.at(1).time;
  for (const double degrees : {-8.0, -4.0, -3.0, -1.5, 1.5, 3.0, 4.0, 8.0}) {
    const ZeroPlayed played = playWithZero(session, degrees * kDegree, true, first_turn);
    EXPECT_LE(played.beyond, std::abs(degrees) > 3.0 ? 5U : 0U) << degrees << " deg: " << played.worst << " deviations";
  }
}

TEST(ZeroWatch, StatesTheErrorOfTheZeroAndWithholdsALargeOne) {
  const simulation::Session session = zeroSession(1000.0, 6, 10.0);
  for (const double degrees : {-9.0, -4.0, -1.0, 0.0, 1.2, 2.5, 5.0, 9.0}) {
    const ZeroPlayed played = playWithZero(session, degrees * kDegree, true);
    EXPECT_NEAR(played.stated, degrees * kDegree, std::max(0.5 * kDegree, 2.0 * played.deviation)) << degrees;
    EXPECT_LT(played.deviation, 0.6 * kDegree) << degrees;
    EXPECT_EQ(played.withholds, std::abs(degrees) > 2.0) << degrees;
    const bool named = std::any_of(played.warnings.begin(), played.warnings.end(),
                                   [](const Warning& w) { return w.text.find("crank_zero_rad") != std::string::npos; });
    EXPECT_EQ(named, degrees != 0.0) << degrees;
    for (const Warning& w : played.warnings) EXPECT_EQ(w.text.find("elastic"), std::string::npos) << w.text;
  }
}

TEST(ZeroSearch, FindsTheBlowAllAroundTheTurn) {
  const simulation::Session session = zeroSession(500.0, 8);
  const Settings settings = test::settingsWith("{}");
  for (double degrees = -170.0; degrees < 180.0; degrees += 43.0) {
    ZeroSearch search(ShaftModel(settings.mechanism, Level::kRocker), 0.6);
    double before = -1.0;
    for (std::size_t i = 0; i < session.crank.size(); ++i) {
      const double time = session.truth[i].time;
      search.add(session.crank[i].angle + degrees * kDegree, before < 0.0 ? 0.0 : time - before, HullMotion{});
      before = time;
    }
    ASSERT_TRUE(search.found()) << degrees;
    EXPECT_NEAR(CrankAngle::wrapToPi(search.found()->error - degrees * kDegree), 0.0, 3.0 * kDegree) << degrees;
  }
}

TEST(ZeroSearch, FindsNothingAtConstantSpeed) {
  const Settings settings = test::settingsWith("{}");
  ZeroSearch search(ShaftModel(settings.mechanism, Level::kRocker), 0.6);
  for (int i = 0; i < 8000; ++i) search.add(0.02 * i, i == 0 ? 0.0 : 1e-3, HullMotion{});
  EXPECT_GT(search.evaluations(), 3);
  EXPECT_FALSE(search.found());
}

}  // namespace
}  // namespace hammer_loads
