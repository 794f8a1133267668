#include "hammer_loads/calibration/joint_fit.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr int kIterations = 4;         // Numerical: kIterations
constexpr double kNotExplained = 6.0;  // times the median mean square of the blows

// Numerical: kMostIterations, kLeastIterations, kNearIterations, kConverged
constexpr int kMostIterations = 40;
constexpr int kLeastIterations = 8;
constexpr int kNearIterations = 3;
constexpr double kConverged = 0.01;  // change of every parameter, in standard deviations
constexpr int kNeighbours = 3;       // blows on either side whose errors may be correlated
// Prior: kMostTiming, kMostAngleNoise, kMostSpeedNoise
constexpr double kMostTiming = 0.01;      // [s]
constexpr double kMostAngleNoise = 0.1;   // [rad]
constexpr double kMostSpeedNoise = 30.0;  // [rad/s]

/// Limits the steps to the range in which the linearised model holds.
Globals limitedGlobals(const Globals& step) {
  static const Globals most = (Globals() << 0.05, 0.05, 0.05, 0.03, 0.03, 0.3, 1e9, 1e9).finished();
  return std::min(1.0, most.cwiseQuotient(step.cwiseAbs()).minCoeff()) * step;
}
Locals limitedLocals(const Locals& step, const Locals& at) {
  const auto part = [&](Eigen::Index k, double most) { return most / std::abs(step[k]); };
  return std::min({1.0, part(kSpeedBefore, 0.3 * at[kSpeedBefore]), part(kSpeedAfter, 0.3 * at[kSpeedAfter]),
                   part(kInstant, 0.1 / std::max(at[kSpeedBefore], 1.0))}) *
         step;
}

/// Information of a blow on the shared parameters, with its own parameters eliminated.
struct Reduced {
  GlobalMatrix matrix;
  Globals score;
  Eigen::Matrix<double, kLocals, kGlobals> by_global;  ///< -(change of locals per change of globals)
  Locals own;                                          ///< change of locals with unchanged globals
  double angle_freedom, speed_freedom;                 ///< number of locals that angles and speeds determine
};

Reduced reduce(const NormalEquations& e) {
  Reduced r;
  const LocalMatrix inverse = inverseOf(e.ll);
  r.by_global = inverse * e.lg;
  r.own = inverse * e.l;
  r.matrix = e.gg - e.lg.transpose() * r.by_global;
  r.score = e.g - e.lg.transpose() * r.own;
  r.angle_freedom = (inverse * e.ll_angles).trace();
  r.speed_freedom = (inverse * e.ll_speeds).trace();
  return r;
}

/// Returns the degrees of freedom of `given` residuals, of which the locals determine `decided`.
double freeOf(double given, double decided) { return std::max(given - decided, 0.3 * given); }

/// Returns the mean square of the angle residuals over their deviations.
double meanSquare(const SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise) {
  double sum = 0.0;
  for (const ResidualAt& r : fit.residuals(model, globals, noise)) sum += square(r.angle / r.deviation.angle);
  return sum / static_cast<double>(fit.size());
}

/// Residual for the estimate of one kind of noise; its variance is known + lever^2 noise^2.
struct Leftover {
  double residual, known, lever;
};

