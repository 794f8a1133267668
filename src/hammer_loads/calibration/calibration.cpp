#include "hammer_loads/calibration/calibration.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/estimates.h"
#include "hammer_loads/calibration/rod_check.h"
#include "hammer_loads/crank/zero_search.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

constexpr std::size_t kLeastBlows = 12;
constexpr std::size_t kRoughBlows = 40;  // blows of the first fit
// Limit: kLeastBlows
constexpr double kUsuallyNeeded = 60.0;  // blows
// Warning: kUsuallyNeeded
constexpr int kCurveParts = 72;
// Numerical: kCurveParts
constexpr double kUnknownAngleNoise = 5e-4;  // first guess for a sensor without counts [rad]
// Prior: kUnknownAngleNoise

/// Returns the reading at the blow, within some 3 deg [rad]; empty if no blow is found.
std::optional<double> placeOfBlow(const CrankTrack& track, const SegmentModel& model, double drive_inertia) {
  ZeroSearch search(model.shaft, drive_inertia);
  std::optional<double> place;
  double before = 0.0;
  for (const CrankPoint& point : track.points) {
    HullMotion hull;
    hull.gravity = point.gravity;
    search.add(point.seen, point.starts ? 0.0 : point.time - before, hull);
    before = point.time;
    if (search.found()) place = search.found()->error;
  }
  return place;
}

/// Returns at most `most` of the blows, evenly spread over the recording.
std::vector<BlowSegment> spread(const std::vector<BlowSegment>& segments, std::size_t most) {
  std::vector<BlowSegment> some;
  const std::size_t count = std::min(most, segments.size());
  for (std::size_t i = 0; i < count; ++i) some.push_back(segments[i * segments.size() / count]);
  return some;
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
    curve.mean.push_back(enough ? mean : kNaN);
    curve.deviation.push_back(enough ? std::sqrt(variance / n[i]) : kNaN);
  }
  return curve;
}

/// Returns the mean over the revolution of the curve's square over its variance: 1 for noise.
double systematic(const ResidualCurve& curve) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < curve.mean.size(); ++i) {
    if (!(curve.deviation[i] > 0.0)) continue;
    sum += curve.mean[i] * curve.mean[i] / (curve.deviation[i] * curve.deviation[i]);
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 1.0;
}

/// Returns the zero and eccentricities of the current parameters.
Globals inForce(const CrankSensor& sensor) {
  const CrankSensorPlace& p = sensor.place();
  Globals g = Globals::Zero();
  g[kZero] = p.zero * sensor.gain();
  for (const Eigen::Index n : {0, 1}) {
    g[kSine1 + 2 * n] = p.eccentricity[n] * std::cos(p.eccentricity_phase[n]);
    g[kCosine1 + 2 * n] = p.eccentricity[n] * std::sin(p.eccentricity_phase[n]);
  }
  return g;
}

/// Reports that the fit does not converge, with the cause as far as readings at the given sensor parameters show it.
void sayUnsettled(const CrankTrack& track, const CalibrationBasis& basis, double log_inertia, JointFit fit,
                  Calibration& result) {
  result.problem =
      "its blows are not those of this mechanism, as with a coupling between encoder and crank that twists: the fit "
      "does not settle";
  if (2.0 * static_cast<double>(result.blows) >= kUsuallyNeeded) result.more_blows = kInfinity;
  fit.globals = inForce(basis.filter.sensor);
  fit.globals[kLogInertia] = log_inertia;
  const RodEvidence rod = rodEvidence(track, basis, fit);
  if (std::isfinite(rod.later())) result.problem += "; " + textOf(rod, false);
  if (rod.showsElasticRod()) result.more_blows = kInfinity;
}

/// Returns the duration without the gaps [s].
double secondsOf(const CrankTrack& track) {
  double seconds = 0.0;
  for (std::size_t i = 1; i < track.points.size(); ++i)
    if (!track.points[i].starts) seconds += track.points[i].time - track.points[i - 1].time;
  return seconds;
}

