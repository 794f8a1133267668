#include "hammer_loads/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/calibration/first_guess.h"
#include "hammer_loads/calibration/hammer_keys.h"
#include "hammer_loads/calibration/rod_check.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::calibration {
namespace {

constexpr std::size_t kLeastBlows = 12;
constexpr int kCurveParts = 72;
constexpr double kStrong = 0.9;
constexpr double kUnknownAngleNoise = 5e-4;  // [rad] of a sensor without counts, first guess

// Limits, by what a wrong value does to the wrench (rms of Fz over the peak): 2.8 % per degree of zero, 1.6 % per
// degree once a turn, some 3 % per degree twice a turn, 1.5 % for 20 % of drive inertia.
constexpr double kZeroLimit = 0.3 * kDegree;  // an encoder is usually mounted half a degree off
constexpr double kEccentricity1Limit = 0.4 * kDegree;
constexpr double kEccentricity2Limit = 0.2 * kDegree;
constexpr double kInertiaLimit = 0.08;  // relative
constexpr double kTimingLimit = 0.2;    // relative

Free allFree(bool centred) {
  Free free = Free::Constant(true);
  if (centred) free.segment<4>(kSine1).setConstant(false);
  return free;
}

ResidualCurve curveOf(const std::vector<SegmentFit>& fits, const SegmentModel& model, const Globals& globals,
                      const Noise& noise) {
  std::vector<double> n(kCurveParts), sum(kCurveParts), squares(kCurveParts);
  for (const SegmentFit& fit : fits) {
    for (const ResidualAt& r : fit.residuals(model, globals, noise)) {
      const auto part = static_cast<std::size_t>(
          std::clamp((r.offset / kTwoPi + 0.5) * kCurveParts, 0.0, static_cast<double>(kCurveParts - 1)));
      n[part] += 1.0, sum[part] += r.angle, squares[part] += r.angle * r.angle;
    }
  }
  ResidualCurve curve;
  for (std::size_t i = 0; i < n.size(); ++i) {
    const bool enough = n[i] >= 4.0;
    const double mean = sum[i] / n[i], variance = squares[i] / n[i] - mean * mean;
    curve.mean.push_back(enough ? mean : std::numeric_limits<double>::quiet_NaN());
    curve.deviation.push_back(enough ? std::sqrt(variance / n[i]) : std::numeric_limits<double>::quiet_NaN());
  }
  return curve;
}

/// Mean over the turn of the curve's square over its variance: 1 for noise.
double systematic(const ResidualCurve& curve) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < curve.mean.size(); ++i) {
    if (!(curve.deviation[i] > 0.0)) continue;
    sum += curve.mean[i] * curve.mean[i] / (curve.deviation[i] * curve.deviation[i]);
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 1.0;
}

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
  // Either both keys or none: an amount at a wrong phase is worse than none. So each has the larger deviation.
  const double larger = std::max(by_amount, by_phase), scale = std::max(amount, 1e-9);
  const double by_blows = std::sqrt(of_blows.diagonal().segment<2>(k).maxCoeff());
  const bool seen = amount > gate::kUsual * larger;  // else none is as likely, and does no harm
  const std::string key = format("crank_eccentricity_%d", n);
  result.estimates.push_back(
      {key + "_rad", "rad", seen ? amount : 0.0, larger, limit,
       format("%s a turn; its sine and cosine are known to %.2g and %.2g rad%s", n == 1 ? "once" : "twice",
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

/// of_blows: covariance of the same, the hammer's constants as given; rocker_in_it: the rocker's inertia is a constant
/// of the fit.
void addEstimates(Calibration& result, const JointFit& fit, const GlobalMatrix& of_blows, const CalibrationBasis& basis,
                  bool rocker_in_it, bool centred) {
  const double gain = result.direction / basis.ratio;
  const auto deviation = [&](Eigen::Index k) { return std::sqrt(fit.covariance(k, k)); };
  const auto by_blows = [&](Eigen::Index k) { return std::sqrt(of_blows(k, k)); };
  result.estimates.push_back({"crank_zero_rad", "rad", CrankAngle::wrapToPi(fit.globals[kZero] / gain),
                              deviation(kZero) / std::abs(gain), kZeroLimit / std::abs(gain), "reading at the blow",
                              by_blows(kZero) / std::abs(gain)});
  result.estimates.push_back(
      {"crank_direction", "", static_cast<double>(result.direction), 0.0, 0.5, "the crank turns forward at work"});
  if (!centred) {
    addEccentricity(result, fit, of_blows, 1, kEccentricity1Limit);
    addEccentricity(result, fit, of_blows, 2, kEccentricity2Limit);
  }
  if (result.facts.count > 0.0) {
    result.estimates.push_back({"crank_angle_resolution_rad", "rad", result.facts.count, 0.0, 1.0,
                                format("%.0f counts a turn, read off the readings", kTwoPi / result.facts.count)});
  }
  double samples = 0.0;
  for (const SegmentFit& one : fit.fits) samples += static_cast<double>(one.size());
  // Where counts hide it, its square is known to theirs over the square root of the samples.
  const double counts_hide = fit.noise.angle / 30.0, timing = fit.noise.timing;
  const double timing_deviation =
      std::sqrt(2.0 / samples) * (timing > 0.0 ? timing + 0.5 * counts_hide * counts_hide / timing : counts_hide);
  result.estimates.push_back({"crank_timing_noise_s", "s", timing, timing_deviation,
                              std::max(kTimingLimit * timing, 2e-5),
                              result.facts.retimed ? "after re-timing: the stamps repeat or change places"
                                                   : "of a stamp against the instant of the measurement",
                              timing_deviation});
  const double inertia = std::exp(fit.globals[kLogInertia]);
  const double rocker = basis.mechanism.parameters().rocker_inertia_about_pivot;
  // Only the ratio to the rocker's inertia shows; where the hammer file says how well that is known, it is in already.
  const double relative = std::hypot(deviation(kLogInertia), rocker_in_it ? 0.0 : basis.rocker_inertia_deviation);
  result.estimates.push_back({"drive_inertia_kg_m2", "kg m2", inertia, relative * inertia, kInertiaLimit * inertia,
                              format("%.4g of the rocker's; by the readings alone, all masses as given, to %.2g",
                                     inertia / rocker, by_blows(kLogInertia) * inertia / rocker),
                              by_blows(kLogInertia) * inertia});
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

void addRemarks(Calibration& result, double curve_square) {
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
        "flexible coupling between encoder and crank; the deviations are widened for it",
        std::sqrt(curve_square)));
  }
  if (result.left_out * 10 > result.blows)
    say.push_back(format("%zu blows are not like the others (no tool, a stop) and are left out", result.left_out));
}

/// Without the gaps.
double secondsOf(const CrankTrack& track) {
  double seconds = 0.0;
  for (std::size_t i = 0; i < track.starts.size(); ++i) {
    const std::size_t end = i + 1 < track.starts.size() ? track.starts[i + 1] : track.points.size();
    seconds += track.points[end - 1].time - track.points[track.starts[i]].time;
  }
  return seconds;
}

/// More blows lessen their own part of a deviation alone.
void countNeeds(Calibration& result) {
  double most = 1.0;
  for (const Estimate& e : result.estimates) {
    if (e.determined() || !(e.limit > 0.0)) continue;
    const double by_blows = square(e.by_blows), left = square(e.limit) - (square(e.deviation) - by_blows);
    most = std::max(most, left > 0.0 ? by_blows / left : std::numeric_limits<double>::infinity());
  }
  result.more_blows = most * static_cast<double>(result.blows);
}

}  // namespace

