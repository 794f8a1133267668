#include "hammer_loads/crank/sensor_errors.h"

#include <Eigen/LU>

namespace hammer_loads {
namespace {

constexpr double kPrior = 0.05;                          // [rad]: 3 deg, far beyond what is found well
constexpr int kFirstTurns = 4;                           // the drive inertia is learned first
constexpr int kTurnsToKnow = 6;                          // nothing is concluded before
constexpr double kMemory = 300.0;                        // turns: a minute at work
constexpr double kUnmodelled[3] = {1.7e-3, 2e-3, 4e-3};  // [rad] what a clean machine shows: 0.10, 0.11, 0.23 deg
constexpr double kUnmodelledDeviations = 2.5;            // likewise, where it is seen less well
constexpr double kUnseenDeviations = 0.6;                // of what is not seen: 88 to 99 % of the wrench's errors
                                                         // then lie within two deviations (simulated machines)

double square(double x) noexcept { return x * x; }

}  // namespace

void SensorErrors::forget() noexcept {
  information_ = Matrix::Identity() / square(kPrior);
  score_.setZero();
}

void SensorErrors::endTurn(double growth) noexcept {
  if (++turns_ == kFirstTurns) forget();
  if (turns_ < kTurnsToKnow) return;
  const Matrix covariance = information_.inverse();
  estimate_ = covariance * score_;
  Vector certain;  // what remains after the deviation
  for (int i = 0; i < kSize; ++i) {
    deviation_[i] = std::sqrt(square(kUnmodelled[i]) + square(kUnmodelledDeviations) * growth * covariance(i, i));
    const double excess = square(estimate_[i]) - square(deviation_[i]);
    certain[i] = excess > 0.0 ? std::copysign(std::sqrt(excess), estimate_[i]) : 0.0;
  }
  moment_ = square(kUnseenDeviations) * growth * covariance + certain * certain.transpose();
  information_ *= 1.0 - 1.0 / kMemory;
  score_ *= 1.0 - 1.0 / kMemory;
}

}  // namespace hammer_loads
