/// What the constants of the hammer do to the crank within a step.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// The step keeps h = sqrt(M) w, M = Jc + J, but for the torque over sqrt(M) (crank_dynamics.h): a column dJ of the
/// links' inertia is dJ w/(2 M) of the speed at the step's start, which the step carries on, and is taken back at its
/// end; a column of the torque and of 1/sqrt(M) acts in between. Of first order in the step.
class ColumnStep {
 public:
  using Columns = Eigen::Matrix<double, 1, kMachineColumns>;

  /// inertia: Jc, or that of the crank's side of a coupling [kg m2].
  ColumnStep(const ShaftModel& model, const ShaftState& from, double inertia, const ShaftLoad& load) noexcept
      : model_(model), from_(from.position.angle), start_(model.columns(from_)) {
    at_start_ = (0.5 * from.speed / (inertia + load.inertia)) * start_.row(0);
  }
  /// What the columns are worth as speed where the step starts.
  const Columns& atStart() const noexcept { return at_start_; }
  /// Of what the step made of it, and of the columns within the step. torque: on the crank beside its links [N m].
  void end(const ShaftState& to, double inertia, const ShaftLoad& load, double torque, double dt) noexcept {
    const MachineColumns::OnShaft end = model_.columns(to.position.angle);
    const double m = inertia + load.inertia;
    const Columns undone = (0.5 * to.speed / m) * end.row(0);
    const Columns inertias = 0.5 * (start_.row(0) + end.row(0)), torques = 0.5 * (start_.row(2) + end.row(2));
    const Columns driven = (dt / m) * (torques - (0.5 * (torque + load.weight_torque) / m) * inertias);
    speed_ = driven - undone;
    angle_ = 0.5 * dt * (driven - undone - at_start_);
  }
  const Columns& speed() const noexcept { return speed_; }
  const Columns& angle() const noexcept { return angle_; }

 private:
  const ShaftModel& model_;
  CrankAngle from_;
  MachineColumns::OnShaft start_;
  Columns at_start_, speed_, angle_;
};

}  // namespace hammer_loads
