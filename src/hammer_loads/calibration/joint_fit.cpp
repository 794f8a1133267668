#include "hammer_loads/calibration/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads::calibration {
namespace {

constexpr int kMostIterations = 40;
constexpr int kLeastIterations = 8;
constexpr int kUsualExcess = 2;  // iterations beyond the least: for the progress shown alone
constexpr int kLocalIterations = 4;
constexpr int kReplicas = 4;  // of the recording, by which the bias is found
constexpr int kReplicaIterations = 3;
constexpr double kBiasDoubt = 0.5;        // of the bias, left over when it is removed
constexpr double kConverged = 0.01;       // of a deviation, change of every parameter
constexpr double kNotExplained = 6.0;     // times the median mean square of the blows
constexpr int kNeighbours = 3;            // blows on either side with which one may have errors in common
constexpr double kMostTiming = 0.01;      // [s]
constexpr double kMostAngleNoise = 0.1;   // [rad]
constexpr double kMostSpeedNoise = 30.0;  // [rad/s]

using LocalMatrix = Eigen::Matrix<double, kLocals, kLocals>;

/// Marquardt: a little more of the diagonal.
LocalMatrix damped(const LocalMatrix& matrix, double part) {
  LocalMatrix result = matrix;
  result.diagonal() *= 1.0 + part;
  return result;
}

/// No step longer than what the model's curvature bears.
Locals limited(const Locals& step, const Locals& at) {
  double part = 1.0;
  for (const Eigen::Index k : {kSpeedBefore, kSpeedAfter}) {
    if (std::abs(step[k]) > 0.3 * at[k]) part = std::min(part, 0.3 * at[k] / std::abs(step[k]));
  }
  const double most = 0.1 / std::max(at[kSpeedBefore], 1.0);
  if (std::abs(step[kInstant]) > most) part = std::min(part, most / std::abs(step[kInstant]));
  return part * step;
}

Globals limited(const Globals& step) {
  static const Globals most = (Globals() << 0.05, 0.05, 0.05, 0.03, 0.03, 0.3, 1e9, 1e9).finished();
  double part = 1.0;
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    if (std::abs(step[k]) > most[k]) part = std::min(part, most[k] / std::abs(step[k]));
  }
  return part * step;
}

