#include "hammer_loads/calibration/estimates.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/calibration/rod_check.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kHides = 3.0;  // times the deviation without the hammer's constants; reported above it
// Warning: kHides
constexpr double kSeen = 0.7;    // ratio of posterior to prior deviation below which a constant is written
constexpr double kUnsaid = 1.2;  // ratio of a variance to that by separate deviations: two of them contain 93 % then

/// Constant for the hammer file that the recording improves: its value and deviation, with the other constants as in
/// the file.
struct Improved {
  std::size_t column;       ///< index in HammerPart::names
  std::size_t constant;     ///< index in kHammerConstants
  double error, deviation;  ///< [standard deviations in the file]
};

/// Returns the constants that the recording improves. A constant is left out if its error is correlated with that of an
/// unimproved one, as a file cannot state correlations.
std::vector<Improved> improved(const HammerPart& hammer) {
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd P = hammer.covariance.bottomRightCorner(count, count);
  std::vector<Improved> found;
  for (std::size_t i = 0; i < hammer.names.size(); ++i) {
    const std::optional<std::size_t> constant = indexOfConstant(hammer.names[i]);
    if (constant && hammer.left(i) < kSeen)
      found.push_back({i, *constant, hammer.errors[static_cast<Eigen::Index>(i)], hammer.left(i)});
  }
  // Errors of the other constants keep their prior variance, 1, and are correlated with these errors as in P.
  // Deviations d state at least 1/kUnsaid of the variance of any sum of errors if kUnsaid diag(d^2) - M has no negative
  // eigenvalue. The row sums of M ensure that.
  while (!found.empty()) {
    const auto size = static_cast<Eigen::Index>(found.size());
    Eigen::MatrixXd rows(size, count), own(size, size);
    for (Eigen::Index k = 0; k < size; ++k) rows.row(k) = P.row(static_cast<Eigen::Index>(found[k].column));
    for (Eigen::Index k = 0; k < size; ++k) own.col(k) = rows.col(static_cast<Eigen::Index>(found[k].column));
    const Eigen::MatrixXd M = own + (rows * rows.transpose() - own * own.transpose()) / (kUnsaid - 1.0);
    for (Eigen::Index k = 0; k < size; ++k)
      found[k].deviation = std::sqrt(std::max(own(k, k), M.row(k).cwiseAbs().sum() / kUnsaid));
    const auto worst = std::max_element(found.begin(), found.end(),
                                        [](const Improved& a, const Improved& b) { return a.deviation < b.deviation; });
    if (worst->deviation <= kSeen) break;
    found.erase(worst);
  }
  return found;
}

// Limits from the effect of a wrong value on the wrench (rms of Fz over the peak): 2.8 % per degree of zero, 1.6 % per
// degree once per revolution, some 3 % per degree twice per revolution, 1.5 % for 20 % of drive inertia.
constexpr double kZeroLimit = 0.3 * kDegree;  // an encoder is usually mounted half a degree off
constexpr double kEccentricity1Limit = 0.4 * kDegree;
constexpr double kEccentricity2Limit = 0.2 * kDegree;
constexpr double kInertiaLimit = 0.08;  // relative
constexpr double kTimingLimit = 0.2;    // relative
// Limit: kZeroLimit, kEccentricity1Limit, kEccentricity2Limit, kInertiaLimit, kTimingLimit

/// Returns the constant or level that causes most of a shared parameter's uncertainty; empty if noise causes it.
std::string hiddenBy(const Found& found, Eigen::Index parameter) {
  const HammerPart& hammer = found.hammer;
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd& P = hammer.covariance;
  if (count == 0 || !(P(parameter, parameter) > square(kHides) * found.fit.covariance(parameter, parameter))) return {};
  Eigen::Index most = 0;
  P.row(parameter)
      .tail(count)
      .transpose()
      .cwiseQuotient(P.diagonal().tail(count).cwiseSqrt())
      .cwiseAbs()
      .maxCoeff(&most);
  return hammer.nameOf(kGlobals + most);
}

