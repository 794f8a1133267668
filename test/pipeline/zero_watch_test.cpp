/// A zero that is wrong by any angle, on simulated machines: what is published, and what is stated of it.
#include "hammer_loads/pipeline/zero_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hammer_loads/pipeline/life_follower.h"
#include "pipeline/drawn_machine.h"
#include "support/known_zero.h"

namespace hammer_loads {
namespace {

const std::string kUnknownZero = "crank_zero_std_rad: 0.09\n";  // as shipped

simulation::Session zeroSession(double rate, std::uint64_t seed, double duration = 8.0) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = duration;
  machine.drive.stop_time = duration;
  machine.crank.rate = rate;
  machine.crank.drop_outs.clear();
  machine.seed = seed;
  return simulation::recordSession(machine);
}

/// zero: added to each reading [rad]; from: instant of the first sample that is judged [s].
test::ZeroPlayed playWithZero(const simulation::Session& session, double zero, bool speeds, double from = 4.2) {
  simulation::Session changed = session;
  for (simulation::CrankReading& r : changed.crank) {
    r.angle += zero;
    if (!speeds) r.speed.reset();
  }
  return test::playZero(test::settingsWith(kUnknownZero), changed, {}, from);
}

/// Within ten turns a wrong zero has shown itself.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationAfterTenTurns) {
  for (const double rate : {1000.0}) {
    const simulation::Session session = zeroSession(rate, 5);
    for (const double degrees : {-10.0, -6.0, -2.0, -0.7, 0.7, 6.0, 10.0}) {
      const test::ZeroPlayed played = playWithZero(session, degrees * kDegree, degrees > -3.0);
      EXPECT_EQ(played.beyond, 0U) << rate << " Hz, " << degrees << " deg: " << played.worst << " deviations";
      EXPECT_GT(played.published, 0U) << "the crank at rest";
    }
  }
}

/// Machines, sensors and zeros of up to 10 deg are drawn. Before the first blow nothing shows the zero: its prior
/// stands in the deviations until the turns have shown it.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationFromTheStartOn) {
  const Settings rigid = test::settingsWith("level: linkage\n" + kUnknownZero),
                 elastic = test::settingsWith("level: elastic\n" + kUnknownZero);
  constexpr std::uint64_t kFirst = 990000;
  std::size_t wrong = 0;
  for (std::uint64_t seed = kFirst; seed < kFirst + 24; ++seed) {
    const test::DrawnMachine drawn = test::drawMachine(rigid, seed, 10.0 * kDegree, 5.0);
    const simulation::Session session = simulation::recordSession(drawn.machine);
    const test::ZeroPlayed played =
        test::playZero(drawn.elastic ? elastic : rigid, session,
                       drawn.elastic ? test::touchesOf(drawn.machine) : std::vector<double>{});
    wrong += played.beyond;
    EXPECT_EQ(played.beyond, 0U) << seed << ": " << played.worst << " deviations at " << played.worst_at << " s, zero "
                                 << drawn.machine.crank.zero / kDegree << " deg";
  }
  EXPECT_EQ(wrong, 0U);
}

/// The filter explains the readings of this machine with a zero 7.5 deg wrong, and finds 0.6 deg: only the search over
/// the whole turn contradicts it.
TEST(ZeroWatch, SearchesEvenWhereTheFilterAgreesWithItsReadings) {
  const Settings settings = test::settingsWith("level: linkage\n" + kUnknownZero);
  const test::DrawnMachine drawn = test::drawMachine(settings, 1230213, 10.0 * kDegree, 8.0);
  ASSERT_FALSE(drawn.elastic);
  const test::ZeroPlayed played = test::playZero(settings, simulation::recordSession(drawn.machine));
  EXPECT_EQ(played.beyond, 0U) << played.worst << " deviations at " << played.worst_at << " s";
  EXPECT_TRUE(played.withholds);
  EXPECT_NEAR(played.stated, drawn.machine.crank.zero, std::max(0.5 * kDegree, 2.0 * played.deviation));
}

/// What is counted cannot be taken back: with a zero wrong by more than is corrected nothing ever is, with a right one
/// once it is known.
TEST(ZeroWatch, NothingCountsBeforeTheZeroIsKnown) {
  const simulation::Session session = zeroSession(1000.0, 5);
  const Settings settings = test::settingsWith(kUnknownZero);
  for (const double degrees : {-10.0, -5.0, -3.0, 0.0, 3.0, 5.0, 10.0}) {
    simulation::Session changed = session;
    for (simulation::CrankReading& r : changed.crank) r.angle += degrees * kDegree;
    test::Player player(settings, false, changed);
    LifeFollower life(player.pipeline, settings.life);
    player.playTo(1e9, [&](double, const SampleResult&) { life.follow(); });
    EXPECT_EQ(life.since().has_value(), degrees == 0.0) << degrees << " deg";
  }
}

/// Of a right zero the first second has to stay; one that `calibrate` has found costs nothing.
TEST(ZeroWatch, WithholdsLittleOfARightZeroAndNothingOfACalibratedOne) {
  const Settings given = test::settingsWith("level: linkage\n" + kUnknownZero),
                 calibrated = test::settingsWith(std::string("level: linkage\n") + kKnownZeroYaml);
  const simulation::Session session = zeroSession(1000.0, 5, 5.0);
  const auto published = [&](const Settings& settings) {
    const test::ZeroPlayed played = test::playZero(settings, session);
    return static_cast<double>(played.early_published) / static_cast<double>(played.early);
  };
  EXPECT_GT(published(given), 0.7);
  EXPECT_GT(published(calibrated), 0.97);
}

TEST(ZeroWatch, StatesTheErrorOfTheZeroAndWithholdsALargeOne) {
  const simulation::Session session = zeroSession(1000.0, 6, 10.0);
  for (const double degrees : {-9.0, -4.0, -1.0, 0.0, 1.2, 2.5, 5.0, 9.0}) {
    const test::ZeroPlayed played = playWithZero(session, degrees * kDegree, true);
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
