#include "hammer_loads/calibration/boom_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/estimation/gates.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kFullWeight = gate::kRare;  // [standard deviations of the residual]
constexpr int kMostRounds = 40;
constexpr double kSettled = 1e-3;  // [prior standard deviations]
// Numerical: kMostRounds, kSettled
constexpr std::size_t kNeighbouringRows = 100;  // range of rows that may have a common error: 20 s

/// Returns the variance of a sum of successive residuals over that of independent ones: 1 + 2 sum of the
/// autocorrelation. Pairs of lags are added until their sum is within noise (initial positive sequence, Geyer 1992).
/// Residuals that alternate with pump ripple have a negative first lag and are correlated at larger lags.
double alike(const std::vector<double>& left) {
  double square = 0.0;
  for (const double r : left) square += r * r;
  const auto correlation = [&](std::size_t lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < left.size(); ++i) product += left[i] * left[i - lag];
    return product / square;
  };
  double sum = -1.0;
  for (std::size_t lag = 0; lag + 2 < std::min(left.size(), kNeighbouringRows); lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (!(pair > std::sqrt(8.0 / static_cast<double>(left.size())))) break;
    sum += 2.0 * pair;
  }
  return std::max(1.0, sum);
}

/// Returns half the two-sided 95.4 % quantile of Student's distribution; 1 for many degrees of freedom. The expansion
/// about the normal distribution (Abramowitz and Stegun, 26.7.5) has an error below 1 % from two degrees of freedom on.
double studentFactor(double degrees) {
  const double d = 1.0 / degrees;
  return 1.0 + d * (1.25 + d * (1.531 + d * (1.430 + d * 0.922)));
}

/// Returns the variance of the relative error of a cylinder's forces in a recording, by the method of moments
/// (DerSimonian and Laird, 1986). The covariance of the scores is information + variance * information squared.
/// Satterthwaite's degrees of freedom (1946) are the number of recordings minus one if all have the same information.
/// The prior adds one degree. Student's factor enlarges the variance found from few recordings. Two standard deviations
/// then contain 90 % or more even if the scatter is ten times the prior.
double scatterOf(const Eigen::VectorXd& scores, const Eigen::MatrixXd& information, double prior_std) {
  constexpr double kPriorDegrees = 1.0;  // Prior: kPriorDegrees
  const Eigen::MatrixXd square = information * information;
  const double prior = prior_std * prior_std;
  if (!(square.trace() > 0.0)) return prior;
  const double shown = std::max(0.0, (scores.squaredNorm() - information.trace()) / square.trace());
  const double degrees = std::pow(square.trace(), 2) / square.squaredNorm(), all = kPriorDegrees + degrees;
  return (kPriorDegrees * prior + degrees * std::pow(studentFactor(all), 2) * shown) / all;
}

bool isFriction(BoomUnknown kind) {
  return kind == BoomUnknown::kFrictionForce || kind == BoomUnknown::kFriction || kind == BoomUnknown::kViscous;
}

class Fitter {
 public:
  Fitter(const BoomModel& model, const std::vector<BoomRow>& rows) : model_(model), rows_(rows) {
    fit_.x = model.zero();
    const std::size_t cylinders = model.given().cylinders().size();
    fit_.noise.assign(cylinders, 0.0), fit_.together.assign(cylinders, 1.0);
    for (std::size_t k = 0; k < cylinders; ++k) {  // initially a part of the force itself
      double square = 0.0, count = 0.0;
      for (const BoomRow& row : rows)
        if (row.cylinder == k) square += row.measured * row.measured, count += 1.0;
      fit_.noise[k] = std::max(1.0, 0.02 * std::sqrt(square / std::max(count, 1.0)));
    }
  }

  /// Fits twice: first without correlation of neighbours, then with that of the first fit's residuals. Updates in each
  /// round would count errors of a poor first guess as correlated noise, and the fit would stay there.
  BoomFit run(const Progress& progress) {
    settle(piece(progress, 0.0, 0.7));
    for (std::size_t k = 0; k < fit_.noise.size(); ++k) fit_.together[k] = alike(residualsOfCylinder(k));
    settle(piece(progress, 0.7, 1.0));
    findCovariance();
    return std::move(fit_);
  }

 private:
  void settle(const Progress& progress) {
    fit_.converged = false;
    for (int round = 0; round < kMostRounds && !fit_.converged; ++round) {
      const Eigen::VectorXd before = fit_.x;
      step();
      findNoise();
      fit_.converged = round > 2 && (fit_.x - before).cwiseAbs().maxCoeff() < kSettled;
      report(progress, (round + 1.0) / kMostRounds);
    }
  }

  /// Returns the normal matrix including the prior of the unknowns.
  static Eigen::MatrixXd normalOf(const BoomSystem& s) {
    return s.information() + Eigen::MatrixXd::Identity(s.slopes.cols(), s.slopes.cols());
  }

  /// Adds differences between recordings to the fit's covariance. The load on the tip, the oil temperature and zeros
  /// change from day to day. A cylinder's forces therefore have their own relative error in each recording. Few
  /// recordings determine its variance only roughly.
  void findCovariance() {
    const BoomSystem s = systemOf(model_, rows_, fit_);
    fit_.covariance = inverseOf(normalOf(s));
    if (rows_.empty() || rows_.front().recording == rows_.back().recording) return;
    const Eigen::MatrixXd covariance = fit_.covariance;
    for (std::size_t k = 0; k < fit_.noise.size(); ++k) {
      const Eigen::MatrixXd forces = forcesOf(k), weighted = s.weight.asDiagonal() * forces,
                            by_unknowns = s.slopes.transpose() * weighted, changes = covariance * by_unknowns,
                            information = forces.transpose() * weighted - by_unknowns.transpose() * changes;
      fit_.covariance += scatterOf(weighted.transpose() * s.left, information, model_.basis().recording_gain_std) *
                         changes * changes.transpose();
    }
  }

