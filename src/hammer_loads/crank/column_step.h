/// Effect of the hammer's constants on the crank within a step.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// A step keeps h = sqrt(M) w, M = Jc + J, but for what the torque adds (crank_dynamics.h). A column dJ of the links'
/// inertia makes of the speed at its start another h, and of h at its end another speed: w/2 (dJ/M at the start less
/// dJ/M at the end), the torque's part aside, for which it counts whole. At a blow, where M jumps, two such steps meet.
/// The columns are of first order in the step.
class ColumnStep {
 public:
  using Columns = Eigen::Matrix<double, 1, kMachineColumns>;

  /// Before the step. inertia: Jc [kg m2].
  ColumnStep(const ShaftModel& model, const ShaftState& from, double inertia, const ShaftLoad& load) noexcept
      : start_(model.columns(from.position.angle)),
        offset_(from.position.angle.offset),
        m_(inertia + load.inertia),
        weight_(load.weight_torque) {}
  /// Changes of the speed [rad/s] at the end of the step by the columns. torque: on the crank beside its links [N m];
  /// struck: it passed a blow.
  Columns ofSpeed(const ShaftModel& model, const ShaftState& to, double inertia, const ShaftLoad& load, double torque,
                  double dt, bool struck) const noexcept {
    const MachineColumns::OnShaft end = model.columns(to.position.angle);
    const double m = inertia + load.inertia;
    Columns relative = start_.row(0) / m_ - end.row(0) / m;  // of h kept
    double begin = 0.5;                                      // part of the step
    if (struck) {
      const CrankAngle before{0.0, Side::kBeforeBlow}, after{0.0, Side::kAfterBlow};
      relative += model.columns(after).row(0) / (inertia + model(after).inertia) -
                  model.columns(before).row(0) / (inertia + model(before).inertia);
      begin = std::clamp(-offset_ / (to.speed * dt), 0.0, 1.0);
    }
    return 0.5 * to.speed * relative + begin * dt * driven(start_, torque + weight_, m_) +
           (1.0 - begin) * dt * driven(end, torque + load.weight_torque, m);
  }

 private:
  static Columns driven(const MachineColumns::OnShaft& at, double torque, double m) noexcept {
    return (at.row(2) - (torque / m) * at.row(0)) / m;
  }

  MachineColumns::OnShaft start_;
  double offset_, m_, weight_;  ///< at the step's start: angle [rad], M [kg m2], the links' weight on the crank [N m]
};

/// of_speed: what has come of the speed within a step of dt [s], evenly; by_constant: a belief's.
template <Eigen::Index angle, Eigen::Index speed, typename Effect>
void addWithin(const ColumnStep::Columns& of_speed, double dt, Effect& by_constant) noexcept {
  by_constant.row(speed).template tail<kMachineColumns>() += of_speed;
  by_constant.row(angle).template tail<kMachineColumns>() += 0.5 * dt * of_speed;
}

}  // namespace hammer_loads