/// Adds an eccentricity's amount and phase from its two parts.
void addEccentricity(const Found& found, int n, double limit, Calibration& result) {
  const Eigen::Index k = n == 1 ? kSine1 : kSine2;
  const Eigen::Vector2d parts = found.hammer.globals.segment<2>(k);
  const Eigen::Matrix2d covariance = found.hammer.covariance.block<2, 2>(k, k);
  const double amount = parts.norm(), phase = std::atan2(parts[1], parts[0]);
  const Eigen::Vector2d along = amount > 0.0 ? Eigen::Vector2d(parts / amount) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  const double by_amount = std::sqrt(along.dot(covariance * along)),
               by_phase = std::sqrt(across.dot(covariance * across));
  // Both keys are written or none, since a wrong phase is worse than no amount. Each has the larger deviation.
  const double larger = std::max(by_amount, by_phase), scale = std::max(amount, 1e-9);
  const double by_blows = std::sqrt(found.fit.covariance.diagonal().segment<2>(k).maxCoeff());
  const bool seen = amount > gate::kUsual * larger;  // otherwise zero is as likely, and harmless
  const std::string key = format("crank_eccentricity_%d", n), hidden_by = hiddenBy(found, k);
  result.estimates.push_back(
      {key + "_rad", "rad", seen ? amount : 0.0, larger, limit,
       format("%s per revolution; its sine and cosine are known to %.2g and %.2g rad%s", n == 1 ? "once" : "twice",
              std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
              seen ? "" : format(", %.2g rad is hardly more than that", amount).c_str()),
       by_blows, hidden_by});
  if (seen) {
    result.estimates.push_back(
        {key + "_phase_rad", "rad", phase, larger / scale, limit / scale, "its phase", by_blows / scale, hidden_by});
  } else {
    result.estimates.push_back(
        {key + "_phase_rad", "rad", 0.0, 0.0, kPi, "of none it does not matter", 0.0, hidden_by});
  }
}

/// Adds the sensor's place and the drive.
void addSensor(const Found& found, Calibration& result) {
  const JointFit& fit = found.fit;
  const Globals& globals = found.hammer.globals;
  const CalibrationBasis& basis = found.basis;
  const double gain = result.facts.direction / basis.ratio();
  const auto deviation = [&](Eigen::Index k) { return std::sqrt(found.hammer.covariance(k, k)); };
  const auto by_blows = [&](Eigen::Index k) { return std::sqrt(fit.covariance(k, k)); };
  result.estimates.push_back({"crank_zero_rad", "rad", CrankAngle::wrapToPi(globals[kZero] / gain),
                              deviation(kZero) / std::abs(gain), kZeroLimit / std::abs(gain), "reading at the blow",
                              by_blows(kZero) / std::abs(gain), hiddenBy(found, kZero)});
  result.estimates.push_back({"crank_direction", "", static_cast<double>(result.facts.direction), 0.0, 0.5,
                              "the crank turns forward at work"});
  if (!fit.centred) {
    addEccentricity(found, 1, kEccentricity1Limit, result);
    addEccentricity(found, 2, kEccentricity2Limit, result);
  }
  if (result.facts.count > 0.0) {
    result.estimates.push_back(
        {"crank_angle_resolution_rad", "rad", result.facts.count, 0.0, 1.0,
         format("%.0f counts per revolution, found from the readings", kTwoPi / result.facts.count)});
  }
  double samples = 0.0;
  for (const SegmentFit& one : fit.fits) samples += static_cast<double>(one.size());
  // Noise below the counts: its variance is known to that of the counts over the square root of the samples.
  const double counts_hide = fit.noise.angle / 30.0, timing = fit.noise.timing;
  const double timing_std =
      std::sqrt(2.0 / samples) * (timing > 0.0 ? timing + 0.5 * counts_hide * counts_hide / timing : counts_hide);
  result.estimates.push_back({"crank_timing_noise_s", "s", timing, timing_std, std::max(kTimingLimit * timing, 2e-5),
                              result.facts.retimed ? "after re-timing: the stamps repeat or change places"
                                                   : "of a stamp against the instant of the measurement",
                              timing_std});
  const double inertia = std::exp(globals[kLogInertia]);
  const double rocker = basis.mechanism.parameters().rocker_inertia_about_pivot;
  // The readings show only the ratio to the rocker's inertia. If the hammer file has a deviation of that inertia, it is
  // included already.
  const bool rocker_in_it = found.hammer.has("rocker_inertia_about_pivot_kg_m2");
  const double by_rocker = rocker_in_it ? 0.0 : basis.rocker_inertia_std;
  const double relative = std::hypot(deviation(kLogInertia), by_rocker);
  result.estimates.push_back(
      {"drive_inertia_kg_m2", "kg m2", inertia, relative * inertia, kInertiaLimit * inertia,
       format("%.4g of the rocker's; by the readings alone, all masses as given, to %.2g", inertia / rocker,
              by_blows(kLogInertia) * inertia / rocker),
       by_blows(kLogInertia) * inertia,
       by_rocker > deviation(kLogInertia) ? "rocker_inertia_about_pivot_kg_m2" : hiddenBy(found, kLogInertia)});
}

