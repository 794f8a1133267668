/// Modes of the boom on the oil of its cylinders, at one pose.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/boom/cylinder.h"

namespace hammer_loads {

/// Small vibration about a pose, M q'' + C q' + K q = Q: M from the chain, K from the cylinders and the weight, C by
/// one damping ratio for every mode. Joints without a cylinder are held. Modes in the order of their frequencies.
///
/// Neglects: flexibility of links, pins, machine and ground; that the cylinders' pre-load turns with them (0.2 % of a
/// stiffness of the EO-2621); oil moving between chambers (valves shut).
struct BoomModes {
  int count{};                          ///< modes = joints with a cylinder; 0 at a zero moment arm or without inertia
  bool zero_moment_arm{};               ///< some cylinder does not hold its joint: there are no modes
  std::array<int, kMaxJoints> joint{};  ///< index in the chain of the joints that vibrate
  JointVector stiffness;                ///< stiffness of these joints' cylinders [N m/rad]
  JointMatrix mass;                     ///< M of all joints [kg m2]
  JointVector omega;                    ///< natural frequencies, as identified where they are [rad/s]
  JointVector given_omega;              ///< angular frequencies by the stiffness given [rad/s]
  JointMatrix oil_share;  ///< share of each cylinder (row) in omega^2, per mode; the rest is the weight's [-]
  JointMatrix shape;      ///< shapes of the joints that vibrate, per mode; shape^T M shape = 1 [1/sqrt(kg m2)]
  JointMatrix inertia;    ///< M shape, of all joints, per mode [sqrt(kg m2)]
};

/// Joint torques of the hammer over one step, signs as in jointTorqueOfTipLoad() [N m].
struct TorqueStep {
  JointVector from, to;  ///< at the step's ends; where the load jumps (a blow), end a step there and start the next
  JointVector mean;      ///< over the step; linear between the ends makes it their mean
};

/// One entry a cylinder, then zeros: logarithms of its oil's stiffness over that given [-].
using LogOil = Eigen::Matrix<double, kMaxJoints, 1>;

/// Modes at a pose; at most one cylinder per joint. g_B: gravity in the root's axes [m/s2]. No allocation.
void findModes(ChainDynamics& dynamics, const std::vector<Cylinder>& cylinders, const JointVector& position,
               const Eigen::Vector3d& g_B, const LogOil& oil, BoomModes& modes) noexcept;

/// Modal forces of joint torques [N m] and the joint displacements or velocities that modal ones make, of all joints.
JointVector modalForce(const BoomModes& modes, const JointVector& joint_torque) noexcept;
TorqueStep modalForces(const BoomModes& modes, const TorqueStep& joint_torque) noexcept;
JointVector jointsOf(const BoomModes& modes, const JointVector& modal) noexcept;
/// Modal displacements or velocities of those of the joints; held joints do not count.
JointVector modalOf(const BoomModes& modes, const JointVector& joints) noexcept;

/// The hull's response to a force on it: it moves at first like a free mass, and yields at rest like a spring.
struct ReducedHull {
  double mass{};       ///< 1/(d^T J M^-1 J^T d) [kg]
  double stiffness{};  ///< 1/(d^T J K^-1 J^T d) [N/m]
};

/// Along a direction through the tip's origin: tip_velocity = that velocity per joint rate, d^T J [m]. Infinite where
/// the vibrating joints do not move the hull along it.
ReducedHull reducedAtTip(const BoomModes& modes, const JointVector& tip_velocity) noexcept;

}  // namespace hammer_loads
