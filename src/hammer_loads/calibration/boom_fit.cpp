#include "hammer_loads/calibration/boom_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hammer_loads/calibration/positive_system.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kFullWeight = 3.0;  // standard deviations of what is left
constexpr int kMostRounds = 40;
constexpr double kSettled = 1e-3;               // in standard deviations
constexpr std::size_t kNeighbouringRows = 100;  // range of rows that may have a common error: 20 s

/// Variance of a sum of neighbours over that of as many strangers: 1 + 2 sum of the autocorrelation. Pairs of lags are
/// added until their sum is lost in noise (initial positive sequence, Geyer 1992): residuals that alternate with a
/// ripple of the pump have a negative first lag and are correlated further away.
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

bool isFriction(BoomUnknown kind) {
  return kind == BoomUnknown::kFrictionForce || kind == BoomUnknown::kFriction || kind == BoomUnknown::kViscous;
}

class Fitter {
 public:
  Fitter(const BoomModel& model, const std::vector<BoomRow>& rows) : model_(model), rows_(rows) {
    fit_.x = model.zero();
    const std::size_t cylinders = model.given().cylinders().size();
    fit_.noise.assign(cylinders, 0.0), fit_.together.assign(cylinders, 1.0);
    for (std::size_t k = 0; k < cylinders; ++k) {  // at first: a part of the force itself
      double square = 0.0, count = 0.0;
      for (const BoomRow& row : rows)
        if (row.cylinder == k) square += row.measured * row.measured, count += 1.0;
      fit_.noise[k] = std::max(1.0, 0.02 * std::sqrt(square / std::max(count, 1.0)));
    }
  }

  /// The correlation of neighbours is that of the residuals of a first fit, which has none. If it were updated in each
  /// round, the errors of a poor first guess would count as correlated noise, and the fit would stay there.
  BoomFit run(const Progress& progress) {
    settle(piece(progress, 0.0, 0.7));
    for (std::size_t k = 0; k < fit_.noise.size(); ++k) fit_.together[k] = alike(residualsOfCylinder(k));
    settle(piece(progress, 0.7, 1.0));
    addRecordings();
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

  /// Adds a relative error of a cylinder's forces in each recording to the covariance, since the load on the tip, the
  /// temperature of the oil and zeros differ by day. Its variance is estimated by the method of moments over the
  /// recordings (DerSimonian and Laird, 1986), in which the basis' value counts as two recordings.
  void addRecordings() {
    if (rows_.empty() || rows_.front().recording == rows_.back().recording) return;
    constexpr double kAsMany = 2.0;
    const Eigen::VectorXd left = residualsOf(model_, rows_, fit_.x), weight = weightsOf(fit_, rows_, left);
    const Eigen::MatrixXd slopes = slopesOf(model_, rows_, fit_.x), covariance = fit_.covariance;
    for (std::size_t k = 0; k < fit_.noise.size(); ++k) {
      double sum = kAsMany * std::pow(model_.basis().recording_gain_std, 2), count = kAsMany;
      Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(fit_.x.size(), fit_.x.size());
      for (std::size_t r = 0; r <= rows_.back().recording; ++r) {
        const Eigen::VectorXd force = forcesOf(k, r), weighted = weight.cwiseProduct(force);
        const Eigen::VectorXd by_unknowns = slopes.transpose() * weighted, change = covariance * by_unknowns;
        const double information = weighted.dot(force) - by_unknowns.dot(change);
        if (!(information > 0.0)) continue;
        sum += std::pow(weighted.dot(left) / information, 2) - 1.0 / information, count += 1.0;
        changes += change * change.transpose();
      }
      fit_.covariance += std::max(sum, 0.0) / count * changes;
    }
  }

  /// Measured forces in the rows of one cylinder in one recording [N], zero in others.
  Eigen::VectorXd forcesOf(std::size_t cylinder, std::size_t recording) const {
    Eigen::VectorXd force(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const bool own = rows_[i].cylinder == cylinder && rows_[i].recording == recording;
      force[static_cast<Eigen::Index>(i)] = own ? rows_[i].measured : 0.0;
    }
    return force;
  }

  /// Friction that would be below zero is held at zero.
  void step() {
    Eigen::VectorXd left = residualsOf(model_, rows_, fit_.x);
    const Eigen::VectorXd weight = weightsOf(fit_, rows_, left);
    left = (weight.array() > 0.0).select(left, 0.0);
    Eigen::MatrixXd J = slopesOf(model_, rows_, fit_.x);
    for (Eigen::Index r = 0; r < J.rows(); ++r)
      if (!(weight[r] > 0.0)) J.row(r).setZero();
    const Eigen::Index n = fit_.x.size();
    std::set<Eigen::Index> held;
    for (bool again = true; again;) {
      Eigen::MatrixXd N = J.transpose() * weight.asDiagonal() * J + Eigen::MatrixXd::Identity(n, n);
      Eigen::VectorXd right = J.transpose() * weight.asDiagonal() * left - fit_.x;
      fit_.covariance = inverseOf(N);
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
  /// The entry of an unknown whose value is zero.
  double atZero(Eigen::Index i) const {
    const Unknown& u = model_.unknowns()[static_cast<std::size_t>(i)];
    return -u.given / u.deviation;
  }

  /// Moves to the next values, or as far towards them as a boom with such values exists.
  void move(const Eigen::VectorXd& next) {
    double part = 1.0;
    while (part > 1e-3 && !model_.boomAt(fit_.x + part * (next - fit_.x), 0)) part *= 0.5;
    fit_.x += part * (next - fit_.x);
  }

  /// Residuals of one cylinder, limited to what counts fully.
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

Eigen::VectorXd weightsOf(const BoomFit& fit, const std::vector<BoomRow>& rows, const Eigen::VectorXd& left) {
  Eigen::VectorXd weight(left.size());
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    const std::size_t k = rows[static_cast<std::size_t>(i)].cylinder;
    const double size = std::abs(left[i]) / fit.noise[k];
    weight[i] = (size > kFullWeight ? kFullWeight / size : 1.0) / (fit.noise[k] * fit.noise[k] * fit.together[k]);
    if (!std::isfinite(left[i])) weight[i] = 0.0;
  }
  return weight;
}

}  // namespace hammer_loads::calibration
