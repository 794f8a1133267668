#include "hammer_loads/crank/constant_errors.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/covariance_root.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr int kFirstTurns = 4;   // the drive inertia is identified first
constexpr int kTurnsToKnow = 6;  // no results before
constexpr double kUnmodelledCounts =
    0.5;  // counts: apparent error of a correct machine, 0.2 to 0.4 deg with 1024 counts
// Prior: kUnmodelledCounts
constexpr double kUnmodelledDeviations = 2.5;  // factor on a standard deviation before a warning

}  // namespace

bool ConstantErrors::isKnown() const noexcept { return turns_ >= kTurnsToKnow; }

double ConstantErrors::zeroDeviation() const noexcept {
  return std::sqrt(moment_(kZero, kZero) + square(kUnknowns[kZero].unmodelled));
}

void ConstantErrors::shiftSupply(double change) noexcept {
  fit_.shift(kSupply, change);
  estimate_[kSupply] += change;
}

void ConstantErrors::setConsidered(int constant, double deviation) noexcept {
  if (prior_[constant] == deviation) return;
  prior_[constant] = deviation;
  addConsidered();
  root_ = covarianceRoot(moment_);
}

void ConstantErrors::stepZero(double variance) noexcept {
  stepped_ += variance;
  moment_(kZero, kZero) += variance;
  root_ = covarianceRoot(moment_);
}

ConstantErrors::ConstantErrors(const Vector& prior, double zero_std) noexcept : prior_(prior), zero_given_(zero_std) {
  fit_.begin(prior_);
  addConsidered();
  moment_(kZero, kZero) = square(zero_given_);
  root_ = covarianceRoot(moment_);
}

void ConstantErrors::addConsidered() noexcept {
  for (int i = 0; i < kTable; ++i)
    if (kUnknowns[static_cast<std::size_t>(i)].use == Unknown::Use::kConsidered) moment_(i, i) = square(prior_[i]);
}

void ConstantErrors::learn(double innovation, double variance, const Row& by_error) noexcept {
  const Eigen::Matrix<double, 1, kTable> by_table = by_error.head<kTable>().cast<double>();
  const double weight = fit_.learn(innovation, variance, by_table);
  score_by_hammer_ += (weight * by_table.head<kPlace>().transpose())
                          .lazyProduct(by_error.middleCols<kMachineColumns>(kTable).cast<double>());
}

void ConstantErrors::endTurn(double growth, double count) noexcept {
  ++turns_;
  Matrix covariance = Matrix::Zero();
  covariance.topLeftCorner<kPlace, kPlace>() = fit_.covarianceOfFirst<kPlace>();
  const auto ofSensor = [&](int i) {  // variance of a sensor error's estimate, for a correct hammer
    return square(kUnknowns[static_cast<std::size_t>(i)].unmodelled) + growth * covariance(i, i);
  };
  zero_looks_ = covariance.row(kZero).dot(fit_.score());
  zero_is_seen_ = exceeds(zero_looks_, ofSensor(kZero), gate::kUsual);
  if (turns_ == kFirstTurns) {
    fit_.begin(prior_);
    score_by_hammer_.setZero();
  }
  if (turns_ < kTurnsToKnow) return;
  for (int i = 0; i < kTable; ++i)
    if (kUnknowns[static_cast<std::size_t>(i)].use == Unknown::Use::kTakenUp)
      covariance(i, i) = 1.0 / fit_.information()(i, i);
  estimate_ = covariance * fit_.score();
  const Eigen::Matrix<double, kPlace, 1> by_hammer =
      (covariance.topLeftCorner<kPlace, kPlace>() * score_by_hammer_).rowwise().squaredNorm();
  // doubt: variance of an estimate of b, by which its square exceeds b^2; certain: root of the remainder.
  Vector uncertain = Vector::Zero(), certain = Vector::Zero();
  double share = 0.0;  // largest certain part of an estimate's square
  for (int i = 0; i < kPlace; ++i) {
    const double variance = growth * covariance(i, i);
    uncertain[i] = ofSensor(i) + by_hammer[i];
    deviation_[i] =
        std::sqrt(uncertain[i] + (square(kUnmodelledDeviations) - 1.0) * variance + square(kUnmodelledCounts * count));
    const double excess = square(estimate_[i]) - uncertain[i];
    certain[i] = excess > 0.0 ? std::copysign(std::sqrt(excess), estimate_[i]) : 0.0;
    if (excess > 0.0) share = std::max(share, excess / square(estimate_[i]));
  }
  moment_ = growth * covariance + certain * certain.transpose();
  // A certain error counts in full; an uncertain one adds little.
  moment_.diagonal() += share * share * uncertain;
  moment_(kZero, kZero) += stepped_ + square(zeroNotLinear());
  if (!zeroIsShown()) moment_(kZero, kZero) = std::max(moment_(kZero, kZero), square(zero_given_));
  addConsidered();
  root_ = covarianceRoot(moment_);
  fit_.fade(1.0 - 1.0 / look_back::kManyTurns);
  score_by_hammer_ *= 1.0 - 1.0 / look_back::kManyTurns;
}

}  // namespace hammer_loads
