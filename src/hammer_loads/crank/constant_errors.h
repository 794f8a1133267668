/// What of the innovations looks like a sensor that is not where it is said to be, or another supply.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "hammer_loads/estimation/constant_fit.h"
#include "hammer_loads/linkage/crank_angle.h"

namespace hammer_loads {

/// Errors b that stay. Of the crank sensor's place: reading = angle + b0 + b1 sin(angle) + b2 (cos(angle) - 1) [rad],
/// so that b0 alone says where the blow is; b1 and b2 are an eccentricity. b3 is that of the supply's stiffness, as the
/// filter has it, over SupplyLaw::unit. The filter knows beside its state what each of them does to it (Friedland's
/// separate-bias filter). An innovation is then its derivative by b times b, and noise: weighted least squares over
/// some minutes. b0 to b2 are seen, not corrected; b3 is taken up by the supply's law.
///
/// What the law leaves of a supply's torque looks a little like b0 to b2: with the shipped machine by 0.1 to 0.2 deg,
/// with jitter or 1024 counts by 0.4 deg, some three standard deviations. deviation() contains that. So b3 is estimated
/// as if the sensor's place were right: together they can hardly be separated.
class ConstantErrors {
 public:
  static constexpr int kPlace = 3, kSize = 5;    ///< the first kPlace are of the sensor's place
  static constexpr int kSupply = 3, kShare = 4;  ///< of the supply; of the motor, logarithm of the odds
  using Row = Eigen::Matrix<double, 1, kSize>;   ///< derivative of a number by b
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// share_deviation: standard, of the last one, which no innovation tells apart from the coupling's stiffness.
  explicit ConstantErrors(double share_deviation = 0.0) noexcept : share_variance_(share_deviation * share_deviation) {
    moment_(kShare, kShare) = share_variance_;
    forget();
  }

  /// d(reading)/db at a crank angle within half a turn of the blow [rad].
  static Row ofAngle(double offset) noexcept { return {1.0, sine(offset), cosine(offset) - 1.0, 0.0, 0.0}; }
  /// d(measured speed)/db there [1/s].
  static Row ofSpeed(double offset, double speed) noexcept {
    return {0.0, speed * cosine(offset), -speed * sine(offset), 0.0, 0.0};
  }

  /// innovation of an angle, its variance and its derivative by b.
  void learn(double innovation, double variance, const Row& by_error) noexcept {
    ++samples_;
    fit_.learn(innovation, variance, by_error);
  }
  /// Once a turn. growth: what variances are to be multiplied with; count: of the encoder [rad].
  void endTurn(double growth, double count) noexcept;

  /// The supply's stiffness has been changed by so much [SupplyLaw::unit].
  void takeSupply(double change) noexcept;
  /// 0 before some turns. deviation: of the sensor's place alone.
  const Vector& estimate() const noexcept { return estimate_; }
  const Vector& deviation() const noexcept { return deviation_; }
  /// Second moment of b, as far as the innovations show it: what an uncorrected b adds to the uncertainty.
  const Matrix& moment() const noexcept { return moment_; }

 private:
  void forget() noexcept;

  /// Within 0.1 %, |x| <= 3/4 of a turn: two parabolas.
  static double sine(double x) noexcept {
    const double part = x * (2.0 / kTwoPi), y = 4.0 * part * (1.0 - std::abs(part));
    return y * (0.775 + 0.225 * std::abs(y));
  }
  static double cosine(double x) noexcept { return sine(0.25 * kTwoPi - std::abs(x)); }

  double share_variance_;
  ConstantFit<kSize> fit_;
  Vector estimate_{Vector::Zero()}, deviation_{Vector::Zero()};
  Matrix moment_{Matrix::Zero()};
  int turns_{}, samples_{};  ///< samples: of this turn
};

}  // namespace hammer_loads
