#include "hammer_loads/crank/speed_trust.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kSpeedTurns = 30.0;  // memory for lag and scale: some 6 s at work
constexpr double kMostScale = 0.5;
constexpr double kNotableLag = 5e-4;    // [s]: less shifts a speed at work by no more than its noise, 0.3 rad/s
constexpr double kNotableScale = 0.01;  // less also remains within the noise
constexpr double kLeastTurns = 1.5;     // more than one, to know their scatter
constexpr double kMostOfOne = 0.999;    // largest correlation
// Prior: kMostScale
// Numerical: kMostOfOne

/// Returns the ratio of an amount to the smallest significant one.
double shown(double amount, double notable, double deviation) noexcept {
  return std::abs(amount) / std::max(notable, gate::kVeryRare * deviation);
}

}  // namespace

double SpeedTrust::lateBy(double dt, double acceleration, double jump) const noexcept {
  if (!begun_) return acceleration;
  const double settled = 0.5 * (acceleration_ + acceleration);
  return settled + std::exp(-dt / kLag) * (late_ + jump / kLag - settled);
}

/// Exact solution for b = speed - y with a constant acceleration: b' = acceleration - b/lag.
void SpeedTrust::follow(double dt, const Comparison& now) noexcept {
  late_ = lateBy(dt, now.acceleration, now.jump);
  const bool continues = std::exchange(begun_, true);
  const double mean = continues ? 0.5 * (acceleration_ + now.acceleration) : now.acceleration;
  const double kept = continues && lag_ > 0.0 ? std::exp(-dt / lag_) : 0.0;
  const double before = behind_ + now.jump;
  const double settled = lag_ * mean;
  by_lag_ = mean + kept * (by_lag_ - mean);
  if (kept > 0.0) by_lag_ += kept * (before - settled) * dt / square(lag_);
  behind_ = settled + kept * (before - settled);
  acceleration_ = now.acceleration;
  const double filtered = now.speed - behind_ - lag_ * now.by_lag - scale_ * now.by_scale;
  const double size = std::sqrt(now.variance);
  const double whole = 1.0 + scale_;
  Row row{now.measured - whole * filtered, -whole * (by_lag_ + now.by_lag), filtered - whole * now.by_scale};
  row /= size;
  if (!row.allFinite()) return restart();
  if (const double most = gate::kImpossible * std::sqrt(square_); most > 0.0) row[0] = std::clamp(row[0], -most, most);
  if (continues) {
    same_.noalias() += row * row.transpose();
    next_.noalias() += 0.5 * (row * last_.transpose() + last_ * row.transpose());
    ++count_;
  }
  last_ = row;
}

/// Weights the revolution by the residuals of its own best fit, so that one with a lost estimate counts little.
void SpeedTrust::endTurn() noexcept {
  constexpr int kFitted = decltype(deviation_)::RowsAtCompileTime;  // lag and scale
  if (count_ <= 2 * kFitted) return;
  ++turns_;
  const Eigen::Matrix2d prior = Eigen::Vector2d(1.0 / square(kLag), 1.0 / square(kScale)).asDiagonal();
  const Eigen::Matrix2d of_turn = same_.bottomRightCorner<2, 2>();
  const Eigen::Vector2d by_turn = same_.bottomLeftCorner<2, 1>();
  const Eigen::Vector2d fit = (prior + of_turn).inverse() * by_turn;
  const Row best(1.0, -fit[0], -fit[1]);
  const double sum = best.dot(same_ * best);
  const double rho = std::clamp(best.dot(next_ * best) / sum, 0.0, kMostOfOne);
  const double counts = (1.0 - rho) / (1.0 + rho) * (count_ - kFitted) / sum;  // weight of a row
  square_ = same_(0, 0) / count_;
  constexpr double kKept = 1.0 - 1.0 / kSpeedTurns;
  information_ = kKept * information_ + counts * of_turn;
  score_ = kKept * score_ + counts * by_turn;
  scatter_ = kKept * scatter_ + counts * by_turn.dot(fit);
  seen_turns_ = kKept * seen_turns_ + 1.0;
  same_.setZero(), next_.setZero(), count_ = 0;
  if (seen_turns_ < kLeastTurns) return;
  const Eigen::Vector2d off = (prior + information_).inverse() * score_;
  const double beyond = (scatter_ - score_.dot(off)) / (kFitted * (seen_turns_ - 1.0));
  const double share = 1.0 / std::max(1.0, beyond);
  const Eigen::Matrix2d covariance = (prior + share * information_).inverse();
  const Eigen::Vector2d now(lag_, scale_), found = now + covariance * (share * score_ - prior * now);
  lag_ = found[0], scale_ = std::clamp(found[1], -kMostScale, kMostScale);
  const Eigen::Vector2d change = Eigen::Vector2d(lag_, scale_) - now;
  scatter_ -= change.dot(2.0 * score_ - information_ * change);
  score_ -= information_ * change;
  deviation_ = covariance.diagonal().cwiseSqrt();
  // Rows are linearised about the lag and scale of their time, so that a large change discards them.
  if (std::abs(change[0]) > gate::kRare * deviation_[0] || std::abs(change[1]) > gate::kRare * deviation_[1])
    information_.setZero(), score_.setZero(), scatter_ = seen_turns_ = 0.0;
  lags_.follow(shown(lag_, kNotableLag, deviation_[0]));
  out_of_scale_.follow(shown(scale_, kNotableScale, deviation_[1]));
  are_good_ = isTrusted() && gate::kUsual * deviation_[0] < kNotableLag && gate::kUsual * deviation_[1] < kNotableScale;
}

}  // namespace hammer_loads
