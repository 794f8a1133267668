#include "hammer_loads/crank/speed_trust.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kSpeedTurns = 12.0;     // of lag and scale: some 3 s at work
constexpr double kSpeedSamples = 500.0;  // of what is left
constexpr int kFewSpeeds = 50;           // before them nothing is an outlier
constexpr double kMostLag = 0.1;         // [s]: more is no filter of a drive that is controlled by it
constexpr double kMostScale = 0.5;
constexpr double kNotableLag = 5e-4;    // [s]: less shifts a speed at work by no more than its noise, 0.3 rad/s
constexpr double kNotableScale = 0.01;  // likewise
constexpr double kReleased = 0.5;       // of these and of the deviations: where what was seen is given up
constexpr double kMostOfOne = 0.999;    // of a correlation
constexpr double kSingular = 1e-9;      // of the diagonal's product: an even speed shows no lag
// Guard: SpeedTrust.FindsTheLagOfAFilterWithItsDeviation of kSpeedTurns, kNotableLag, kMostLag
// Guard: SpeedTrust.FindsTheLagOfAFilterWithItsDeviation of kSpeedSamples
// Guard: SpeedTrust.FindsAScaleApartFromALag of kNotableScale, kMostScale

bool isSeen(double amount, double notable, double deviation, bool before) noexcept {
  const double part = before ? kReleased : 1.0;
  return std::abs(amount) > part * std::max(notable, gate::kVeryRare * deviation);
}

}  // namespace

double SpeedTrust::lateBy(double dt, double acceleration, double jump) const noexcept {
  if (!begun_) return acceleration;
  const double settled = 0.5 * (acceleration_ + acceleration);
  return settled + std::exp(-dt / kLag) * (late_ + jump / kLag - settled);
}

/// b = speed - y by the exact answer to an even acceleration: b' = acceleration - b/lag.
void SpeedTrust::follow(double dt, const Witness& now) noexcept {
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
  double residual = now.measured - (1.0 + scale_) * filtered;
  if (samples_ > kFewSpeeds) {
    const double most = gate::kImpossible * std::sqrt(square_);
    residual = std::clamp(residual, -most, most);
  }
  if (continues) {
    samples_ += samples_ < static_cast<int>(kSpeedSamples);
    const double gain = 1.0 / samples_;
    square_ += gain * (square(residual) - square_);
    product_ += gain * (residual * residual_ - product_);
    const double whole = 1.0 + scale_;
    const Eigen::Vector2d by{-whole * (by_lag_ + now.by_lag), filtered - whole * now.by_scale};
    information_.noalias() += by * by.transpose();
    score_ += residual * by;
  }
  residual_ = residual;
}

void SpeedTrust::endTurn() noexcept {
  if (samples_ == 0) return;
  ++turns_;
  const double determinant = information_.determinant();
  if (!(determinant > kSingular * information_(0, 0) * information_(1, 1))) return;
  const Eigen::Matrix2d covariance = information_.inverse();
  Eigen::Vector2d change = covariance * score_;
  change[0] = std::clamp(lag_ + change[0], -kMostLag, kMostLag) - lag_;
  change[1] = std::clamp(scale_ + change[1], -kMostScale, kMostScale) - scale_;
  lag_ += change[0], scale_ += change[1];
  score_ -= information_ * change;
  const double rho = std::clamp(product_ / square_, 0.0, kMostOfOne);
  deviation_ = (square_ * (1.0 + rho) / (1.0 - rho) * covariance.diagonal()).cwiseSqrt();
  information_ *= 1.0 - 1.0 / kSpeedTurns, score_ *= 1.0 - 1.0 / kSpeedTurns;
  lags_ = isSeen(lag_, kNotableLag, deviation_[0], lags_);
  out_of_scale_ = isSeen(scale_, kNotableScale, deviation_[1], out_of_scale_);
  are_good_ = isTrusted() && gate::kUsual * deviation_[0] < kNotableLag && gate::kUsual * deviation_[1] < kNotableScale;
}

}  // namespace hammer_loads