/// Computes the blows needed; more blows reduce only the part by_blows of a deviation.
void countNeeds(Calibration& result) {
  double most = 1.0;
  for (const Estimate& e : result.estimates) {
    if (e.determined() || !(e.limit > 0.0)) continue;
    const double by_blows = square(e.by_blows), left = square(e.limit) - (square(e.deviation) - by_blows);
    most = std::max(most, left > 0.0 ? by_blows / left : kInfinity);
  }
  result.more_blows = most * static_cast<double>(result.blows);
}

}  // namespace

double Calibration::worstByBlows() const {
  double worst = problem.empty() ? 0.0 : kInfinity;
  for (const Estimate& e : estimates) worst = std::max(worst, e.by_blows / e.limit);
  return worst;
}

Calibration calibrate(const std::vector<RecordedSample>& samples, const CalibrationBasis& basis,
                      const Progress& progress) {
  Calibration result;
  const CrankTrack track = trackOf(samples, basis.ratio());
  result.facts = track.facts;
  result.more_blows = kUsuallyNeeded;
  result.seconds = secondsOf(track);
  const SegmentModel model{basis.mechanism, basis.level};
  const double drive_inertia = basis.mechanism.parameters().drive_inertia;
  const std::optional<double> blow = placeOfBlow(track, model, drive_inertia);
  if (!blow) {
    result.problem = "no blow shows in the crank's turns";
    return result;
  }
  std::vector<BlowSegment> segments = cutAtBlows(track, *blow);
  result.blows = segments.size();
  if (segments.size() < kLeastBlows) {
    result.problem =
        format("%zu whole revolutions over a blow in it, must be %zu or more", segments.size(), kLeastBlows);
    return result;
  }
  Globals start = Globals::Zero();
  start[kZero] = *blow;
  start[kLogInertia] = std::log(drive_inertia);
  const double gain = 1.0 / basis.ratio();
  Noise noise;
  noise.angle = track.facts.count > 0.0 ? gain * track.facts.count / std::sqrt(12.0) : kUnknownAngleNoise;
  noise.angle_known = track.facts.count > 0.0;
  noise.timing = 2e-4;
  noise.speed = 0.3;
  noise.torque_walk = basis.filter.torque_walk;
  noise.torque = basis.filter.initial_torque_std;
  // A first fit of some blows, with a centred encoder, finds where to cut.
  const JointFit rough =
      fitJointly(spread(segments, kRoughBlows), model, start, noise, true, piece(progress, 0.05, 0.15));
  segments = cutAtBlows(track, rough.globals[kZero]);
  result.blows = segments.size();
  JointFit fit =
      fitJointly(segments, model, rough.globals, rough.noise, basis.ratio() != 1.0, piece(progress, 0.15, 0.35));
  if (!fit.converged || fit.fits.size() < kLeastBlows) {
    sayUnsettled(track, basis, start[kLogInertia], rough, result);
    return result;
  }
  result.left_out = fit.left_out;
  result.mean_square = fit.mean_square;
  result.after = curveOf(fit.fits, model, fit.globals, fit.noise);
  const double curve_square = systematic(result.after);
  fit.covariance *= std::max(1.0, curve_square);
  HammerPart hammer = findWithHammer(fit, model);
  hammer.widen(fit);
  if (!hammer.isCertain()) {
    sayUnsettled(track, basis, start[kLogInertia], rough, result);
    return result;
  }
  removeBias(fit, hammer, model, gain * track.facts.count, piece(progress, 0.35, 0.95));
  hammer.weighByMounting();
  Globals in_force = inForce(basis.filter.sensor);
  in_force.tail<kShaping>() = fit.globals.tail<kShaping>();
  std::vector<SegmentFit> as_in_force;
  for (const BlowSegment& segment : segments) {
    as_in_force.emplace_back(segment, in_force);
    fitLocals(as_in_force.back(), model, in_force, fit.noise);
  }
  result.before = curveOf(as_in_force, model, in_force, fit.noise);
  addResults({fit, hammer, basis, rodEvidence(track, basis, fit), curve_square}, result);
  countNeeds(result);
  return result;
}

}  // namespace hammer_loads::calibration