void addCorrelations(const HammerPart& hammer, Calibration& result) {
  const Eigen::MatrixXd& P = hammer.covariance;
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index k = i + 1; k < P.rows(); ++k) {
      const double both = std::sqrt(P(i, i) * P(k, k)), value = both > 0.0 ? P(i, k) / both : 0.0;
      if (std::abs(value) > kStrongCorrelation)
        result.correlations.push_back({hammer.nameOf(i), hammer.nameOf(k), value});
    }
  }
}

/// Adds the constants that are better known than by their file, each with the key of its deviation, and the rod length
/// that closes the linkage with them.
void addHammer(const std::vector<Improved>& improvements, const HammerParameters& file, Calibration& result) {
  HammerParameters found = file;
  bool closes = false;
  for (const Improved& one : improvements) {
    const HammerConstant& c = kHammerConstants[one.constant];
    const double sigma = file.deviations[one.constant], unit = std::string(c.unit) == "deg" ? kDegree : 1.0;
    c.field(found) += c.away * sigma * one.error;
    closes = closes || c.enters == HammerConstant::Enters::kMotion;
    const double deviation = one.deviation * sigma / unit;
    result.estimates.push_back(
        {c.key, c.unit, c.field(found) / unit, deviation, sigma / unit,
         "of the hammer, its others as given; this recording is in it: not for a second calibration from it", 0.0});
    result.estimates.push_back({deviationKey(c), c.unit, deviation, 0.0, deviation, "standard deviation of that", 0.0});
  }
  const LinkLengths& l = found.lengths;
  if (closes)
    result.estimates.push_back({"rod_length_m", "m", l.pivot_distance + l.rocker - l.crank, 0.0, l.rod,
                                "it follows: with it the linkage passes its dead centre at the blow", 0.0});
}

/// Adds remarks on shared parameters that constants hide, and on constants known only in combination with others.
void addHiding(const Found& found, const std::vector<Improved>& written, Calibration& result) {
  const HammerPart& hammer = found.hammer;
  const HammerParameters& file = found.basis.mechanism.parameters();
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd& P = hammer.covariance;
  for (const Eigen::Index k : {kZero, kSine1, kCosine1, kLogInertia}) {
    const std::string by = hiddenBy(found, k);
    if (by.empty()) continue;
    result.remarks.push_back(
        format("%s: known to %.2g if the hammer file were exact, to %.2g by the deviations of its constants, most by "
               "that of %s",
               hammer.nameOf(k).c_str(), std::sqrt(found.fit.covariance(k, k)), std::sqrt(P(k, k)), by.c_str()));
  }
  for (std::size_t i = 0; i < hammer.names.size(); ++i) {
    const std::optional<std::size_t> k = indexOfConstant(hammer.names[i]);
    const auto is = [&](const Improved& one) { return one.column == i; };
    if (!k || hammer.left(i) > kSeen || std::any_of(written.begin(), written.end(), is)) continue;
    const double deviation = file.deviations[*k];
    Eigen::VectorXd with = P.bottomRightCorner(count, count).col(static_cast<Eigen::Index>(i));
    with.array() /= P.diagonal().tail(count).cwiseSqrt().array() * hammer.left(i);
    with[static_cast<Eigen::Index>(i)] = 0.0;
    Eigen::Index most = 0;
    with.cwiseAbs().maxCoeff(&most);
    result.remarks.push_back(format(
        "%s: by the readings %+.2g +- %.1g more than the file has, whose deviation is %.2g; not written, %s explains "
        "the same readings (correlation %.2f): a smaller deviation of that in the hammer file shows this one",
        hammer.names[i].c_str(), kHammerConstants[*k].away * deviation * hammer.errors[static_cast<Eigen::Index>(i)],
        deviation * hammer.left(i), deviation, hammer.nameOf(kGlobals + most).c_str(), std::abs(with[most])));
  }
}

