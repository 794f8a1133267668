/// Rates of crank and motor on the two sides of a flexible coupling, and their derivatives.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// Crank angle from the blow, h = sqrt(Jk + J) w, twist and motor speed within one half turn: rates of these have no
/// derivative of the links' inertia, so that their linearisation needs none of second order.
using FlexiblePath = Eigen::Vector4d;
enum FlexiblePathRow : Eigen::Index { kPathOffset, kPathH, kPathTwist, kPathMotor };
using FlexiblePathMatrix = Eigen::Matrix4d;
/// Columns: torque of the motor, logarithms of drive inertia, of the coupling's stiffness, odds and damping.
using InputMatrix = Eigen::Matrix<double, 4, 5>;

/// On one side of the blow, with a torque.
struct FlexibleShaft {
  const ShaftModel& model;
  CouplingLaw law;
  Side side;
  double torque;

  FlexiblePath rate(const FlexiblePath& at, const ShaftLoad& load) const noexcept {
    const double inv_root = 1.0 / std::sqrt(law.crank_inertia + load.inertia), speed = at[kPathH] * inv_root;
    const double moment = law.moment(at[kPathTwist], at[kPathMotor], speed);
    return {speed, (moment + load.weight_torque - law.crank_inertia * load.hull_acceleration) * inv_root,
            at[kPathMotor] - speed, (torque - moment) / law.motor_inertia - load.hull_acceleration};
  }
  /// first: the rate at the start.
  FlexiblePath after(const FlexiblePath& start, const FlexiblePath& first, double dt) const noexcept {
    const auto rate_at = [&](const FlexiblePath& at) { return rate(at, model.withoutSlopes({at[kPathOffset], side})); };
    const FlexiblePath k2 = rate_at(start + 0.5 * dt * first);
    const FlexiblePath k3 = rate_at(start + 0.5 * dt * k2);
    const FlexiblePath k4 = rate_at(start + dt * k3);
    return start + dt / 6.0 * (first + 2.0 * (k2 + k3) + k4);
  }
};

/// Derivatives of the rates of (angle, h, motor's angle, motor's speed) by these and by the inputs.
struct LinearisedFlexible {
  FlexiblePathMatrix by_path;
  InputMatrix by_input;
};

/// load: the model's at that place.
LinearisedFlexible linearised(const FlexibleShaft& shaft, const FlexiblePath& at, const ShaftLoad& load) noexcept;

}  // namespace hammer_loads
