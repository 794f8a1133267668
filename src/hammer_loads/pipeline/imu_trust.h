/// Check that an inertial unit can sit on the hull as the parameters describe it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/together.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// In the mean of 2 s the hull does not move: a unit measures the weight by the joint angles, but for the part of the
/// blows that it misses, up to 2 m/s2. No boom turns by 3 rad/s, root mean square, while it holds a hammer: near a
/// resonance by 0.5. Readings in g, degrees per second or with an axis the wrong way are therefore recognised; 20 deg
/// of mounting are not.
class ImuTrust {
 public:
  /// Takes a reading in axes of hammer_hull: specific force [m/s2], turning rate [rad/s], step since the last one [s].
  void follow(const Eigen::Vector3d& force, const Eigen::Vector3d& rate, double step) noexcept {
    const bool same = force == force_ && rate == rate_;
    varies_ = varies_ || (!same && mean_.count() > 0.0);
    force_ = force, rate_ = rate;
    if (!(step > 0.0)) return;
    const double lasts = std::min(step, look_back::kLongestReading);
    same_for_ = same ? std::min(same_for_ + lasts, kFrozen) : 0.0;
    mean_.add(force, lasts);
    const Eigen::Vector3d off = force - mean();
    power_.add(Eigen::Vector3d(square(off.x()), square(off.z()), square(rate.y())), lasts);
    if (step >= kSameInstant) turning_.add(square((rate.y() - last_rate_) / step), lasts), last_rate_ = rate.y();
    rate_square_.add(rate.squaredNorm(), lasts);
  }
  /// Judges after a reading; weight: by the joint angles, in the plane of the hull. A single damaged angle affects only
  /// a part of the mean.
  void judge(const Gravity& weight, double step) noexcept {
    if (step > 0.0)
      off_.add({force_.x() + weight.x, force_.z() + weight.z}, std::min(step, look_back::kLongestReading));
    if (off_.count() < look_back::kSomeTurns) return;
    off_weight_.follow(off_.mean().norm() / std::hypot(weight.x, weight.z));
    is_lost_ = isFrozen() || turnsTooFast() || off_weight_.isEngaged();
  }
  /// Mean squares of the hull's acceleration in its plane and of its rotation: along x and z [m2/s4], rate [rad2/s2],
  /// its derivative [rad2/s4].
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
  static constexpr double kMostPart = 0.5;             // part of the weight
  static constexpr double kMostRate = 3.0;             // [rad/s]
  static constexpr double kFrozen = look_back::kTurn;  // duration of one unchanged reading

  RunningMean<Eigen::Vector3d> mean_{look_back::kTenTurns, Eigen::Vector3d::Zero()},
      power_{look_back::kTenTurns, Eigen::Vector3d::Zero()};
  RunningMean<> rate_square_{look_back::kTenTurns}, turning_{look_back::kTenTurns};
  RunningMean<Eigen::Vector2d> off_{look_back::kTenTurns, Eigen::Vector2d::Zero()};  ///< from the weight
  Latch off_weight_{kMostPart};
  double same_for_{}, last_rate_{};
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), rate_ = force_;  ///< force and rate of the last reading
  bool varies_{}, is_lost_{};
};

}  // namespace hammer_loads
