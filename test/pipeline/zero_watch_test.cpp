/// Simulated machines with any error of the encoder's zero: published wrenches and stated error of the zero.
#include "hammer_loads/pipeline/zero_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>

#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kImpossibleError = 6.0;  ///< standard deviations
constexpr double kNearTouch = 1.0e-3;     ///< [s]: the contact force is not part of the wrench

struct DrawnMachine {
  simulation::MachineSettings machine;
  bool elastic{};  ///< false: rigid connecting rod
};

/// Draws rates, counts, speeds, supply, drive inertia, blow, start angle and connecting rod. zero: largest error of the
/// encoder's zero, in either direction [rad].
DrawnMachine drawMachine(const Settings& nominal, std::uint64_t seed, double zero, double duration) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
  };
  const auto oneOf = [&](auto... values) {
    const double all[] = {static_cast<double>(values)...};
    return all[std::min(std::size(all) - 1, static_cast<std::size_t>(between(0.0, std::size(all))))];
  };
  DrawnMachine drawn{simulation::workingMo100(), between(0.0, 1.0) < 0.5};
  simulation::MachineSettings& m = drawn.machine;
  m.hammer = nominal.mechanism.parameters();
  m.level = Level::kLinkage;
  m.seed = seed;
  m.duration = duration;
  m.start_angle = between(0.3, 5.9);
  m.crank.rate = oneOf(100.0, 200.0, 200.0, 500.0, 1000.0);
  m.crank.counts = static_cast<int>(oneOf(0, 720, 1024, 4096, 4096, 20000));
  m.crank.jitter = oneOf(0.0, 3e-5, 1e-4);
  m.crank.zero = zero * between(-1.0, 1.0);
  m.crank.speed = between(0.0, 1.0) < 0.5;
  m.crank.speed_noise = between(0.05, 0.3);
  m.crank.drop_outs.clear();
  m.drive.inertia *= between(0.7, 1.4);
  m.drive.flow *= between(0.8, 1.15);
  m.drive.relief_pressure *= between(0.9, 1.15);
  m.drive.start_time = 0.5;
  m.drive.start_ramp = between(0.2, 1.0);
  m.drive.stop_time = duration;
  m.blow.restitution_drawn = true;
  m.blow.restitution_low = between(0.05, 0.15);
  m.blow.restitution_high = m.blow.restitution_low + between(0.0, 0.1);
  if (drawn.elastic) m.rod = {between(6e8, 2e9), between(0.2, 2.0), 0.0};
  return drawn;
}

/// Returns the instants at which the rocker of an elastic machine touches the tool [s], to 0.2 ms.
std::vector<double> touchesOf(const simulation::MachineSettings& machine) {
  std::vector<double> times, touches;
  for (double time = 0.0; time < machine.duration; time += 2e-4) times.push_back(time);
  for (const simulation::CrankTruth& truth : simulation::truthAt(machine, times))
    if (truth.touches()) touches.push_back(truth.time);
  return touches;
}

struct ZeroPlayed {
  std::size_t samples{}, published{}, beyond{};
  std::size_t early{}, early_published{};  ///< samples of the first second of motion
  double worst{};                          ///< error over standard deviation
  double worst_at{};                       ///< [s]
  double worst_blow{};                     ///< largest error of a blow's energy over its standard deviation
  double worst_of_peak{};                  ///< error of Fx over its peak, after the start
  double stated{}, deviation{};            ///< stated error of the zero and its standard deviation [rad]
  bool withholds{};
  std::vector<Warning> warnings;
};

/// Returns the error of a blow's energy at `time` [s] over its standard deviation; 0: the energy is not stated.
double blowError(const TurnEnd& end, double time, const std::vector<simulation::BlowTruth>& blows) {
  if (!(end.blow.energy_std > 0.0)) return 0.0;
  const auto truth = std::min_element(blows.begin(), blows.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
  return truth == blows.end() ? 0.0 : std::abs(end.blow.energy - truth->strike.energy) / end.blow.energy_std;
}

/// Plays a session. from: instant of the first sample that is judged [s].
ZeroPlayed playZero(const Settings& settings, const simulation::Session& session,
                    const std::vector<double>& touches = {}, double from = 0.0) {
  test::Player player(settings, false, session);
  ZeroPlayed played;
  std::size_t i = 0;
  double peak = 0.0, worst = 0.0, moves = -1.0;
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    const simulation::CrankTruth& truth = session.truth[i++];
    peak = std::max(peak, std::abs(truth.load.force_x));
    if (moves < 0.0 && std::abs(truth.speed) > 1.0) moves = time;
    const bool early = moves >= 0.0 && time < moves + 1.0, is_published = !result.refusal && !result.outputs.empty();
    if (moves >= 0.0) ++(early ? played.early : played.samples);
    for (std::size_t k = 0; k < result.turn_ends; ++k)
      played.worst_blow =
          std::max(played.worst_blow,
                   blowError(result.ends[k], time + seconds(result.ends[k].stamp - result.stamp), session.blows));
    if (!is_published) return;
    if (moves >= 0.0) ++(early ? played.early_published : played.published);
    const bool strikes = std::any_of(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
      return std::abs(b.time - time) < kNearTouch;
    });
    const auto touch = std::lower_bound(touches.begin(), touches.end(), time - kNearTouch);
    const bool near = touch != touches.end() && *touch < time + kNearTouch;
    if (strikes || near || truth.touches() || time < from) return;
    const WrenchOutput& output = result.outputs.front();
    const Eigen::Vector3d is(truth.load.force_x, truth.load.force_z, truth.load.torque_y + truth.drive_reaction_y);
    const Eigen::Vector3d error = (vectorOf(output.wrench) - is).cwiseAbs();
    const double ratio = error.cwiseQuotient(vectorOf(output.deviation.wrench())).maxCoeff();
    if (ratio > played.worst) played.worst = ratio, played.worst_at = time;
    played.beyond += ratio > kImpossibleError;
    if (time > 4.0) worst = std::max(worst, error[0]);
  });
  played.worst_of_peak = worst / peak;
  played.withholds = player.pipeline.zeroWatch().withholds();
  const ZeroWatch::Stated stated = player.pipeline.zeroWatch().stated(player.pipeline.crank().tracker());
  played.stated = stated.error, played.deviation = stated.deviation;
  played.warnings = warningsOf(player.pipeline);
  return played;
}

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
ZeroPlayed playWithZero(const simulation::Session& session, double zero, bool speeds, double from = 4.2) {
  simulation::Session changed = session;
  for (simulation::CrankReading& r : changed.crank) {
    r.angle += zero;
    if (!speeds) r.speed.reset();
  }
  return playZero(test::settingsWith(kUnknownZero), changed, {}, from);
}

