/// How the crank moves when nobody measures it: the mechanism's own equation of motion.
#pragma once

#include <Eigen/Core>

#include "hammer_loads/crank/crank_state.h"
#include "hammer_loads/linkage/shaft_load.h"

namespace hammer_loads {

/// Links, weight and motion of the hull as the shaft feels them; refers to the mechanism, which must outlive it.
class ShaftModel {
 public:
  ShaftModel(const Mechanism& mechanism, Level level) : mechanism_(&mechanism), level_(level) {}
  void setHullMotion(const HullMotion& hull) noexcept { hull_ = hull; }
  const HullMotion& hullMotion() const noexcept { return hull_; }
  ShaftLoad operator()(CrankAngle angle) const noexcept { return shaftLoad(*mechanism_, level_, angle, hull_); }

 private:
  const Mechanism* mechanism_;
  Level level_;
  HullMotion hull_;
};

/// Everything that decides the crank's motion.
struct ShaftState {
  CrankPosition position;
  double speed{};          ///< w [rad/s]
  double torque{};         ///< net drive torque tau on the crank [N m]
  double drive_inertia{};  ///< Jc: motor, flywheel and whatever turns with the crank [kg m2]
};

/// w' = (tau + weight - Jc alpha - J'/2 w^2)/(Jc + J) [rad/s2], weight and hull's motion in one (model.md 3, 6).
double acceleration(const ShaftLoad& load, const ShaftState& state) noexcept;

/// Order of the shaft's variables in matrices: angle, speed, torque, logarithm of the drive inertia (which keeps it
/// positive and makes its uncertainty relative).
using ShaftMatrix = Eigen::Matrix4d;

/// d(angle, speed after)/d(angle, speed, torque, logarithm of drive inertia before); torque and inertia stay.
using ShaftTransition = Eigen::Matrix<double, 2, 4>;

/// Advances the state by dt [s] (negative: back in time) with constant torque and inertia, through the blow if it lies
/// in between (there the speed is continuous and the acceleration jumps). `load` is the model's at the state's angle,
/// before and after the call.
///
/// Integrates h = sqrt(Jc + J) w, half the square of which is the kinetic energy: its rate, the torques over
/// sqrt(Jc + J), has no term with the transfer function's derivative, so its linearisation needs none of third order.
/// Runge-Kutta of order 4, steps of at most 0.05 rad: error of a free turn below 1e-7 of the energy; linearisation of
/// order 2 per step, within 1 % of finite differences at 1 kHz (test).
ShaftTransition advance(const ShaftModel& model, double dt, ShaftState& state, ShaftLoad& load) noexcept;

}  // namespace hammer_loads