/// Solves sum(min(r^2/variance, 9)) = freedom, decreasing in the noise; returns 0 if it is already below.
double noiseOf(const std::vector<Leftover>& leftovers, double freedom, double most) {
  const auto excess = [&](double noise) {
    double sum = 0.0;
    for (const Leftover& l : leftovers) sum += std::min(square(l.residual) / (l.known + square(l.lever * noise)), 9.0);
    return sum - freedom;
  };
  double low = 0.0, high = most;
  if (leftovers.empty() || excess(1e-9 * most) <= 0.0) return 0.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Removes blows with residuals far above those of the others, which the model does not explain.
void leaveOut(JointFit& joint, const SegmentModel& model) {
  std::vector<double> squares;
  for (const SegmentFit& fit : joint.fits) squares.push_back(meanSquare(fit, model, joint.globals, joint.noise));
  const double most = kNotExplained * std::max(medianOf(squares), 0.05);
  std::vector<SegmentFit> kept;
  for (std::size_t i = 0; i < joint.fits.size(); ++i) {
    if (squares[i] <= most) kept.push_back(joint.fits[i]);
  }
  joint.left_out += joint.fits.size() - kept.size();
  joint.fits = std::move(kept);
}

void learnNoise(JointFit& joint, const SegmentModel& model, const std::vector<Reduced>& reduced) {
  Noise& noise = joint.noise;
  std::vector<Leftover> angles, speeds;
  double angle_freedom = 0.0, speed_freedom = 0.0;
  for (std::size_t i = 0; i < joint.fits.size(); ++i) {
    const std::size_t angles_before = angles.size(), speeds_before = speeds.size();
    for (const ResidualAt& r : joint.fits[i].residuals(model, joint.globals, noise)) {
      angles.push_back({r.angle, noise.angle_known ? square(noise.angle) : 0.0, noise.angle_known ? r.speed : 1.0});
      if (!std::isnan(r.speed_error))
        speeds.push_back({r.speed_error, square(r.deviation.speed) - square(noise.speed), 1.0});
    }
    angle_freedom += freeOf(static_cast<double>(angles.size() - angles_before), reduced[i].angle_freedom);
    speed_freedom += freeOf(static_cast<double>(speeds.size() - speeds_before), reduced[i].speed_freedom);
  }
  if (noise.angle_known) {
    noise.timing = noiseOf(angles, angle_freedom, kMostTiming);
  } else {  // jitter and angle noise combined
    noise.timing = 0.0;
    noise.angle = std::max(noiseOf(angles, angle_freedom, kMostAngleNoise), 1e-7);
  }
  if (!speeds.empty()) noise.speed = std::max(noiseOf(speeds, speed_freedom, kMostSpeedNoise), 1e-3);
}

struct System {
  GlobalMatrix matrix;
  Globals score;
  std::vector<Reduced> reduced;
};

System linearised(const JointFit& joint, const SegmentModel& model) {
  System s;
  const Globals weight = priorDeviations().cwiseAbs2().cwiseInverse();
  s.matrix = weight.asDiagonal();
  s.score = weight.cwiseProduct(joint.centre - joint.globals);
  for (const SegmentFit& fit : joint.fits) {
    s.reduced.push_back(reduce(fit.linearise(model, joint.globals, joint.noise)));
    s.matrix += s.reduced.back().matrix;
    s.score += s.reduced.back().score;
  }
  return s;
}

double costOf(const JointFit& joint, const SegmentModel& model) {
  double cost = 0.5 * (joint.centre - joint.globals).cwiseQuotient(priorDeviations()).squaredNorm();
  for (const SegmentFit& fit : joint.fits) cost += fit.cost(model, joint.globals, joint.noise);
  return cost;
}

/// Makes one step with backtracking and returns the largest change in standard deviations.
double improve(JointFit& joint, const SegmentModel& model, System s) {
  if (joint.centred) holdEccentricity(s.matrix, s.score);
  const GlobalMatrix inverse = inverseOf(s.matrix);
  const Globals whole = limitedGlobals(Globals(inverse * s.score));
  const double cost = costOf(joint, model);
  const JointFit before = joint;
  for (double part = 1.0; part > 0.01; part *= 0.4) {
    joint.globals = before.globals + part * whole;
    for (std::size_t i = 0; i < joint.fits.size(); ++i) {
      const Reduced& r = s.reduced[i];
      const Locals at = before.fits[i].locals();
      joint.fits[i].setLocals(at + limitedLocals(Locals(part * (r.own - r.by_global * whole)), at));
    }
    if (costOf(joint, model) < cost + 1e-9 * std::abs(cost))
      return (part * whole).cwiseQuotient(inverse.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
  }
  joint = before;
  return 0.0;
}

/// Returns the sandwich covariance over the blows; weights of neighbouring blows decrease linearly with distance.
GlobalMatrix covarianceOf(const System& s, const GlobalMatrix& inverse, bool centred) {
  GlobalMatrix middle = GlobalMatrix::Zero();
  const std::size_t n = s.reduced.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (int lag = 0; lag <= kNeighbours && i + static_cast<std::size_t>(lag) < n; ++lag) {
      const GlobalMatrix product = s.reduced[i].score * s.reduced[i + static_cast<std::size_t>(lag)].score.transpose();
      const double weight = 1.0 - static_cast<double>(lag) / (kNeighbours + 1);
      middle += lag == 0 ? product : GlobalMatrix(weight * (product + product.transpose()));
    }
  }
  const double few = static_cast<double>(n) / std::max(static_cast<double>(n) - kGlobals, 1.0);
  GlobalMatrix covariance = few * inverse * middle * inverse;
  // The covariance is at least that of the noise alone, even if neighbours cancel or blows are few.
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    const double grow = std::sqrt(std::max(1.0, inverse(k, k) / std::max(covariance(k, k), 1e-300)));
    covariance.row(k) *= grow;
    covariance.col(k) *= grow;
  }
  if (centred) clearEccentricity(covariance);
  return covariance;
}

