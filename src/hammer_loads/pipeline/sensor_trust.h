/// Plausibility of IMU and pressures while the hammer works.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// On average over 2 s the hull does not move. A unit then measures the weight that follows from the joint angles,
/// apart from missed parts of the blows, up to 2 m/s2. No boom rotates at 3 rad/s, root mean square, while it holds a
/// hammer; near a resonance it reaches 0.5. Readings in g, degrees per second or with a reversed axis are therefore
/// recognised, mounting errors of 20 deg are not.
class ImuTrust {
 public:
  /// Takes a reading in axes of hammer_hull: specific force [m/s2], turning rate [rad/s], step since the last one [s].
  void follow(const Eigen::Vector3d& force, const Eigen::Vector3d& rate, double step) noexcept {
    const bool same = force == force_ && rate == rate_;
    varies_ = varies_ || (!same && mean_.count() > 0.0);
    force_ = force, rate_ = rate;
    if (!(step > 0.0)) return;
    const double lasts = std::min(step, look_back::kHalfTurn);
    same_for_ = same ? std::min(same_for_ + lasts, kFrozen) : 0.0;
    mean_.add(force, lasts);
    const Eigen::Vector3d off = force - mean();
    power_.add(Eigen::Vector3d(square(off.x()), square(off.z()), square(rate.y())), lasts);
    if (step >= kSameInstant) turning_.add(square((rate.y() - last_rate_) / step), lasts), last_rate_ = rate.y();
    rate_square_.add(rate.squaredNorm(), lasts);
  }
  /// Judges after a reading. weight: from the joint angles, in the plane of the hull. A single damaged angle affects
  /// only a part of the mean.
  void judge(const Gravity& weight, double step) noexcept {
    if (step > 0.0) off_.add({force_.x() + weight.x, force_.z() + weight.z}, std::min(step, look_back::kHalfTurn));
    if (off_.count() < look_back::kSomeTurns) return;
    off_weight_.follow(off_.mean().norm() / std::hypot(weight.x, weight.z));
    is_lost_ = isFrozen() || turnsTooFast() || off_weight_.isEngaged();
  }
  /// Returns mean squares of the hull's acceleration in its plane and of its rotation: along x and z [m2/s4], rate
  /// [rad2/s2], its derivative [rad2/s4].
  Eigen::Vector4d power(const Gravity& weight) const noexcept {
    const Eigen::Vector3d& power = power_.mean();
    return {power.x() + square(mean().x() + weight.x), power.y() + square(mean().z() + weight.z), power.z(),
            turning_.mean()};
  }
  /// Returns true if there were readings for long enough.
  bool isKnown() const noexcept { return mean_.count() >= look_back::kSomeTurns; }
  bool isLost() const noexcept { return is_lost_; }
  bool turnsTooFast() const noexcept { return rate_square_.mean() > square(kMostRate); }
  bool isFrozen() const noexcept { return varies_ && same_for_ == kFrozen; }  ///< readings do not change any more
  const Eigen::Vector3d& mean() const noexcept { return mean_.mean(); }       ///< specific force [m/s2]
  double rate() const noexcept { return std::sqrt(rate_square_.mean()); }     ///< root mean square [rad/s]

 private:
  static constexpr double kMostPart = 0.5;  // part of the weight
  static constexpr double kMostRate = 3.0;  // [rad/s]
  // Limit: kMostPart, kMostRate
  static constexpr double kFrozen = look_back::kTurn;  // duration of one unchanged reading

  RunningMean<Eigen::Vector3d> mean_{look_back::kTenTurns, Eigen::Vector3d::Zero()},
      power_{look_back::kTenTurns, Eigen::Vector3d::Zero()};
  RunningMean<> rate_square_{look_back::kTenTurns}, turning_{look_back::kTenTurns};
  RunningMean<Eigen::Vector2d> off_{look_back::kTenTurns, Eigen::Vector2d::Zero()};  ///< deviation from the weight
  Latch off_weight_{kMostPart};
  double same_for_{}, last_rate_{};
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), rate_ = force_;  ///< force and rate of the last reading
  bool varies_{}, is_lost_{};
};

/// Rock pushes on the hull along the tool. The residual of three cylinders' forces beyond weight, motion and blows is a
/// load on the tip in its plane. Its mean over 2 s across the tool and about its axis must be small. Pressures in bar
/// and exchanged chambers or cylinders cause 13 to 220 % of the weight there, correct ones 4 %. A lag of their stamps
/// has no effect on the mean. A delay in the boom's vibration is accepted as that of a hose. Pressures that are later
/// than any hose makes them and do not fit the model are not used for a while.
class PressureTrust {
 public:
  /// Takes loads on the tip in its axes. beyond: measured minus modelled load; weight: load of the weight; arm: from D
  /// to the tool [m]; step: since the last call [s].
  void follow(const Wrench& beyond, const Wrench& weight, double arm, double step) noexcept {
    if (!(step > 0.0) || !std::isfinite(beyond.force.x() + beyond.force.z() + beyond.torque.y())) return;
    mean_.add({beyond.force.x(), beyond.force.z(), beyond.torque.y() - arm * beyond.force.z()},
              std::min(step, look_back::kHalfTurn));
    if (mean_.count() < look_back::kSomeTurns) return;
    const double size = std::abs(along()) + std::sqrt(square(weight.force.x()) + square(weight.force.z()));
    const double off = std::max(std::abs(across()) / kAcross, std::abs(turning()) / (kTurning * arm)) / size;
    lost_.follow(off);
  }
  /// Takes the delay of the stamps in the boom's vibration [s]. misfit: ModeIdentifier::oilInnovationRatio().
  void followDelay(double delay, double misfit, double step) noexcept {
    late_left_ -= step;
    beyond_for_ = delay > kLongestHose && misfit > mismatch::kContradicts ? beyond_for_ + step : 0.0;
    if (beyond_for_ > look_back::kHalfTurn) late_by_ = delay, late_left_ = kUntilTriedAgain;
  }
  bool isLate() const noexcept { return late_left_ > 0.0; }
  double lateBy() const noexcept { return late_by_; }  ///< delay when it was detected [s]
  bool isLost() const noexcept { return lost_.isEngaged() || isLate(); }
  /// Returns the mean load on the tip that rock cannot cause; rock acts along the tool, with at least least_force [N].
  /// It shows that pressures, lengths or masses are wrong.
  Wrench notOfRock(double arm, double least_force) const noexcept {
    const double not_rock = along() < least_force ? along() : 0.0;
    return {{across(), 0.0, not_rock}, {0.0, turning() + arm * not_rock, 0.0}};
  }
  double across() const noexcept { return mean_.mean()[0]; }  ///< mean [N]
  double along() const noexcept { return mean_.mean()[1]; }   ///< [N]

 private:
  static constexpr double kAcross = 0.1,
                          kTurning = 0.3;           // parts of the sum of load along the tool and weight; with its arm
  static constexpr double kLongestHose = 8e-3;      ///< time constant [s]
  static constexpr double kUntilTriedAgain = 60.0;  ///< [s]
  // Limit: kAcross, kTurning, kLongestHose, kUntilTriedAgain

  double turning() const noexcept { return mean_.mean()[2]; }

  RunningMean<Eigen::Vector3d> mean_{look_back::kTenTurns, Eigen::Vector3d::Zero()};
  Latch lost_{1.0};
  double beyond_for_{}, late_left_{}, late_by_{};  ///< [s]
};

}  // namespace hammer_loads
