/// What the constants of the hammer do to the crank within a step.
#pragma once

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// The step keeps h = sqrt(M) w, M = Jc + J, but for the torque over sqrt(M) (crank_dynamics.h): a column dJ of the
/// links' inertia is dJ w/(2 M) of the speed at the step's start, which the step carries on, and is taken back at its
/// end; a column of the torque and of 1/sqrt(M) acts in between. Of first order in the step.
class ColumnStep {
 public:
  using Columns = Eigen::Matrix<double, 1, kMachineColumns>;

  /// by_constant: a belief's, whose first rows are angle and speed; before the step's transition. inertia: Jc, or that
  /// of the crank's side of a coupling [kg m2].
  template <typename Effect>
  ColumnStep(const ShaftModel& model, const ShaftState& from, double inertia, const ShaftLoad& load,
             Effect& by_constant) noexcept
      : start_(model.columns(from.position.angle)),
        at_start_((0.5 * from.speed / (inertia + load.inertia)) * start_.row(0)) {
    by_constant.row(1).template tail<kMachineColumns>() += at_start_;
  }
  /// After it. torque: on the crank beside its links [N m].
  template <typename Effect>
  void end(const ShaftModel& model, const ShaftState& to, double inertia, const ShaftLoad& load, double torque,
           double dt, Effect& by_constant) const noexcept {
    const MachineColumns::OnShaft end = model.columns(to.position.angle);
    const double m = inertia + load.inertia;
    const Columns undone = (0.5 * to.speed / m) * end.row(0);
    const Columns inertias = 0.5 * (start_.row(0) + end.row(0)), torques = 0.5 * (start_.row(2) + end.row(2));
    const Columns driven = (dt / m) * (torques - (0.5 * (torque + load.weight_torque) / m) * inertias);
    by_constant.row(1).template tail<kMachineColumns>() += driven - undone;
    by_constant.row(0).template tail<kMachineColumns>() += 0.5 * dt * (driven - undone - at_start_);
  }

 private:
  MachineColumns::OnShaft start_;
  Columns at_start_;  ///< what they are worth as speed where the step starts [rad/s]
};

}  // namespace hammer_loads
