#include "hammer_loads/crank/constant_errors.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kPrior = 0.05;                          // [rad]: 3 deg, far beyond what is found well
constexpr double kPriorSupply = 0.2;                     // of SupplyLaw::unit
constexpr int kFirstTurns = 4;                           // the drive inertia is learned first
constexpr int kTurnsToKnow = 6;                          // nothing is concluded before
constexpr double kMemoryTurns = 300.0;                   // turns: a minute at work
constexpr double kUnmodelled[3] = {1.7e-3, 2e-3, 4e-3};  // [rad] what a clean machine shows: 0.10, 0.11, 0.23 deg
constexpr double kUnmodelledCounts = 0.5;  // likewise, by an encoder's coarseness: 1024 counts look like 0.2 to 0.4 deg
constexpr double kUnmodelledDeviations = 2.5;  // likewise, where it is seen less well
constexpr double kUnseenDeviations = 0.6;      // of what is not seen: 88 to 99 % of the wrench's errors
                                               // then lie within two deviations (simulated machines)
constexpr double kSamplesToFollow = 20.0;      // a turn: with fewer of them a supply that follows the crank's
                                               // speed looks more like b, at 50 Hz twice as much, and
                                               // the torque's walk holds more of what is not seen

constexpr double kMostRatio = 9.0;  // innovation^2 over its variance; more counts as that

}  // namespace

void ConstantErrors::learn(double innovation, double variance, const Row& by_error) noexcept {
  ++samples_;
  const double ratio = innovation * innovation / variance;
  const double weight = (ratio > kMostRatio ? kMostRatio / ratio : 1.0) / variance;
  information_.noalias() += (weight * by_error.transpose()) * by_error;
  score_ += (weight * innovation) * by_error.transpose();
}

void ConstantErrors::takeSupply(double change) noexcept {
  score_ += information_.col(kSupply) * change;
  estimate_[kSupply] += change;
}

void ConstantErrors::forget() noexcept {
  information_ = Matrix::Identity() / square(kPrior);
  information_(kSupply, kSupply) = 1.0 / square(kPriorSupply);
  score_.setZero();
}

void ConstantErrors::endTurn(double growth, double count) noexcept {
  const int samples = std::exchange(samples_, 0);
  if (++turns_ == kFirstTurns) forget();
  if (turns_ < kTurnsToKnow) return;
  Matrix covariance = Matrix::Zero();
  covariance.topLeftCorner<kPlace, kPlace>() = information_.topLeftCorner<kPlace, kPlace>().inverse();
  covariance(kSupply, kSupply) = 1.0 / information_(kSupply, kSupply);
  estimate_ = covariance * score_;
  const double unmodelled = std::max(1.0, kSamplesToFollow / std::max(1, samples));
  Vector doubt = Vector::Zero(), certain = Vector::Zero();  // variance of what is seen; what remains after it
  double share = 0.0;                                       // of b that is certain
  for (int i = 0; i < kPlace; ++i) {
    doubt[i] = square(unmodelled * kUnmodelled[i]) + square(kUnmodelledDeviations) * growth * covariance(i, i);
    deviation_[i] = std::sqrt(doubt[i] + square(kUnmodelledCounts * count));
    const double excess = square(estimate_[i]) - doubt[i];
    certain[i] = excess > 0.0 ? std::copysign(std::sqrt(excess), estimate_[i]) : 0.0;
    if (excess > 0.0) share = std::max(share, excess / square(estimate_[i]));
  }
  moment_ = square(kUnseenDeviations / unmodelled) * growth * covariance + certain * certain.transpose();
  // A sensor that is off for certain is so by as much as is known of it; what is hardly certain adds little.
  moment_.diagonal() += share * share * doubt;
  information_ *= 1.0 - 1.0 / kMemoryTurns;
  score_ *= 1.0 - 1.0 / kMemoryTurns;
}

}  // namespace hammer_loads