void addRemarks(double curve_square, Calibration& result) {
  std::vector<std::string>& say = result.remarks;
  const bool eccentric = std::any_of(result.estimates.begin(), result.estimates.end(), [](const Estimate& e) {
    return e.key == "crank_eccentricity_1_rad" && e.value > 0.0 && e.determined();
  });
  if (eccentric) {
    say.push_back(
        "zero against the eccentricity's first cosine: an encoder turned on its shaft and one off its centre look much "
        "alike, only their sum at the blow is known well; so use these keys together or not at all");
  }
  say.push_back(
      "rocker against drive inertia: only their ratio shows; a rocker given 2 % too heavy makes the drive 2 % too "
      "heavy; friction in the pins passes for inertia; masses and centres of mass hardly show");
  say.push_back(
      "a tool that the rocker meets before the dead centre looks like a zero that is off: which of the two "
      "does not show where every blow comes equally early; the zero written is then that of the blow");
  say.push_back("a constant latency of the stamps does not show: crank_latency_s stays as it is");
  if (result.facts.retimed) {
    say.push_back(
        "the stamps repeat or change places: taken at equal intervals in their order of arrival; a constant shift of "
        "all stamps does not show");
  }
  if (curve_square > 2.0) {
    say.push_back(format(
        "the residuals follow the crank angle (%.1f times what noise does): something that this model lacks, as a "
        "coupling between encoder and crank that twists; the deviations are widened for it",
        std::sqrt(curve_square)));
  }
  if (result.left_out * 10 > result.blows)
    say.push_back(format("%zu blows are not like the others (no tool, a stop) and are left out", result.left_out));
}

/// Largest effect of elastic rods of 2e8 to 1e10 N/m with joint clearance up to 0.5 mm on the zero, the eccentricity
/// and the drive inertia (relative).
constexpr double kOfZero = 3.0 * kDegree, kOfEccentricity = 1.5 * kDegree, kOfInertia = 0.3;
// Prior: kOfZero, kOfEccentricity, kOfInertia

/// Marks keys that a fit with a rigid rod gets wrong as not determined, with their possible error and the action.
/// ratio: encoder revolutions per crank revolution.
void refuseForRod(const RodEvidence& rod, double ratio, Calibration& result) {
  result.rod_is_elastic = rod.showsElasticRod();
  if (!rod.showsElasticRod()) return;
  const auto effectOn = [&](const Estimate& e) {
    if (e.key == "crank_zero_rad") return kOfZero * std::abs(ratio);
    if (e.key == "drive_inertia_kg_m2") return kOfInertia * e.value;
    if (e.key.rfind("crank_eccentricity", 0) != 0) return 0.0;
    return e.key.find("_phase") == std::string::npos ? kOfEccentricity : kTwoPi;
  };
  for (Estimate& e : result.estimates) e.deviation = std::hypot(e.deviation, effectOn(e));
  result.remarks.push_back(textOf(rod, true));
}

}  // namespace

void addResults(const Found& found, Calibration& result) {
  const std::vector<Improved> improvements = improved(found.hammer);
  addSensor(found, result);
  addCorrelations(found.hammer, result);
  if (!found.rod.showsElasticRod()) addHammer(improvements, found.basis.mechanism.parameters(), result);
  refuseForRod(found.rod, found.basis.ratio(), result);
  addHiding(found, improvements, result);
  addRemarks(found.curve_square, result);
}

}  // namespace hammer_loads::calibration
