/// Integrates the shaft's equation of motion to obtain the crank's motion around one blow.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads::calibration {

constexpr int kNodesPerSide = 4;  ///< nodes of the torque on either side of the blow

/// Local parameters of one blow: instant [s], crank speeds before and after [rad/s], net torque [N m] at the nodes. One
/// node is at the blow, the others at equal steps before and after it. The torque is linear between nodes.
enum LocalIndex : Eigen::Index {
  kInstant,
  kSpeedBefore,
  kSpeedAfter,
  kTorqueAtBlow,
  kTorques,
  kLocals = kTorques + 2 * kNodesPerSide
};
using Locals = Eigen::Matrix<double, kLocals, 1>;

/// Returns the index of a torque node in Locals; node 0 is at the blow, higher nodes are further away.
constexpr Eigen::Index torqueIndex(bool before, int node) {
  return node == 0 ? static_cast<Eigen::Index>(kTorqueAtBlow)
                   : static_cast<Eigen::Index>(kTorques) + (before ? 0 : kNodesPerSide) + node - 1;
}

/// Dependence of the drive torque on the crank's motion, common to all blows.
struct DriveLaw {
  double mean_speed{};  ///< [rad/s]
  double stiffness{};   ///< torque loss per angle of lead over the mean speed: oil in the line [N m/rad]
  double drag{};        ///< torque loss per speed above the mean: friction, motor slip [N m s/rad]
};

/// Parameters of the motion on one side of the blow.
struct HalfShot {
  bool before{};
  double speed{};                      ///< at the blow [rad/s]
  double torque[kNodesPerSide + 1]{};  ///< at the nodes [N m]
  double node_step{};                  ///< [s], > 0
  double drive_inertia{};              ///< [kg m2]
  DriveLaw law;
};

/// Crank offset [rad], speed [rad/s] and acceleration [rad/s2].
struct ShotPoint {
  double offset{}, speed{}, acceleration{};
};

/// Parameters of one side: speed at the blow, torques at the nodes, logarithm of the drive inertia, stiffness and drag
/// of the drive law.
enum HalfIndex : Eigen::Index {
  kOwnSpeed,
  kOwnTorques,
  kOwnLogInertia = kOwnTorques + kNodesPerSide + 1,
  kOwnStiffness,
  kOwnDrag,
  kHalfMoving
};

/// Derivatives of offset and speed with respect to the parameters of HalfIndex.
using ShotSlopes = Eigen::Matrix<double, 2, kHalfMoving>;

/// Computes the crank's motion at ascending times from the blow, >= 0 [s], counted backwards on the side before it.
/// Integrates angle and sqrt(inertia) speed by Runge-Kutta of order 4 in steps of at most 0.08 rad, and interpolates by
/// polynomials. If slopes is not null, the derivatives are integrated as well.
void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes = nullptr);

}  // namespace hammer_loads::calibration