/// Iterates until the fit converges, at least `least` times.
void settle(JointFit& joint, const SegmentModel& model, int least, const Progress& progress) {
  for (int i = 0; i < kMostIterations && !joint.fits.empty(); ++i) {
    report(progress, std::min(1.0, static_cast<double>(i) / least));
    const System s = linearised(joint, model);
    joint.converged = improve(joint, model, s) < kConverged;
    learnNoise(joint, model, s.reduced);
    if (i == kLeastIterations - 2) leaveOut(joint, model);
    if (joint.converged && i + 1 >= least) return;
  }
}

/// Computes the covariances and the mean square of the residuals.
void judge(JointFit& joint, const SegmentModel& model) {
  if (joint.fits.empty()) return;
  System s = linearised(joint, model);
  if (joint.centred) holdEccentricity(s.matrix, s.score);
  joint.plain_covariance = inverseOf(s.matrix);
  joint.covariance = covarianceOf(s, joint.plain_covariance, joint.centred);
  double sum = 0.0, freedom = 0.0;
  for (std::size_t i = 0; i < joint.fits.size(); ++i) {
    const auto n = static_cast<double>(joint.fits[i].size());
    sum += n * meanSquare(joint.fits[i], model, joint.globals, joint.noise);
    freedom += freeOf(n, s.reduced[i].angle_freedom);
  }
  joint.mean_square = sum / freedom;
}

}  // namespace

void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise) {
  double cost = fit.cost(model, globals, noise);
  double damping = 1e-3;
  for (int i = 0; i < kIterations; ++i) {
    const NormalEquations e = fit.linearise(model, globals, noise);
    const Locals before = fit.locals();
    bool better = false;
    for (int k = 0; k < 5 && !better; ++k) {
      LocalMatrix damped = e.ll;
      damped.diagonal() *= 1.0 + damping;
      fit.setLocals(before + limitedLocals(Locals(solved(damped, e.l)), before));
      const double now = fit.cost(model, globals, noise);
      better = now < cost;
      if (better) {
        cost = now, damping *= 0.1;
      } else {
        fit.setLocals(before), damping = damping * 10.0 + 1e-6;
      }
    }
    if (!better) return;
  }
}

Globals priorDeviations() { return (Globals() << 10.0, 0.05, 0.05, 0.03, 0.03, 1.5, 30.0, 0.3).finished(); }

JointFit fitJointly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& start,
                    const Noise& noise, bool centred, const Progress& progress) {
  JointFit joint;
  joint.globals = joint.centre = start;
  joint.noise = noise, joint.centred = centred;
  for (const BlowSegment& segment : segments) {
    joint.fits.emplace_back(segment, start);
    fitLocals(joint.fits.back(), model, start, noise);
  }
  leaveOut(joint, model);
  settle(joint, model, kLeastIterations, progress);
  judge(joint, model);
  return joint;
}

void settleNear(JointFit& joint, const SegmentModel& model, const Progress& progress) {
  joint.centre = joint.globals;
  settle(joint, model, kNearIterations, progress);
}

}  // namespace hammer_loads::calibration
