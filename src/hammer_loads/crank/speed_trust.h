/// Whether measured speeds are of the instant that their angles are of: lag, scale and memory of their errors.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "hammer_loads/estimation/latch.h"

namespace hammer_loads {

/// A drive filters its speeds. Such an error is no noise: where stamps jitter the angles say little in a sample, and
/// speeds that are late pull the estimate with them. So a speed is compared with the estimate that does not know it:
///
///     measured = (1 + scale) y + noise,  lag y' = speed - y,
///
/// lag and scale by least squares (Gauss and Newton, a step a turn) over some turns. What is left has a variance and an
/// autocorrelation rho from one sample to the next; n such errors say as much as n (1 - rho)/(1 + rho) independent
/// ones. Speeds serve the start alone until lag and scale are known to be less than matters, and where they are not:
/// who takes them up cannot judge them. (No larger variance instead: a model that errs hangs together as well, and then
/// it is the speeds that put it right.)
class SpeedTrust {
 public:
  /// What came before does not continue.
  void restart() noexcept { begun_ = false; }
  /// A speed that was measured, and what the estimate has without it.
  struct Witness {
    double measured{};      ///< [rad/s]
    double speed{};         ///< [rad/s]
    double acceleration{};  ///< there [rad/s2]
    double jump{};          ///< of the speed by a blow since the sample before [rad/s]
  };
  /// dt [s], > 0, after the sample before.
  void follow(double dt, const Witness& now) noexcept;
  /// Once a turn.
  void endTurn() noexcept;

  /// They may be taken up.
  bool isTrusted() const noexcept { return turns_ >= kTurnsToKnow && are_good_; }
  bool lags() const noexcept { return turns_ >= kTurnsToKnow && lags_; }
  bool isOutOfScale() const noexcept { return turns_ >= kTurnsToKnow && out_of_scale_; }
  double lag() const noexcept { return lag_; }                      ///< > 0: late [s]
  double lagDeviation() const noexcept { return deviation_[0]; }    ///< [s]
  double scale() const noexcept { return scale_; }                  ///< measured over true speed, less 1 [-]
  double scaleDeviation() const noexcept { return deviation_[1]; }  ///< [-]

 private:
  static constexpr int kTurnsToKnow = 5;  // some 1 s at work. Guard: SpeedTrust.IsSilentBeforeItKnows

  Eigen::Matrix2d information_{Eigen::Matrix2d::Zero()};  ///< of lag and scale, unit variance
  Eigen::Vector2d score_{Eigen::Vector2d::Zero()}, deviation_{Eigen::Vector2d::Zero()};
  double lag_{}, scale_{};
  bool begun_{}, lags_{}, out_of_scale_{}, are_good_{};
  double behind_{}, by_lag_{};             ///< at the last sample: speed - y [rad/s], and its derivative by the lag
  double acceleration_{};                  ///< likewise
  double residual_{};                      ///< of the last sample
  double square_{}, product_{}, known_{};  ///< running means: of residual^2, of neighbours, of the estimate's variance
  int samples_{};
  int turns_{};
};

}  // namespace hammer_loads