/// The blow's own parameters, the shared ones given.
void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise, int iterations) {
  double cost = fit.cost(model, globals, noise);
  double damping = 1e-3;
  for (int i = 0; i < iterations; ++i) {
    const NormalEquations e = fit.linearise(model, globals, noise);
    const Locals before = fit.locals();
    bool better = false;
    for (int k = 0; k < 5 && !better; ++k) {
      fit.setLocals(before + limited(Locals(damped(e.ll, damping).ldlt().solve(e.l)), before));
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

/// Information of a blow on the shared parameters once its own are eliminated.
struct Reduced {
  GlobalMatrix matrix;
  Globals score;
  LocalMatrix inverse;
  Eigen::Matrix<double, kLocals, kGlobals> by_global;  ///< -(change of locals per change of globals)
  Locals own;                                          ///< change of locals with globals as they are
  double angle_freedom, speed_freedom;                 ///< locals that the angles, that the speeds decide
};

/// Residuals that are free where this many are given.
double freeOf(double given, double decided) { return std::max(given - decided, 0.3 * given); }

Reduced reduce(const NormalEquations& e) {
  Reduced r;
  r.inverse = e.ll.ldlt().solve(LocalMatrix::Identity());
  r.by_global = r.inverse * e.lg;
  r.own = r.inverse * e.l;
  r.matrix = e.gg - e.lg.transpose() * r.by_global;
  r.score = e.g - e.lg.transpose() * r.own;
  r.angle_freedom = (r.inverse * e.ll_angles).trace();
  r.speed_freedom = (r.inverse * e.ll_speeds).trace();
  return r;
}

/// A residual of which one kind of noise is asked: its variance is known + lever^2 noise^2.
struct Leftover {
  double residual, known, lever;
};

/// Root of sum(min(r^2/variance, 9)) = freedom, decreasing in the noise; 0 when already below.
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

double meanSquare(const SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise) {
  double sum = 0.0, n = 0.0;
  for (const ResidualAt& r : fit.residuals(model, globals, noise)) {
    sum += square(r.angle / r.deviation.angle);
    n += 1.0;
  }
  return sum / n;
}

/// Blows far off all others are not of this model.
void leaveOut(JointFit& joint, const SegmentModel& model) {
  std::vector<double> squares;
  for (const SegmentFit& fit : joint.fits) squares.push_back(meanSquare(fit, model, joint.globals, joint.noise));
  std::vector<double> sorted = squares;
  std::sort(sorted.begin(), sorted.end());
  const double most = kNotExplained * std::max(sorted[sorted.size() / 2], 0.05);
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
  } else {  // jitter and noise of the angle in one
    noise.timing = 0.0;
    noise.angle = std::max(noiseOf(angles, angle_freedom, kMostAngleNoise), 1e-7);
  }
  if (!speeds.empty()) noise.speed = std::max(noiseOf(speeds, speed_freedom, kMostSpeedNoise), 1e-3);
}

struct System {
  GlobalMatrix matrix;
  Globals score;
  std::vector<Reduced> reduced;
  double cost{};
};

System linearised(const JointFit& joint, const SegmentModel& model, const Globals& start) {
  System s;
  const Globals weight = priorDeviations().cwiseAbs2().cwiseInverse();
  s.matrix = weight.asDiagonal();
  s.score = weight.cwiseProduct(start - joint.globals);
  s.cost = 0.5 * (start - joint.globals).cwiseAbs2().dot(weight);
  for (const SegmentFit& fit : joint.fits) {
    const NormalEquations e = fit.linearise(model, joint.globals, joint.noise);
    s.reduced.push_back(reduce(e));
    s.matrix += s.reduced.back().matrix;
    s.score += s.reduced.back().score;
    s.cost += e.cost;
  }
  return s;
}

double costOf(const JointFit& joint, const SegmentModel& model, const Globals& start) {
  double cost = 0.5 * (start - joint.globals).cwiseQuotient(priorDeviations()).squaredNorm();
  for (const SegmentFit& fit : joint.fits) cost += fit.cost(model, joint.globals, joint.noise);
  return cost;
}

/// Parameters that stay are left out of the system.
void hold(const Free& free, GlobalMatrix& matrix, Globals& score) {
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    if (free[k]) continue;
    matrix.row(k).setZero(), matrix.col(k).setZero();
    matrix(k, k) = 1.0;
    score[k] = 0.0;
  }
}

/// One step with backtracking; the largest change in deviations.
double improve(JointFit& joint, const SegmentModel& model, const Globals& start, System& s, const Free& free) {
  GlobalMatrix matrix = s.matrix;
  Globals score = s.score;
  hold(free, matrix, score);
  const GlobalMatrix inverse = matrix.ldlt().solve(GlobalMatrix::Identity());
  const Globals whole = limited(Globals(inverse * score));
  const JointFit before = joint;
  for (double part = 1.0; part > 0.01; part *= 0.4) {
    joint.globals = before.globals + part * whole;
    for (std::size_t i = 0; i < joint.fits.size(); ++i) {
      const Reduced& r = s.reduced[i];
      const Locals at = before.fits[i].locals();
      joint.fits[i].setLocals(at + limited(Locals(part * (r.own - r.by_global * whole)), at));
    }
    if (costOf(joint, model, start) < s.cost + 1e-9 * std::abs(s.cost))
      return (part * whole).cwiseQuotient(inverse.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
  }
  joint = before;
  return 0.0;
}

/// Sandwich over the blows, with the neighbours' common errors falling off in a triangle.
GlobalMatrix covarianceOf(const System& s, const GlobalMatrix& inverse, const Free& free) {
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
  // Neighbours that cancel, or too few blows, must not make it better than the noise alone allows.
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    const double grow = std::sqrt(std::max(1.0, inverse(k, k) / std::max(covariance(k, k), 1e-300)));
    covariance.row(k) *= grow;
    covariance.col(k) *= grow;
    if (!free[k]) covariance.row(k).setZero(), covariance.col(k).setZero();
  }
  return covariance;
}

/// Until nothing changes any more, at least this many times.
void settle(JointFit& joint, const SegmentModel& model, const Globals& start, const Free& free, int least,
            const Progress& progress) {
  for (int i = 0; i < kMostIterations && !joint.fits.empty(); ++i) {
    report(progress, std::min(1.0, static_cast<double>(i) / (least + kUsualExcess)));
    System s = linearised(joint, model, start);
    joint.converged = improve(joint, model, start, s, free) < kConverged;
    learnNoise(joint, model, s.reduced);
    if (i == kLeastIterations - 2) leaveOut(joint, model);
    if (joint.converged && i + 1 >= least) return;
  }
}

/// Covariances and the mean square of the residuals.
void judge(JointFit& joint, const SegmentModel& model, const Globals& start, const Free& free) {
  if (joint.fits.empty()) return;
  System s = linearised(joint, model, start);
  hold(free, s.matrix, s.score);
  joint.plain_covariance = s.matrix.ldlt().solve(GlobalMatrix::Identity());
  joint.covariance = covarianceOf(s, joint.plain_covariance, free);
  double sum = 0.0, freedom = 0.0;
  for (std::size_t i = 0; i < joint.fits.size(); ++i) {
    const auto n = static_cast<double>(joint.fits[i].size());
    sum += n * meanSquare(joint.fits[i], model, joint.globals, joint.noise);
    freedom += freeOf(n, s.reduced[i].angle_freedom);
  }
  joint.mean_square = sum / freedom;
}

}  // namespace

