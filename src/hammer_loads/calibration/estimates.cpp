#include "hammer_loads/calibration/estimates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/calibration/hammer_keys.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kStrong = 0.9;

// Limits, by what a wrong value does to the wrench (rms of Fz over the peak): 2.8 % per degree of zero, 1.6 % per
// degree once a turn, some 3 % per degree twice a turn, 1.5 % for 20 % of drive inertia.
constexpr double kZeroLimit = 0.3 * kDegree;  // an encoder is usually mounted half a degree off
constexpr double kEccentricity1Limit = 0.4 * kDegree;
constexpr double kEccentricity2Limit = 0.2 * kDegree;
constexpr double kInertiaLimit = 0.08;  // relative
constexpr double kTimingLimit = 0.2;    // relative

/// An eccentricity's amount and phase from its two parts.
void addEccentricity(Calibration& result, const JointFit& fit, const GlobalMatrix& of_blows, int n, double limit) {
  const Eigen::Index k = n == 1 ? kSine1 : kSine2;
  const Eigen::Vector2d parts = fit.globals.segment<2>(k);
  const Eigen::Matrix2d covariance = fit.covariance.block<2, 2>(k, k);
  const double amount = parts.norm(), phase = std::atan2(parts[1], parts[0]);
  const Eigen::Vector2d along = amount > 0.0 ? Eigen::Vector2d(parts / amount) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  const double by_amount = std::sqrt(along.dot(covariance * along)),
               by_phase = std::sqrt(across.dot(covariance * across));
  // Either both keys or none: an amount at a wrong phase is worse than none. Each therefore has the larger deviation.
  const double larger = std::max(by_amount, by_phase), scale = std::max(amount, 1e-9);
  const double by_blows = std::sqrt(of_blows.diagonal().segment<2>(k).maxCoeff());
  const bool seen = amount > gate::kUsual * larger;  // else none is as likely, and does no harm
  const std::string key = format("crank_eccentricity_%d", n);
  result.estimates.push_back(
      {key + "_rad", "rad", seen ? amount : 0.0, larger, limit,
       format("%s per revolution; its sine and cosine are known to %.2g and %.2g rad%s", n == 1 ? "once" : "twice",
              std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
              seen ? "" : format(", %.2g rad is hardly more than that", amount).c_str()),
       by_blows});
  if (seen) {
    result.estimates.push_back(
        {key + "_phase_rad", "rad", phase, larger / scale, limit / scale, "its phase", by_blows / scale});
  } else {
    result.estimates.push_back({key + "_phase_rad", "rad", 0.0, 0.0, kPi, "of none it does not matter", 0.0});
  }
}

void addHiding(const Found& found, Calibration& result) {
  constexpr std::pair<const char*, Eigen::Index> kRows[] = {{"crank_zero_rad", kZero},
                                                            {"crank_eccentricity_1_rad", kSine1},
                                                            {"crank_eccentricity_1_phase_rad", kSine1},
                                                            {"crank_eccentricity_2_rad", kSine2},
                                                            {"crank_eccentricity_2_phase_rad", kSine2},
                                                            {"drive_inertia_kg_m2", kLogInertia}};
  for (Estimate& e : result.estimates)
    for (const auto& [key, row] : kRows)
      if (e.key == key && e.hidden_by.empty()) e.hidden_by = hiddenBy(found.hammer, found.by_blows, row);
}

void addCorrelations(Calibration& result, const HammerPart& hammer) {
  const Eigen::MatrixXd& P = hammer.covariance;
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index k = i + 1; k < P.rows(); ++k) {
      const double both = std::sqrt(P(i, i) * P(k, k)), value = both > 0.0 ? P(i, k) / both : 0.0;
      if (std::abs(value) > kStrong) result.correlations.push_back({hammer.nameOf(i), hammer.nameOf(k), value});
    }
  }
}

}  // namespace