  /// Returns the measured forces of one cylinder [N]: one column per recording, zeros in rows of others.
  Eigen::MatrixXd forcesOf(std::size_t cylinder) const {
    Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()),
                                                   static_cast<Eigen::Index>(rows_.back().recording) + 1);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (rows_[i].cylinder == cylinder)
        forces(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(rows_[i].recording)) = rows_[i].measured;
    return forces;
  }

  /// Takes one step; friction that would become negative is held at zero.
  void step() {
    const BoomSystem s = systemOf(model_, rows_, fit_);
    const Eigen::Index n = fit_.x.size();
    std::set<Eigen::Index> held;
    for (bool again = true; again;) {
      Eigen::MatrixXd N = normalOf(s);
      Eigen::VectorXd right = s.slopes.transpose() * s.weight.cwiseProduct(s.left) - fit_.x;
      for (const Eigen::Index i : held) {
        const double way = atZero(i) - fit_.x[i];
        right -= N.col(i) * way;
        N.row(i).setZero(), N.col(i).setZero(), N(i, i) = 1.0, right[i] = way;
      }
      const Eigen::VectorXd next = fit_.x + solved(N, right);
      again = false;
      for (Eigen::Index i = 0; i < n; ++i)
        if (isFriction(model_.unknowns()[static_cast<std::size_t>(i)].kind) && next[i] < atZero(i) - 1e-9)
          again = held.insert(i).second || again;
      if (!again) move(next);
    }
  }
  /// Returns the entry at which an unknown's value is zero.
  double atZero(Eigen::Index i) const {
    const Unknown& u = model_.unknowns()[static_cast<std::size_t>(i)];
    return -u.given / u.deviation;
  }

  /// Moves to the next values, or as far towards them as the boom remains possible.
  void move(const Eigen::VectorXd& next) {
    double part = 1.0;
    while (part > 1e-3 && !model_.boomAt(fit_.x + part * (next - fit_.x), 0)) part *= 0.5;
    fit_.x += part * (next - fit_.x);
  }

  /// Returns the residuals of one cylinder, clipped at kFullWeight standard deviations.
  std::vector<double> residualsOfCylinder(std::size_t cylinder) const {
    const Eigen::VectorXd left = residualsOf(model_, rows_, fit_.x);
    const double most = kFullWeight * fit_.noise[cylinder];
    std::vector<double> own;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (const double r = left[static_cast<Eigen::Index>(i)]; rows_[i].cylinder == cylinder && std::isfinite(r))
        own.push_back(std::clamp(r, -most, most));
    return own;
  }

  void findNoise() {
    for (std::size_t k = 0; k < fit_.noise.size(); ++k) {
      const std::vector<double> own = residualsOfCylinder(k);
      if (own.size() < 5) continue;
      double square = 0.0;
      for (const double r : own) square += r * r;
      fit_.noise[k] = std::max(1.0, std::sqrt(square / static_cast<double>(own.size())));
    }
  }

  const BoomModel& model_;
  const std::vector<BoomRow>& rows_;
  BoomFit fit_;
};

}  // namespace

BoomFit fitBoom(const BoomModel& model, const std::vector<BoomRow>& rows, const Progress& progress) {
  return Fitter(model, rows).run(progress);
}

BoomSystem systemOf(const BoomModel& model, const std::vector<BoomRow>& rows, const BoomFit& fit) {
  BoomSystem s{residualsOf(model, rows, fit.x), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.size())),
               slopesOf(model, rows, fit.x)};
  for (Eigen::Index i = 0; i < s.left.size(); ++i) {
    if (!std::isfinite(s.left[i])) {
      s.left[i] = 0.0, s.slopes.row(i).setZero();
      continue;
    }
    const std::size_t k = rows[static_cast<std::size_t>(i)].cylinder;
    const double size = std::abs(s.left[i]) / fit.noise[k];
    s.weight[i] = (size > kFullWeight ? kFullWeight / size : 1.0) / (fit.noise[k] * fit.noise[k] * fit.together[k]);
  }
  return s;
}

Eigen::VectorXd stdsOf(const BoomFit& fit, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& function) {
  constexpr double kTenth = 0.1;  // Numerical: kTenth
  std::vector<Eigen::VectorXd> slopes;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    Eigen::VectorXd up = fit.x, down = fit.x;
    up[i] += kTenth, down[i] -= kTenth;
    slopes.emplace_back((function(up) - function(down)) / (2.0 * kTenth));
  }
  Eigen::VectorXd stds(slopes.front().size()), gradient(fit.x.size());
  for (Eigen::Index k = 0; k < stds.size(); ++k) {
    for (Eigen::Index i = 0; i < fit.x.size(); ++i) gradient[i] = slopes[static_cast<std::size_t>(i)][k];
    stds[k] = std::sqrt(std::max(0.0, gradient.dot(fit.covariance * gradient)));
  }
  return stds;
}

}  // namespace hammer_loads::calibration