Globals priorDeviations() { return (Globals() << 10.0, 0.05, 0.05, 0.03, 0.03, 1.5, 30.0, 0.3).finished(); }

JointFit fitJointly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& start,
                    const Noise& noise, const Free& free, const Progress& progress) {
  constexpr double kOwn = 0.3;  // of the time, for what each blow has of its own
  JointFit joint;
  joint.globals = start;
  joint.noise = noise;
  for (const BlowSegment& segment : segments) {
    joint.fits.emplace_back(segment, start);
    fitLocals(joint.fits.back(), model, start, noise, kLocalIterations);
    report(progress, kOwn * static_cast<double>(joint.fits.size()) / static_cast<double>(segments.size()));
  }
  leaveOut(joint, model);
  settle(joint, model, start, free, kLeastIterations, piece(progress, kOwn, 1.0));
  judge(joint, model, start, free);
  return joint;
}

void removeBias(JointFit& joint, const SegmentModel& model, const Free& free, double count, const Progress& progress) {
  if (joint.fits.empty()) return;
  std::mt19937_64 random(1);
  Globals mean = Globals::Zero();
  for (int i = 0; i < kReplicas; ++i) {
    std::vector<BlowSegment> segments;
    for (const SegmentFit& fit : joint.fits)
      segments.push_back(fit.replica(model, joint.globals, joint.noise, count, random));
    JointFit replica = joint;
    for (std::size_t k = 0; k < segments.size(); ++k) replica.fits[k] = joint.fits[k].onto(segments[k]);
    settle(replica, model, joint.globals, free, kReplicaIterations,
           piece(progress, static_cast<double>(i) / kReplicas, (i + 1.0) / kReplicas));
    mean += replica.globals / kReplicas;
  }
  const Globals bias = mean - joint.globals;
  joint.globals -= bias;
  joint.covariance *= 1.0 + 1.0 / kReplicas;
  joint.covariance += kBiasDoubt * kBiasDoubt * bias * bias.transpose();
  for (SegmentFit& fit : joint.fits) fitLocals(fit, model, joint.globals, joint.noise, kLocalIterations);
}

std::vector<SegmentFit> fittedAlone(const std::vector<BlowSegment>& segments, const SegmentModel& model,
                                    const Globals& globals, const Noise& noise, const Progress& progress) {
  std::vector<SegmentFit> fits;
  for (const BlowSegment& segment : segments) {
    fits.emplace_back(segment, globals);
    fitLocals(fits.back(), model, globals, noise, 3 * kLocalIterations);
    report(progress, static_cast<double>(fits.size()) / static_cast<double>(segments.size()));
  }
  return fits;
}

double meanSquareOf(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& globals,
                    const Noise& noise, const Progress& progress) {
  double sum = 0.0, freedom = 0.0;
  std::vector<std::pair<double, double>> each;
  for (const SegmentFit& fit : fittedAlone(segments, model, globals, noise, progress)) {
    const auto n = static_cast<double>(fit.size());
    const Reduced r = reduce(fit.linearise(model, globals, noise));
    const double left = freeOf(n, r.angle_freedom);
    each.emplace_back(n * meanSquare(fit, model, globals, noise) / left, left);
  }
  if (each.empty()) return 0.0;
  std::sort(each.begin(), each.end());
  const double most = kNotExplained * std::max(each[each.size() / 2].first, 0.05);
  while (each.back().first > most) each.pop_back();  // blows without a tool are not the parameters' fault
  for (const auto& [square_mean, free_samples] : each) sum += square_mean * free_samples, freedom += free_samples;
  return freedom > 0.0 ? sum / freedom : 0.0;
}

}  // namespace hammer_loads::calibration
