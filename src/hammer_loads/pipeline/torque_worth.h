/// Check whether the standard deviations of the joint torques exceed the torques.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Ratio of each joint torque's standard deviation to the torque without the weight, root mean squares over a
/// revolution. The worst joint has 0.02 to 0.34 if the sensors fit the model, 1.5 to 6 with an IMU alone on rock and
/// 0.4 to 6 with pressures alone over a bus (doc/accuracy.md). Torques are useless where this ratio is large and
/// sensors are the cause. The verdict is formed once per revolution and holds until the hammer stops.
class TorqueWorth {
 public:
  /// Adds a sample [N m]: total loads on the joints, the part of the weight, standard deviation. by_sensors: pressures
  /// show the torques, or an IMU shows a force that is not measured. alone: the loads rest on an IMU without pressures;
  /// proven: it has shown that no rock bears the hull.
  void add(const JointVector& total, const JointVector& weight, const JointVector& deviation, bool by_sensors,
           bool alone, bool proven) noexcept {
    alone_ = alone;
    unproven_ = alone && !proven && turns_alone_ < kTurnsToProve;
    if (load_.size() != total.size()) load_ = deviation_ = JointVector::Zero(total.size());
    load_ += (total - weight).cwiseAbs2();
    deviation_ += deviation.cwiseAbs2();
    by_sensors_ = by_sensors_ || by_sensors;
  }
  /// Ends a revolution. A sum over a time in which the hammer stood changes nothing.
  void endTurn(StampNs stamp) noexcept {
    turns_alone_ = alone_ ? turns_alone_ + 1 : 0;
    if (isRecent(std::exchange(ended_, stamp), stamp)) {
      ratio_ = worst();
      useless_.follow(by_sensors_ ? ratio_ : 0.0);
    }
    load_.setZero(), deviation_.setZero();
    by_sensors_ = false;
  }
  /// Returns the ratio of the worst joint in the last revolution [-]; 0 before.
  double ratio() const noexcept { return ratio_; }
  /// Returns true while an IMU alone has yet to show that no rock bears the hull. After kTurnsToProve revolutions it
  /// has shown the rock as a force that is not measured, or has not found any.
  bool isUnproven() const noexcept { return unproven_; }
  bool isUseless(StampNs stamp) const noexcept {
    return (useless_.isEngaged() || unproven_) && isRecent(ended_, stamp);
  }

 private:
  static constexpr int kTurnsToProve = 15;  ///< the rock shows within 12
  static constexpr double kUseless = 0.6;
  // Limit: kUseless
  static constexpr double kSmall = 0.1;  ///< part of the largest joint torque below which a joint is not judged

  static bool isRecent(StampNs turn, StampNs stamp) noexcept { return seconds(stamp - turn) < look_back::kFiveTurns; }
  double worst() const noexcept {
    double worst = 0.0;
    for (Eigen::Index j = 0; j < load_.size(); ++j)
      if (load_[j] > square(kSmall) * load_.maxCoeff()) worst = std::max(worst, deviation_[j] / load_[j]);
    return std::sqrt(worst);
  }

  JointVector load_, deviation_;  ///< sums of squares [N2 m2]
  bool by_sensors_{}, alone_{}, unproven_{};
  int turns_alone_{};
  StampNs ended_{};
  double ratio_{};
  Latch useless_{kUseless};
};

}  // namespace hammer_loads
