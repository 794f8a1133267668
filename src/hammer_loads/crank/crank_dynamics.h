/// Motion of the crank between measurements: the mechanism's own equation of motion.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>

#include "hammer_loads/crank/crank_state.h"
#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"

namespace hammer_loads {

// A path is cut into smooth pieces that end at the blow.
constexpr double kMaxStepAngle = 0.04;  ///< largest crank angle in one piece [rad]
constexpr int kMaxSteps = 4096;         ///< bounds the work for absurd speeds; steps get longer beyond it
// Numerical: kMaxSteps
/// [rad/s]: a slower crank is moved by friction and stopped by the tool; nothing jumps there.
constexpr double kSlowCrank = 5.0;
/// [rad/s]: a crank that creeps over the blow has no defined instant of passing it.
constexpr double kCreeping = 1.0;
/// Largest number of passages of the blow in one direction. Beyond it both sides push the crank back to the other, and
/// it stays at the blow.
constexpr int kMostCreepingPasses = 8;

/// Piece of the path.
struct WayPiece {
  double used;   ///< time used [s]
  bool at_blow;  ///< ends there
};

/// Part of the step dt after which the crank is at the blow: safeguarded secant on the smooth continuation.
/// offset_after(t): offset from the blow [rad] after t of dt; start, end: at both ends, of different signs.
template <typename Function>
double timeToBlow(const Function& offset_after, double start, double end, double dt) noexcept {
  double low = 0.0, high = dt, f_low = start, f_high = end;
  double t = 0.0;
  for (int i = 0; i < 8; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = offset_after(t);
    if (std::abs(f) < 1e-13) break;
    const bool before = std::signbit(f) == std::signbit(f_low);
    (before ? low : high) = t;
    (before ? f_low : f_high) = f;
  }
  return t;
}

/// Reflected inertia of the links, and torques of weight and hull motion, on the shaft; refers to the mechanism, which
/// must outlive it.
class ShaftModel {
 public:
  ShaftModel(const Mechanism& mechanism, Level level)
      : mechanism_(&mechanism),
        level_(rigid(level)),
        own_(crankWithinDrive(mechanism, rigid(level))),
        columns_(machineColumns(mechanism, rigid(level))) {}
  void setHullMotion(const HullMotion& hull) noexcept { hull_ = hull; }
  const HullMotion& hullMotion() const noexcept { return hull_; }
  ShaftLoad operator()(CrankAngle angle) const noexcept {
    ShaftLoad load = shaftLoad(*mechanism_, level_, angle, hull_);
    const double r = mechanism_->parameters().drive_reaction_ratio;
    load.weight_torque -= (1.0 - r) * own_ * load.hull_acceleration;
    load.hull_acceleration *= r;
    return load;
  }
  /// Returns true for an exact hammer, which has no columns.
  bool isExact() const noexcept { return columns_ == nullptr; }
  /// A copy that is prepared for many calls of columns().
  ShaftModel tabulated() const {
    ShaftModel copy = *this;
    if (!isExact()) copy.table_ = std::make_shared<const ShaftTable>(columns_->shaftTable());
    return copy;
  }
  MachineColumns::OnShaft columns(CrankAngle angle) const noexcept {
    if (isExact()) return MachineColumns::OnShaft::Zero();
    return table_ && !isBeyond(angle.side, angle.offset) ? onShaft(*table_, angle, hull_.gravity)
                                                         : columns_->onShaft(angle, hull_.gravity);
  }

 private:
  const Mechanism* mechanism_;
  Level level_;
  double own_;  ///< crankWithinDrive()
  std::shared_ptr<const MachineColumns> columns_;
  std::shared_ptr<const ShaftTable> table_;
  HullMotion hull_;
};

/// State of the shaft.
struct ShaftState {
  CrankPosition position;
  double speed{};          ///< w [rad/s]
  double torque{};         ///< net drive torque tau on the crank [N m]
  double drive_inertia{};  ///< Jc: motor, flywheel and whatever turns with the crank [kg m2]
};

constexpr double kNearTool = 0.06, kHighestTool = 0.5;  ///< [rad] from the dead centre: it would be higher than long
constexpr double kStepsToTool = 1.5;

/// Returns true if the tool may be met within a step of length dt [s].
inline bool isNearTool(const ShaftState& state, double dt) noexcept {
  return std::abs(state.position.angle.offset) <
         std::clamp(kStepsToTool * std::abs(state.speed) * dt, kNearTool, kHighestTool);
}

/// w' = (tau + weight - Jc r alpha - J'/2 w^2)/(Jc + J) [rad/s2], weight and hull's motion in one (model.md 3, 6).
double acceleration(const ShaftLoad& load, const ShaftState& state) noexcept;

/// Order of the shaft's variables in matrices: angle, speed, torque, logarithm of the drive inertia (which keeps it
/// positive and makes its uncertainty relative), factor of the last blow.
using ShaftMatrix = Eigen::Matrix<double, 5, 5>;

/// d(angle, speed after)/d(angle, speed, torque, logarithm of drive inertia, blow factor before); the others stay. The
/// blow factor counts only where a blow is passed in between.
using ShaftTransition = Eigen::Matrix<double, 2, 5>;

/// Treatment of a forward passage of the dead centre.
struct Passing {
  double factor{1.0};  ///< crank speed after over before the blow [-], > 0
  bool contact{true};  ///< false: no tool, the rocker passes smoothly onto the mirrored branch
};

/// Events of a step beside the motion.
struct Advance {
  ShaftTransition transition;
  int blows{};  ///< passed forward, with contact; back in time as above
};

/// Passes the blow for a state on the branch before it, at offset 0 or slightly beyond: to first order the result is
/// that of a passage at offset 0. The position is continuous, the speed changes by the factor, and the acceleration
/// jumps; a path that reaches the blow later by d(angle)/w keeps the old acceleration for this time (saltation). The
/// factor is 1 for a backward turn, and is undone for a step back in time.
void passBlow(const ShaftModel& model, double factor, ShaftState& state, ShaftLoad& load,
              ShaftTransition& total) noexcept;

/// Advances the state by dt [s] (negative: back in time) with constant torque and inertia, through the blow if it lies
/// in between. `load` is the model's at the state's angle, before and after the call. A state on the mirrored branch
/// continues and leaves it smoothly.
///
/// Integrates h = sqrt(Jc + J) w, half the square of which is the kinetic energy: its rate, the torques over
/// sqrt(Jc + J), has no term with the transfer function's derivative, so its linearisation needs none of third order.
/// Runge-Kutta of order 4 by two derivatives, steps of at most 0.04 rad: error of a free turn below 1e-7 of the energy;
/// linearisation of order 2 per step, within 1 % of finite differences at 1 kHz (test).
Advance advance(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state,
                ShaftLoad& load) noexcept;
/// Advances the state without the linearisation, which costs as much as the state.
void advanceState(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state) noexcept;

}  // namespace hammer_loads
