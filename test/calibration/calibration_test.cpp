#include "hammer_loads/calibration/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <limits>
#include <random>
#include <regex>
#include <sstream>

#include "calibration/recorded.h"
#include "hammer_loads/calibration/report.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/parameter_map.h"
#include "support/mo100.h"

namespace hammer_loads::calibration {
namespace {

using test::atWork;
using test::basisOf;
using test::find;
using test::mechanismOf;
using test::recorded;

Calibration calibrated(const simulation::MachineSettings& s, double guess = 1.0) {
  const Mechanism mechanism = mechanismOf(s, guess);
  return calibrate(recorded(s), basisOf(mechanism));
}

double errorOf(const Calibration& c, const char* key, double truth) {
  const Estimate* e = find(c, key);
  return e ? CrankAngle::wrapToPi(e->value - truth) : std::nan("");
}

TEST(Calibration, FindsTheZeroAmongBlowsThatDiffer) {
  simulation::MachineSettings s = atWork(20.0, 500.0);
  s.crank.zero = 1.0 * kDegree;
  s.blow = {true, 0.0, 0.3, 0.0, 0.0, 50.0, 0.0};
  const Calibration c = calibrated(s);
  ASSERT_EQ(c.problem, "");
  EXPECT_LT(std::abs(errorOf(c, "crank_zero_rad", s.crank.zero)), 0.1 * kDegree);
  EXPECT_TRUE(find(c, "crank_zero_rad")->determined());
  EXPECT_EQ(find(c, "crank_direction")->value, 1.0);
  EXPECT_NEAR(find(c, "crank_angle_resolution_rad")->value, kTwoPi / 4096, 1e-9);
  EXPECT_NEAR(find(c, "drive_inertia_kg_m2")->value, s.drive.inertia, 0.03 * s.drive.inertia);
  EXPECT_GE(find(c, "drive_inertia_kg_m2")->deviation, 0.02 * s.drive.inertia);  // the rocker's own
  EXPECT_NEAR(std::sqrt(c.mean_square), 1.0, 0.1);
}

TEST(Calibration, FindsAnEccentricEncoderThatTurnsTheOtherWay) {
  simulation::MachineSettings s = atWork(20.0, 500.0);
  s.crank.zero = -2.5;
  s.crank.direction = -1;
  s.crank.eccentricity[0] = {1.0 * kDegree, 0.8};
  const Calibration c = calibrated(s, 1.3);
  ASSERT_EQ(c.problem, "");
  EXPECT_EQ(find(c, "crank_direction")->value, -1.0);
  EXPECT_LT(std::abs(errorOf(c, "crank_zero_rad", s.crank.zero)), 0.12 * kDegree);
  EXPECT_NEAR(find(c, "crank_eccentricity_1_rad")->value, 1.0 * kDegree, 0.2 * kDegree);
  EXPECT_NEAR(find(c, "crank_eccentricity_1_phase_rad")->value, 0.8, 0.3);
}

/// Half of the drive's inertia rotates with the encoder on the far side of the coupling.
TEST(Calibration, NamesACouplingThatTwists) {
  simulation::MachineSettings s = atWork(10.0, 250.0);
  const auto namesCoupling = [](const Calibration& c) {
    std::string all = c.problem;
    for (const std::string& remark : c.remarks) all += remark;
    return all.find("coupling") != std::string::npos;
  };
  EXPECT_FALSE(namesCoupling(calibrated(s)));
  for (const double frequency : {30.0, 80.0}) {
    s.drive.coupling_frequency = frequency;
    s.drive.coupling_damping = 0.02;
    EXPECT_TRUE(namesCoupling(calibrated(s))) << frequency;
  }
}

/// Returns the error of an eccentricity's amplitude and phase as a distance.
double eccentricityError(const Calibration& c, int n, const simulation::Eccentricity& truth) {
  const std::string key = "crank_eccentricity_" + std::to_string(n);
  const double amount = find(c, key + "_rad")->value, phase = find(c, key + "_phase_rad")->value;
  return std::abs(std::polar(amount, phase) - std::polar(truth.amount, truth.phase));
}

/// Errors of random machines, with coarse counts and jitter, lie within two standard deviations.
TEST(Calibration, DeviationsAreHonest) {
  constexpr double kTwoOfBoth = 2.45;  // standard deviations that hold 95 % of errors in two dimensions, as 2 in one
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int within = 0, all = 0;
  for (int i = 0; i < 5; ++i) {
    simulation::MachineSettings s = atWork(16.0, i % 2 == 0 ? 100.0 : 200.0);
    s.seed = 100 + static_cast<std::uint64_t>(i);
    const int counts[] = {512, 1024, 2048, 4096};
    s.crank.counts = counts[static_cast<int>(3.99 * part(random))];
    s.crank.zero = 6.0 * (part(random) - 0.5);
    s.crank.eccentricity[0] = {1.0 * kDegree * part(random), 6.0 * part(random)};
    s.crank.eccentricity[1] = {0.4 * kDegree * part(random), 6.0 * part(random)};
    s.crank.stamp_noise = 3e-4 * part(random);
    s.crank.speed = part(random) < 0.5;
    s.blow = {true, 0.1 * part(random), 0.1 + 0.2 * part(random), 0.0, 0.0, 50.0, 0.0};
    s.drive.inertia = 0.4 + 0.5 * part(random);
    const Calibration c = calibrated(s, 0.7 + 0.6 * part(random));
    ASSERT_EQ(c.problem, "");
    const Estimate *zero = find(c, "crank_zero_rad"), *inertia = find(c, "drive_inertia_kg_m2");
    within += std::abs(errorOf(c, "crank_zero_rad", s.crank.zero)) <= 2.0 * zero->deviation;
    within += std::abs(inertia->value - s.drive.inertia) <= 2.0 * inertia->deviation;
    within +=
        eccentricityError(c, 1, s.crank.eccentricity[0]) <= kTwoOfBoth * find(c, "crank_eccentricity_1_rad")->deviation;
    within +=
        eccentricityError(c, 2, s.crank.eccentricity[1]) <= kTwoOfBoth * find(c, "crank_eccentricity_2_rad")->deviation;
    all += 4;
  }
  EXPECT_GE(within, all * 9 / 10) << "of " << all;
}

/// Draws a machine that differs from the nominal one by its standard deviations; the encoder is exact and centred.
HammerParameters drawnFrom(const HammerParameters& drawing, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  HammerParameters p = drawing;
  do {
    p = drawing;
    for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
      kHammerConstants[i].field(p) += p.deviations[i] * std::clamp(normal(random), -1.9, 1.9);
    p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  } while (!Mechanism::make(p).value);
  return p;
}

/// Calibrates a machine's recording with a hammer file of level linkage whose drive inertia is correct.
struct ByFile {
  explicit ByFile(const simulation::MachineSettings& machine)
      : drive_inertia(machine.drive.inertia), samples(recorded(machine)) {}
  Calibration operator()(HammerParameters file) const {
    file.drive_inertia = drive_inertia;
    const Mechanism mechanism = test::mechanismOf(file);
    CalibrationBasis basis = basisOf(mechanism);
    basis.level = Level::kLinkage;
    return calibrate(samples, basis);
  }
  double drive_inertia;
  std::vector<RecordedSample> samples;
};

/// Errors of nominal parameters resemble sensor errors. They enter the deviations and shift no key significantly.
TEST(Calibration, SeparatesNominalErrorsFromTheSensors) {
  HammerParameters drawing = test::mo100LinkageParameters(), exact = drawing;
  drawing.deviations = usualDeviations(drawing);
  exact.deviations = {};
  std::mt19937_64 random(5);
  double worst_of_exact = 0.0;
  for (int i = 0; i < 2; ++i) {
    simulation::MachineSettings s = atWork(16.0, 250.0);
    s.level = Level::kLinkage;
    s.hammer = drawnFrom(drawing, random);
    s.seed = 300 + static_cast<std::uint64_t>(i);
    const ByFile by{s};
    const Calibration c = by(drawing), sure = by(exact);
    ASSERT_EQ(c.problem, "");
    const auto off = [](const Calibration& found, const char* key, double truth) {
      return std::abs(errorOf(found, key, truth)) / find(found, key)->deviation;
    };
    EXPECT_LT(off(c, "crank_zero_rad", 0.0), 2.5);
    EXPECT_LT(off(c, "drive_inertia_kg_m2", s.drive.inertia), 2.5);
    for (const char* key : {"crank_eccentricity_1_rad", "crank_eccentricity_2_rad"}) {
      EXPECT_LT(off(c, key, 0.0), 3.0) << key;
      worst_of_exact = std::max(worst_of_exact, off(sure, key, 0.0));
    }
    EXPECT_TRUE(find(c, "crank_zero_rad")->determined());
    EXPECT_FALSE(c.remarks.empty());
  }
  EXPECT_GT(worst_of_exact, 5.0);  // a file without deviations attributes them to an eccentric encoder
}

/// Returns the nominal parameters overwritten by the calibrated values and their standard deviations.
HammerParameters writtenOver(HammerParameters drawing, const Calibration& c) {
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const Estimate *value = find(c, kHammerConstants[i].key), *deviation = find(c, deviationKey(kHammerConstants[i]));
    if (value) kHammerConstants[i].field(drawing) = value->value;
    if (deviation) drawing.deviations[i] = deviation->value;
  }
  return drawing;
}

/// Readings show the crank's length only together with the pivot distance and the rocker's inertia. If those are
/// measured, the length is written. Otherwise no length is changed.
TEST(Calibration, ALengthThatShowsIsWritten) {
  HammerParameters drawing = test::mo100LinkageParameters();
  drawing.deviations = usualDeviations(drawing);
  const std::size_t crank = *indexOfConstant("crank_length_m"), distance = *indexOfConstant("pivot_distance_m"),
                    inertia = *indexOfConstant("rocker_inertia_about_pivot_kg_m2");
  std::mt19937_64 random(6);
  double squares = 0.0;
  constexpr int kMachines = 4;
  for (int i = 0; i < kMachines; ++i) {
    SCOPED_TRACE(i);
    HammerParameters measured = drawing;
    measured.deviations[distance] = 3e-5;
    measured.deviations[inertia] = 0.005 * drawing.rocker_inertia_about_pivot;
    simulation::MachineSettings s = atWork(16.0, 250.0);
    s.level = Level::kLinkage;
    s.hammer = drawnFrom(measured, random);
    s.seed = 320 + static_cast<std::uint64_t>(i);
    const ByFile by{s};
    const Calibration c = by(measured);
    ASSERT_NE(find(c, "crank_length_m"), nullptr);
    const HammerParameters file = writtenOver(measured, c);
    EXPECT_LT(file.deviations[crank], 0.7 * drawing.deviations[crank]);
    const double off = (file.lengths.crank - s.hammer.lengths.crank) / file.deviations[crank];
    EXPECT_LT(std::abs(off), 2.5);
    squares += off * off / kMachines;
    EXPECT_NE(file.lengths.rod, drawing.lengths.rod);
    EXPECT_TRUE(Mechanism::make(file).value.has_value());

    if (i > 0) continue;
    const Calibration guessed = by(drawing);
    EXPECT_EQ(find(guessed, "crank_length_m"), nullptr);
    EXPECT_EQ(find(guessed, "rod_length_m"), nullptr);
    EXPECT_NE(textOf(guessed, true).find("not written, pivot_distance_m explains"), std::string::npos);
  }
  EXPECT_NEAR(std::sqrt(squares), 1.0, 0.5);
}

/// Runs with and without measured speeds. A stamp error changes the speed near a blow, which is no angle noise.
TEST(Calibration, JitterIsMeasured) {
  for (const bool speeds : {true, false}) {
    simulation::MachineSettings s = atWork(12.0, 200.0);
    s.crank.stamp_noise = 3e-4;
    s.crank.speed = speeds;
    const Calibration c = calibrated(s);
    const Estimate* timing = find(c, "crank_timing_noise_s");
    ASSERT_NE(timing, nullptr);
    EXPECT_NEAR(timing->value, 3e-4, 0.06 * 3e-4) << speeds;
  }
}

TEST(Calibration, StatesHowMuchMoreIsNeeded) {
  const Calibration short_one = calibrated(atWork(1.0, 500.0));
  EXPECT_NE(short_one.problem, "");
  EXPECT_NE(textOf(short_one).find("blows"), std::string::npos);
  EXPECT_NE(textOf(short_one).find(" s of such work"), std::string::npos);
  simulation::MachineSettings idle = atWork(10.0, 200.0);
  idle.drive.start_time = 100.0;
  EXPECT_NE(calibrated(idle).problem, "");
  const Mechanism mechanism = mechanismOf(idle);
  EXPECT_NE(calibrate({}, basisOf(mechanism)).problem, "");
}

TEST(Report, WritesNoKeyThatIsNotDetermined) {
  Calibration c;
  c.blows = 20, c.seconds = 5.0, c.more_blows = 80.0, c.facts.period = 1e-3;
  c.estimates = {{"crank_zero_rad", "rad", 0.01, 0.001, 0.003, "m"},
                 {"drive_inertia_kg_m2", "kg m2", 0.6, 0.2, 0.05, "m"}};
  const std::string yaml = yamlOf(c, "a.bag");
  std::vector<std::string> problems;
  const ParameterMap keys = *parameterMap(YAML::Load(yaml), "x", problems);
  EXPECT_EQ(keys.size(), 2U);
  EXPECT_EQ(keys.at("crank_zero_std_rad").value.as<double>(), 0.001);
  EXPECT_EQ(keys.at("crank_zero_rad").value.as<double>(), 0.01);
  EXPECT_NE(yaml.find("# drive_inertia_kg_m2 is not determined"), std::string::npos);
  EXPECT_NE(textOf(c).find("record some 80 blows, 20 s"), std::string::npos) << textOf(c);
  c.estimates.erase(c.estimates.begin());
  EXPECT_EQ(yamlOf(c, "a.bag"), "");
}

/// Uses sixteen keys and twenty correlations, as from a hammer file whose constants are hard to separate.
TEST(Report, StatesResultsGapsAndActionsInSixLines) {
  Calibration c;
  c.seconds = 60.0, c.blows = 240, c.more_blows = std::numeric_limits<double>::infinity(), c.facts.period = 1e-3;
  c.mean_square = 1.0;
  c.estimates = {{"crank_zero_rad", "rad", 0.646, 4e-4, 5e-3, "m"},
                 {"crank_direction", "", -1.0, 0.0, 0.5, "m"},
                 {"crank_eccentricity_1_rad", "rad", 0.0, 1e-3, 7e-3, "m"},
                 {"crank_eccentricity_1_phase_rad", "rad", 0.0, 0.0, 3.1, "m"},
                 {"drive_inertia_kg_m2", "kg m2", 1.1, 0.2, 0.09, "m", 0.01, "rocker_inertia_about_pivot_kg_m2"}};
  for (int i = 0; i < 20; ++i)
    c.correlations.push_back({"zero", "rod_mass_kg", 0.95}), c.remarks.emplace_back("remark");
  const std::string lines = textOf(c), text = std::regex_replace(lines, std::regex("\n    "), " ");
  const std::string verbose = textOf(c, true);
  EXPECT_LE(std::count(lines.begin(), lines.end(), '\n'), 6) << lines;
  EXPECT_NE(text.find("found: crank_zero_rad 0.64600 rad (37.01 deg) +- 0.0004, crank_direction -1\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("not found: drive_inertia_kg_m2 (+- 0.2, must be 0.09): hidden by the uncertainty of "
                      "rocker_inertia_about_pivot_kg_m2\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("next: weigh or measure rocker_inertia_about_pivot_kg_m2 and give its standard "
                      "deviation"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("correlation"), std::string::npos);
  EXPECT_EQ(yamlOf(c, "a.bag").find("correlation"), std::string::npos);
  EXPECT_NE(verbose.find("strong correlation +0.950: zero and rod_mass_kg\n"), std::string::npos);
  EXPECT_NE(verbose.find("note: remark\n"), std::string::npos);
  c.estimates.pop_back();
  EXPECT_NE(textOf(c).find("next: start the node with this file"), std::string::npos) << textOf(c);
}

/// The fitted values leave a thousandth of the initial residual. Both curves must be visible.
TEST(Report, PictureShowsBothCurvesOverHalfOfTheirPanels) {
  Calibration c;
  for (ResidualCurve* curve : {&c.before, &c.after}) {
    const double size = (curve == &c.before ? 12.0 : 0.012) * kDegree;
    for (int i = 0; i < 72; ++i)
      curve->mean.push_back(size * std::sin(kTwoPi * i / 72.0)), curve->deviation.push_back(0.02 * size);
  }
  const std::string svg = svgOf(c);
  std::vector<std::pair<double, double>> ranges;  // of y [px]
  const std::regex polyline("<polyline[^>]*points=\"([^\"]*)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), polyline), end; it != end; ++it) {
    std::istringstream points((*it)[1].str());
    double x = 0.0, y = 0.0, least = 1e9, most = -1e9;
    for (char comma; points >> x >> comma >> y;) least = std::min(least, y), most = std::max(most, y);
    ranges.emplace_back(least, most);
  }
  ASSERT_EQ(ranges.size(), 2U);
  for (const auto& [least, most] : ranges) EXPECT_GT(most - least, 90.0);  // of 180
  EXPECT_LT(ranges[0].second, ranges[1].first);                            // one above the other
}

}  // namespace
}  // namespace hammer_loads::calibration
