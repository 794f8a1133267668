/// A blow that has been struck and is being measured.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/blow_deviation.h"

namespace hammer_loads {

/// The samples after a blow determine its factor: it is estimated once the crank has turned by a further radian, or
/// earlier if the crank stops, restarts or strikes again.
class PendingBlow {
 public:
  /// time: of the blow [s]; speed of the crank when it reaches the dead centre [rad/s], its rate there [1/s]
  /// (acceleration over speed), and how far it may be off.
  void begin(double time, const CrankPosition& at, double speed, double rate, const CrankUncertainty& doubt) noexcept {
    waiting_ = true;
    time_ = time;
    position_ = at;
    blow_ = {};
    hull_speed_.reset();
    early_ = false;
    published_ = withheld_ = 0;
    blow_.speed = speed;
    blow_.speed_std = std::sqrt(doubt.own(CrankUncertainty::kSpeed, CrankUncertainty::kSpeed));
    columns_.row(0) = doubt.speedAtAngle(rate);
  }
  bool isWaiting() const noexcept { return waiting_; }
  bool isEarly() const noexcept { return early_; }  ///< the tool was met before the dead centre
  /// Discards the passage, which was no blow.
  void drop() noexcept { waiting_ = false; }
  /// Takes the estimate at the latest sample; call after begin() and then at each sample that continues.
  void follow(const BlowFactor& factor) noexcept {
    blow_.factor = factor.mean;
    blow_.factor_std = factor.deviation;
    blow_.drive_inertia = factor.drive_inertia;
    blow_.inertia_std = factor.inertia_std;
    early_ = factor.early;
    columns_.bottomRows<2>() = factor.by_constant;
  }
  /// Errors of take() by independent errors of constants: speed [rad/s], factor [-], inertia (relative).
  BlowColumns columns() const noexcept {
    BlowColumns columns = columns_;
    if (early_) columns.row(0) = (columns_.row(0) - (blow_.speed / blow_.factor) * columns_.row(1)) / blow_.factor;
    return columns;
  }
  /// Errors of crankSpeedAfter() by constants [rad/s].
  Eigen::Matrix<double, 1, ConstantErrors::kSize> columnsAfter() const noexcept {
    if (early_) return columns_.row(0);
    return blow_.factor * columns_.row(0) + blow_.speed * columns_.row(1);
  }
  /// Counts a sample after the blow as published or withheld. If most are withheld, as with angles in degrees, the blow
  /// is not confirmed.
  void count(bool published) noexcept { ++(published ? published_ : withheld_); }
  bool isWithheld() const noexcept { return withheld_ > published_; }
  /// Returns true if the crank has turned far enough or the time is over.
  bool isMeasured(double time, const CrankPosition& now) const noexcept {
    return waiting_ && (difference(now, position_) > kFarEnough || time - time_ > look_back::kTurn);
  }
  /// The hull's own velocity at the striking point along z, at the blow [m/s]; nothing: not measured.
  void setHullSpeed(double speed) noexcept { hull_speed_ = speed; }
  const std::optional<double>& hullSpeed() const noexcept { return hull_speed_; }
  double time() const noexcept { return time_; }  ///< time of the blow [s]
  double crankSpeedAfter() const noexcept { return (early_ ? 1.0 : blow_.factor) * blow_.speed; }  ///< [rad/s]
  CrankBlow take() noexcept {
    waiting_ = false;
    if (!early_) return blow_;
    CrankBlow blow = blow_;
    blow.speed /= blow.factor;
    blow.speed_std = std::hypot(blow_.speed_std, blow.speed * blow.factor_std) / blow.factor;
    return blow;
  }

 private:
  static constexpr double kFarEnough = 1.0;  // [rad]: some 50 ms
  bool waiting_{};
  double time_{};
  CrankPosition position_;
  CrankBlow blow_;
  BlowColumns columns_{BlowColumns::Zero()};
  std::optional<double> hull_speed_;
  int published_{}, withheld_{};
  bool early_{};  ///< the tool was met before the dead centre
};

}  // namespace hammer_loads