double Calibration::worstByBlows() const {
  double worst = problem.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Estimate& e : estimates) worst = std::max(worst, e.by_blows / e.limit);
  return worst;
}

Calibration calibrate(const std::vector<RecordedSample>& samples, const CalibrationBasis& basis,
                      const Progress& progress) {
  Calibration result;
  const CrankTrack track = trackOf(samples, basis.ratio);
  result.facts = track.facts;
  result.direction = track.direction;
  result.more_blows = 60.0;
  result.seconds = secondsOf(track);
  const SegmentModel model{basis.mechanism, basis.level};
  const std::optional<FirstGuess> guess = firstGuess(track, model, basis.mechanism.parameters().drive_inertia);
  if (!guess) {
    result.problem = "the crank hardly turns in it";
    return result;
  }
  std::vector<BlowSegment> segments = cutAtBlows(track, guess->zero);
  result.blows = segments.size();
  if (segments.size() < kLeastBlows) {
    result.problem = format("%zu whole turns over a blow in it, must be %zu or more", segments.size(), kLeastBlows);
    return result;
  }
  Globals start = Globals::Zero();
  start[kZero] = guess->zero;
  start[kLogInertia] = std::log(guess->drive_inertia);
  const double gain = 1.0 / basis.ratio;
  Noise noise;
  noise.angle = track.facts.count > 0.0 ? gain * track.facts.count / std::sqrt(12.0) : kUnknownAngleNoise;
  noise.angle_known = track.facts.count > 0.0;
  noise.timing = 2e-4;
  noise.speed = 0.3;
  noise.torque_walk = basis.torque_walk;
  noise.torque = basis.torque_deviation;
  const bool centred = basis.ratio != 1.0;
  const JointFit rough = fitJointly(segments, model, start, noise, allFree(true), piece(progress, 0.05, 0.22));
  segments = cutAtBlows(track, rough.globals[kZero]);
  result.blows = segments.size();

  // The last quarter judges what the first three found.
  const std::size_t three_quarters = segments.size() - segments.size() / 4;
  const std::vector<BlowSegment> first(segments.begin(),
                                       segments.begin() + static_cast<std::ptrdiff_t>(three_quarters));
  const std::vector<BlowSegment> last(segments.begin() + static_cast<std::ptrdiff_t>(three_quarters), segments.end());
  const JointFit part =
      fitJointly(first, model, rough.globals, rough.noise, allFree(centred), piece(progress, 0.22, 0.35));
  result.fitted = meanSquareOf(first, model, part.globals, part.noise, piece(progress, 0.35, 0.45));
  result.held_out = meanSquareOf(last, model, part.globals, part.noise, piece(progress, 0.45, 0.48));

  JointFit fit = fitJointly(segments, model, part.globals, part.noise, allFree(centred), piece(progress, 0.48, 0.65));
  if (!fit.converged || fit.fits.size() < kLeastBlows) {
    result.problem = "its blows are not those of this mechanism: the fit does not settle";
    return result;
  }
  result.left_out = fit.left_out;
  result.noise = fit.noise;
  result.after = curveOf(fit.fits, model, fit.globals, fit.noise);
  const double curve_square = systematic(result.after);
  fit.covariance *= std::max(1.0, curve_square);
  HammerPart hammer = findWithHammer(fit, model, allFree(centred));
  hammer.widen(fit);
  removeBias(fit, hammer, model, allFree(centred), gain * track.facts.count, piece(progress, 0.65, 0.88));
  Globals in_force = basis.in_force;
  in_force.tail<kShaping>() = fit.globals.tail<kShaping>();
  result.before = curveOf(fittedAlone(segments, model, in_force, fit.noise, piece(progress, 0.88, 1.0)), model,
                          in_force, fit.noise);
  const RodEvidence rod = rodEvidence(track, basis, fit);
  const GlobalMatrix by_blows = fit.covariance;
  fit.globals = hammer.globals, fit.covariance = hammer.covariance.topLeftCorner<kGlobals, kGlobals>();
  addEstimates(result, fit, by_blows, basis, hammer.has("rocker_inertia_about_pivot_kg_m2"), centred);
  for (const Estimate& one : estimatesOf(hammer, basis.mechanism.parameters()))
    if (!rod.gives()) result.estimates.push_back(one);
  refuseForRod(rod, result);
  addCorrelations(result, hammer);
  for (std::string& remark : remarksOf(hammer, by_blows, basis.mechanism.parameters()))
    result.remarks.push_back(std::move(remark));
  addRemarks(result, curve_square);
  countNeeds(result);
  return result;
}

}  // namespace hammer_loads::calibration
