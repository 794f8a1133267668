/// The crank's motion around one blow, by the shaft's equation of motion.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads::calibration {

constexpr int kNodesBeside = 4;  ///< nodes of the torque on either side of the blow

/// Parameters of one blow alone: instant [s], the crank's speeds before and after [rad/s], net torque [N m] in nodes at
/// the blow and at equal steps before (odd ones) and after it (even ones), linear in between.
enum LocalIndex : Eigen::Index {
  kInstant,
  kSpeedBefore,
  kSpeedAfter,
  kTorqueAtBlow,
  kTorques,
  kLocals = kTorques + 2 * kNodesBeside
};
using Locals = Eigen::Matrix<double, kLocals, 1>;

/// Place of a node in Locals; node 0 is at the blow, 1.. further away.
constexpr Eigen::Index torqueIndex(bool before, int node) {
  return node == 0 ? static_cast<Eigen::Index>(kTorqueAtBlow)
                   : static_cast<Eigen::Index>(kTorques) + (before ? 0 : kNodesBeside) + node - 1;
}

/// Law by which the drive's torque follows the crank, equal at every blow.
struct DriveLaw {
  double mean_speed{};  ///< [rad/s]
  double stiffness{};   ///< torque lost per angle that the crank is ahead of the mean speed: oil in the line [N m/rad]
  double drag{};        ///< torque lost per speed above the mean: friction, a motor's slip [N m s/rad]
};

/// One side of the blow, as seen from it.
struct HalfShot {
  bool before{};
  double speed{};                     ///< at the blow [rad/s]
  double torque[kNodesBeside + 1]{};  ///< in the nodes [N m]
  double node_step{};                 ///< [s], > 0
  double drive_inertia{};             ///< [kg m2]
  DriveLaw law;
};

/// Motion of the crank.
struct ShotPoint {
  double offset{}, speed{}, acceleration{};
};

/// Parameters of one side: speed at the blow, torques in the nodes, logarithm of the drive inertia, the law's two
/// numbers.
enum HalfIndex : Eigen::Index {
  kOwnSpeed,
  kOwnTorques,
  kOwnLogInertia = kOwnTorques + kNodesBeside + 1,
  kOwnStiffness,
  kOwnDrag,
  kHalfMoving
};

/// d(offset, speed)/d(each of HalfIndex).
using ShotSlopes = Eigen::Matrix<double, 2, kHalfMoving>;

/// The crank at times away from the blow, ascending, >= 0 [s] (before it: how long before). Runge-Kutta of order 4 in
/// angle and sqrt(inertia) speed, steps of at most 0.08 rad, polynomials within them. slopes: null, or their
/// derivatives, integrated along with them.
void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes = nullptr);

}  // namespace hammer_loads::calibration
