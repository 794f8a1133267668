/// A sample converted to the crank, with its noise.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// A measurement less its prediction.
struct Innovation {
  double value{};                                             ///< measured less predicted
  double total{};                                             ///< variance of the innovation
  double variance{};                                          ///< the measurement's part of that
  ConstantErrors::Row by_error{ConstantErrors::Row::Zero()};  ///< d(measured)/d(sensor's errors)

  double ratio() const noexcept { return value * value / total; }
  bool exceeds(double deviations) const noexcept { return hammer_loads::exceeds(value, total, deviations); }
  /// Logarithm of the likelihood, without a constant.
  double logLikelihood() const noexcept { return -0.5 * (ratio() + std::log(total)); }
};

struct WeighedSample {
  double angle{};               ///< from the nearest blow [rad]
  std::optional<double> speed;  ///< [rad/s]
  double angle_variance{};      ///< variance of count and noise [rad2]
  double timing_variance{};     ///< variance of the stamp [s2]
  double speed_variance{};      ///< variance of the speed's noise [rad2/s2]
  /// Variances of the constants that reduce the weight of a speed; empty: none.
  std::optional<ConstantErrors::Row> of_speed{};

  /// Variance of the angle about that at the stamp [rad2].
  double angleVariance(double speed_there) const noexcept {
    return angle_variance + speed_there * speed_there * timing_variance;
  }
  /// Returns true if its instant is less certain than the crank's place.
  bool isUnsureOfTime(double speed_there) const noexcept {
    return speed_there * speed_there * timing_variance > angle_variance;
  }
  Innovation ofAngle(const CrankBelief& belief) const noexcept;
  /// Innovation of the speed. Precondition: a speed was measured.
  Innovation ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept;
};

inline Innovation WeighedSample::ofAngle(const CrankBelief& belief) const noexcept {
  const double offset = belief.encoderOffset(), variance = angleVariance(belief.encoderSpeed());
  return {CrankAngle::wrapToPi(angle - offset), belief.encoderVariance(CrankBelief::kAngle) + variance, variance,
          ConstantErrors::ofAngle({offset, belief.encoderSpeed(), 0.0})};
}

/// An error of the stamp changes the speed by the acceleration.
inline Innovation WeighedSample::ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept {
  const ShaftState& state = belief.state;
  const ShaftLoad load = model(state.position.angle);
  const double change = acceleration(load, state);
  const double noise = speed_variance + square(change) * timing_variance;
  const auto by_error = ConstantErrors::ofSpeed({belief.encoderOffset(), belief.encoderSpeed(), change});
  const double of_constants =
      of_speed ? (by_error - belief.encoderByError(CrankBelief::kSpeed)).cwiseAbs2().dot(*of_speed) : 0.0;
  return {*speed - belief.encoderSpeed(), belief.encoderVariance(CrankBelief::kSpeed) + noise + of_constants, noise,
          by_error};
}

}  // namespace hammer_loads