/// A wrong zero shows within ten revolutions.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationAfterTenTurns) {
  const simulation::Session session = zeroSession(1000.0, 5);
  for (const double degrees : {-10.0, -6.0, -2.0, -0.7, 0.7, 6.0, 10.0}) {
    const ZeroPlayed played = playWithZero(session, degrees * kDegree, degrees > -3.0);
    EXPECT_EQ(played.beyond, 0U) << degrees << " deg: " << played.worst << " deviations";
    EXPECT_GT(played.published, 0U) << "the crank at rest";
  }
}

/// Machines, sensors and zeros of up to 10 deg are drawn. Nothing shows the zero before the first blow. The deviations
/// contain its prior until the revolutions have shown it.
TEST(ZeroWatch, PublishesNothingThatIsImpossibleByItsDeviationFromTheStartOn) {
  const Settings rigid = test::settingsWith("level: linkage\n" + kUnknownZero),
                 elastic = test::settingsWith("level: elastic\n" + kUnknownZero);
  constexpr std::uint64_t kFirst = 990000;
  std::size_t wrong = 0;
  for (std::uint64_t seed = kFirst; seed < kFirst + 12; ++seed) {
    const DrawnMachine drawn = drawMachine(rigid, seed, 10.0 * kDegree, 5.0);
    const simulation::Session session = simulation::recordSession(drawn.machine);
    const ZeroPlayed played = playZero(drawn.elastic ? elastic : rigid, session,
                                       drawn.elastic ? touchesOf(drawn.machine) : std::vector<double>{});
    wrong += played.beyond;
    EXPECT_EQ(played.beyond, 0U) << seed << ": " << played.worst << " deviations at " << played.worst_at << " s, zero "
                                 << drawn.machine.crank.zero / kDegree << " deg";
  }
  EXPECT_EQ(wrong, 0U);
}

/// The filter explains the readings of this machine with a zero 7.5 deg wrong, and finds 0.6 deg. Only the search over
/// the whole revolution contradicts it.
TEST(ZeroWatch, SearchesEvenWhereTheFilterAgreesWithItsReadings) {
  const Settings settings = test::settingsWith("level: linkage\n" + kUnknownZero);
  const DrawnMachine drawn = drawMachine(settings, 1230213, 10.0 * kDegree, 8.0);
  ASSERT_FALSE(drawn.elastic);
  const ZeroPlayed played = playZero(settings, simulation::recordSession(drawn.machine));
  EXPECT_EQ(played.beyond, 0U) << played.worst << " deviations at " << played.worst_at << " s";
  EXPECT_TRUE(played.withholds);
  EXPECT_NEAR(played.stated, drawn.machine.crank.zero, std::max(0.5 * kDegree, 2.0 * played.deviation));
}

/// Counted cycles cannot be corrected. With a zero error beyond the corrected range none are ever counted; with a
/// correct zero they are counted once it is known.
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

/// A correct zero that is not known yet withholds little of the first second; one from `calibrate` withholds nothing.
TEST(ZeroWatch, WithholdsLittleOfARightZeroAndNothingOfACalibratedOne) {
  const Settings given = test::settingsWith("level: linkage\n" + kUnknownZero),
                 calibrated = test::settingsWith(std::string("level: linkage\n") + kKnownZeroYaml);
  const simulation::Session session = zeroSession(1000.0, 5, 5.0);
  const auto published = [&](const Settings& settings) {
    const ZeroPlayed played = playZero(settings, session);
    return static_cast<double>(played.early_published) / static_cast<double>(played.early);
  };
  EXPECT_GT(published(given), 0.7);
  EXPECT_GT(published(calibrated), 0.97);
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

}  // namespace
}  // namespace hammer_loads
