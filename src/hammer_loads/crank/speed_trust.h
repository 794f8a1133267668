/// Check that measured speeds belong to the instants of their angles: lag, scale and memory of their errors.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// A drive filters its speeds, whose errors are then correlated. Where stamps jitter, a single angle gives little
/// information, and late speeds would bias the estimate. A speed is therefore compared with the estimate that does not
/// contain it:
///
///     measured = (1 + scale) y + noise,  lag y' = speed - y,
///
/// less the effect of lag and scale of earlier speeds on the estimate. Lag and scale are estimated by least squares
/// (Gauss-Newton, one step per turn) over some turns, with their priors. The residuals of a revolution have a variance
/// and an autocorrelation rho from one sample to the next; n such errors carry as much information as n (1 - rho)/(1 +
/// rho) independent ones. Speeds are weighted by the uncertainty of lag and scale (GaussianBelief, constant_errors.h)
/// until it is negligible. If lag or scale is significant, speeds are used at the start only.
class SpeedTrust {
 public:
  /// Restarts after a discontinuity.
  void restart() noexcept { begun_ = false; }
  /// A measured speed, and the estimate without it.
  struct Comparison {
    double measured{};      ///< [rad/s]
    double speed{};         ///< [rad/s]
    double acceleration{};  ///< acceleration at that instant [rad/s2]
    double by_lag{};        ///< change of `speed` by a lag of the speeds used so far [rad/s2]
    double by_scale{};      ///< change of `speed` by their scale [rad/s]
    double jump{};          ///< jump of the speed by a blow since the sample before [rad/s]
    double variance{1.0};   ///< variance of the difference of both speeds, > 0 [rad2/s2]
  };
  /// Reduction of the present speed by a lag of kLag, over kLag [rad/s2]; dt, acceleration, jump: as below.
  double lateBy(double dt, double acceleration, double jump) const noexcept;
  /// Adds a speed and the estimate without it, dt [s] > 0 after the sample before.
  void follow(double dt, const Comparison& now) noexcept;
  /// Updates lag and scale once a revolution.
  void endTurn() noexcept;

  /// Returns true if speeds may be used.
  bool isTrusted() const noexcept { return !lags() && !isOutOfScale(); }
  bool isKnown() const noexcept { return turns_ >= look_back::kTurnsToKnow; }  ///< lag and scale are known
  /// Returns true if both are known to be negligible.
  bool areGood() const noexcept { return isKnown() && are_good_; }
  bool lags() const noexcept { return isKnown() && lags_.isEngaged(); }
  bool isOutOfScale() const noexcept { return isKnown() && out_of_scale_.isEngaged(); }
  double lag() const noexcept { return lag_; }                      ///< > 0: late [s]
  double lagDeviation() const noexcept { return deviation_[0]; }    ///< [s]
  double scale() const noexcept { return scale_; }                  ///< measured over true speed, less 1 [-]
  double scaleDeviation() const noexcept { return deviation_[1]; }  ///< [-]

 private:
  static constexpr double kLag = kUnknowns[indexOfUnknown("speed lag")].prior;  ///< [s]
  static constexpr double kScale = kUnknowns[indexOfUnknown("speed scale")].prior;

  /// Residual of a speed over its expected standard deviation, and its derivatives by lag and scale.
  using Row = Eigen::Vector3d;
  Row last_{Row::Zero()};
  Eigen::Matrix3d same_{Eigen::Matrix3d::Zero()}, next_{same_};  ///< sums of products of rows; of neighbouring rows
  int count_{};                                                  ///< number of rows in these sums
  double square_{};                                              ///< mean square of the residuals, last revolution
  Eigen::Matrix2d information_{Eigen::Matrix2d::Zero()};         ///< information on lag and scale, by revolutions
  Eigen::Vector2d score_{Eigen::Vector2d::Zero()};
  double scatter_{}, seen_turns_{};  ///< squares explained by each revolution's own fit, summed; number of revolutions
  Eigen::Vector2d deviation_{Eigen::Vector2d::Zero()};
  double lag_{}, scale_{};
  Latch lags_{1.0}, out_of_scale_{1.0};
  bool begun_{}, are_good_{};
  double behind_{}, by_lag_{};  ///< at the last sample: speed - y [rad/s], and its derivative by the lag
  double late_{};               ///< lateBy() at the last sample [rad/s2]
  double acceleration_{};       ///< acceleration at the last sample [rad/s2]
  int turns_{};
};

}  // namespace hammer_loads