void addEstimates(const Found& found, Calibration& result) {
  const JointFit& fit = found.fit;
  const GlobalMatrix& of_blows = found.by_blows;
  const CalibrationBasis& basis = found.basis;
  const double gain = result.direction / basis.ratio;
  const auto deviation = [&](Eigen::Index k) { return std::sqrt(fit.covariance(k, k)); };
  const auto by_blows = [&](Eigen::Index k) { return std::sqrt(of_blows(k, k)); };
  result.estimates.push_back({"crank_zero_rad", "rad", CrankAngle::wrapToPi(fit.globals[kZero] / gain),
                              deviation(kZero) / std::abs(gain), kZeroLimit / std::abs(gain), "reading at the blow",
                              by_blows(kZero) / std::abs(gain)});
  result.estimates.push_back(
      {"crank_direction", "", static_cast<double>(result.direction), 0.0, 0.5, "the crank turns forward at work"});
  if (!found.centred) {
    addEccentricity(result, fit, of_blows, 1, kEccentricity1Limit);
    addEccentricity(result, fit, of_blows, 2, kEccentricity2Limit);
  }
  if (result.facts.count > 0.0) {
    result.estimates.push_back(
        {"crank_angle_resolution_rad", "rad", result.facts.count, 0.0, 1.0,
         format("%.0f counts per revolution, found from the readings", kTwoPi / result.facts.count)});
  }
  double samples = 0.0;
  for (const SegmentFit& one : fit.fits) samples += static_cast<double>(one.size());
  // Noise hidden by the counts: its square is known to the square of theirs over the square root of the samples.
  const double counts_hide = fit.noise.angle / 30.0, timing = fit.noise.timing;
  const double timing_std =
      std::sqrt(2.0 / samples) * (timing > 0.0 ? timing + 0.5 * counts_hide * counts_hide / timing : counts_hide);
  result.estimates.push_back({"crank_timing_noise_s", "s", timing, timing_std, std::max(kTimingLimit * timing, 2e-5),
                              result.facts.retimed ? "after re-timing: the stamps repeat or change places"
                                                   : "of a stamp against the instant of the measurement",
                              timing_std});
  const double inertia = std::exp(fit.globals[kLogInertia]);
  const double rocker = basis.mechanism.parameters().rocker_inertia_about_pivot;
  // The readings show only the ratio to the rocker's inertia. A deviation of that in the hammer file is included
  // already.
  const bool rocker_in_it = found.hammer.has("rocker_inertia_about_pivot_kg_m2");
  const double by_rocker = rocker_in_it ? 0.0 : basis.rocker_inertia_std;
  const double relative = std::hypot(deviation(kLogInertia), by_rocker);
  result.estimates.push_back({"drive_inertia_kg_m2", "kg m2", inertia, relative * inertia, kInertiaLimit * inertia,
                              format("%.4g of the rocker's; by the readings alone, all masses as given, to %.2g",
                                     inertia / rocker, by_blows(kLogInertia) * inertia / rocker),
                              by_blows(kLogInertia) * inertia,
                              by_rocker > deviation(kLogInertia) ? "rocker_inertia_about_pivot_kg_m2" : ""});
  addHiding(found, result);
  addCorrelations(result, found.hammer);
}

void addRemarks(double curve_square, Calibration& result) {
  auto& say = result.remarks;
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
      "heavy; "
      "friction in the pins passes for inertia; masses and centres of mass hardly show");
  say.push_back(
      "a tool that the rocker meets before the dead centre looks like a zero that is off: which of the two "
      "does not show where every blow comes equally early; the zero written is then that of the blow");
  say.push_back("a constant latency of the stamps does not show: crank_latency_s stays as it is");
  if (result.facts.retimed) {
    say.push_back(
        "the stamps repeat or change places: taken at equal intervals in their order of arrival; a constant shift of "
        "all "
        "stamps does not show");
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

}  // namespace hammer_loads::calibration
