/// Plausibility of measured pressures for a hammer on rock or hanging free.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// Rock pushes on the hull along the tool. The residual of three cylinders' forces beyond weight, motion and blows is a
/// load on the tip in its plane, whose mean over 2 s across the tool and about its axis must be small. Pressures in bar
/// and exchanged chambers or cylinders cause 13 to 220 % of the weight there, correct ones 4 %; a lag of their stamps
/// has no effect on the mean. A delay by the boom's vibration is accepted as that of a hose. Pressures that are later
/// than any hose makes them, or that fit no delay, are not used for a while.
class PressureTrust {
 public:
  /// Loads on the tip, axes of the tip: measured beyond the model's, and of the weight; arm: from D to the tool [m];
  /// step since the last call [s].
  void follow(const Wrench& beyond, const Wrench& weight, double arm, double step) noexcept {
    if (!(step > 0.0) || !std::isfinite(beyond.force.x() + beyond.force.z() + beyond.torque.y())) return;
    mean_.add({beyond.force.x(), beyond.force.z(), beyond.torque.y() - arm * beyond.force.z()},
              std::min(step, look_back::kLongestReading));
    if (mean_.count() < look_back::kSomeTurns) return;
    const double size = std::abs(along()) + std::sqrt(square(weight.force.x()) + square(weight.force.z()));
    const double off = std::max(std::abs(across()) / kAcross, std::abs(turning()) / (kTurning * arm)) / size;
    lost_.follow(off);
  }
  /// delay: of their stamps, as the boom's vibration shows it [s]; misfit: ModeIdentifier::oilSurprise().
  void followDelay(double delay, double misfit, double step) noexcept {
    late_left_ -= step;
    beyond_for_ = delay > kLongestHose && misfit > mismatch::kContradicts ? beyond_for_ + step : 0.0;
    if (beyond_for_ > look_back::kHalfTurn) late_by_ = delay, late_left_ = kUntilTriedAgain;
  }
  bool isLate() const noexcept { return late_left_ > 0.0; }
  double lateBy() const noexcept { return late_by_; }  ///< delay when it was detected [s]
  bool isLost() const noexcept { return lost_.isEngaged() || isLate(); }
  /// Mean load on the tip that is not one of rock, which acts along the tool from least_force [N] on. It shows that
  /// pressures, lengths or masses are wrong.
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

  double turning() const noexcept { return mean_.mean()[2]; }

  RunningMean<Eigen::Vector3d> mean_{look_back::kTenTurns, Eigen::Vector3d::Zero()};
  Latch lost_{1.0};
  double beyond_for_{}, late_left_{}, late_by_{};  ///< [s]
};

}  // namespace hammer_loads
