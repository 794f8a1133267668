/// Modes of the boom on its cylinders' oil at one pose, and sensor readings of its vibration as linear functions.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/cylinder.h"

namespace hammer_loads {

/// Small vibration about a pose, M q'' + C q' + K q = Q: M from the chain, K from the cylinders and the weight, C by
/// one damping ratio for every mode. Joints without a cylinder are held. Modes are in ascending order of frequency.
///
/// Neglects: flexibility of links, pins, machine and ground; rotation of the cylinders' pre-load (0.2 % of a stiffness
/// of the EO-2621); oil flow between chambers (valves shut).
struct BoomModes {
  int count{};                          ///< modes = joints with a cylinder; 0 at a zero moment arm or without inertia
  bool zero_moment_arm{};               ///< some cylinder does not hold its joint, so that there are no modes
  std::array<int, kMaxJoints> joint{};  ///< index in the chain of the joints that vibrate
  JointVector stiffness;                ///< stiffness of these joints' cylinders [N m/rad]
  JointMatrix mass;                     ///< M of all joints [kg m2]
  JointVector omega;                    ///< natural frequencies, identified ones where available [rad/s]
  JointVector given_omega;              ///< natural frequencies of the given stiffness [rad/s]
  JointMatrix oil_share;  ///< share of each cylinder (row) in omega^2, per mode; the rest is the weight's [-]
  JointMatrix shape;      ///< shapes of the joints that vibrate, per mode; shape^T M shape = 1 [1/sqrt(kg m2)]
  JointMatrix inertia;    ///< M shape, of all joints, per mode [sqrt(kg m2)]
};

/// Joint torques of the hammer over one step, signs as in Boom::hammerTorque() [N m].
struct TorqueStep {
  JointVector from, to;  ///< at the step's ends; a load that jumps (a blow) ends a step and begins another
  JointVector mean;      ///< mean over the step; the mean of both ends for a linear torque
};

/// Logarithms of each cylinder's oil stiffness over the given one [-]: one entry per cylinder, then zeros.
using LogOil = Eigen::Matrix<double, kMaxJoints, 1>;

/// Finds the modes at a pose; at most one cylinder per joint. g_B: gravity in the root's axes [m/s2]. No allocation.
void findModes(MassMatrix& mass, const std::vector<Cylinder>& cylinders, const JointVector& position,
               const Eigen::Vector3d& g_B, const LogOil& oil, BoomModes& modes) noexcept;

/// Transforms joint torques [N m] to modal forces, and modal displacements or velocities to those of all joints.
JointVector modalForce(const BoomModes& modes, const JointVector& joint_torque) noexcept;
TorqueStep modalForces(const BoomModes& modes, const TorqueStep& joint_torque) noexcept;
JointVector jointsOf(const BoomModes& modes, const JointVector& modal) noexcept;
/// Transforms joint displacements or velocities to modal ones; held joints do not count.
JointVector modalOf(const BoomModes& modes, const JointVector& joints) noexcept;

/// Response of the hull to a force: a free mass at first, a spring at rest.
struct ReducedHull {
  double mass{};       ///< 1/(d^T J M^-1 J^T d) [kg]
  double stiffness{};  ///< 1/(d^T J K^-1 J^T d) [N/m]
};

/// Clock of a reading's stamps. A sensor with a clock of its own may have a constant delay.
enum class Clock { kCrank, kImu, kPressures };

/// Reading of one channel of a sensor, as a function of the joints' vibration q: offset + displacement . q + velocity .
/// q' + acceleration . q'', or, for the oil, offset + oil . (K q + C q'). Other known effects on the sensor (weight,
/// slow motion of the boom) must be subtracted from value first. The offset absorbs the rest.
struct VibrationReading {
  /// One entry per joint of the chain, then zeros.
  using Row = Eigen::Matrix<double, kMaxJoints, 1>;
  Row displacement = Row::Zero(), velocity = displacement, acceleration = displacement, oil = displacement;
  bool of_oil{};  ///< the row `oil` is used, otherwise the three other rows
  int channel{-1};
  double value{};
  double ahead{};              ///< instant of the reading minus the present [s]; negative for an older one
  Clock clock{Clock::kCrank};  ///< clock whose stamps are late by ModeIdentifier::delay()
  double noise{};              ///< standard deviation of one reading, in the unit of value
  double neglected{};    ///< standard deviation of what modes cannot describe; lowers the reading's weight, not the
                         ///< reaction to a large innovation
  double offset_std{};   ///< initial standard deviation of its offset, in the unit of value
  double offset_walk{};  ///< random walk of the offset in a second, in the unit of value
};

/// Returns a reading of the angular rate [rad/s] about a unit vector n in the tip's axes; J of tipJacobian().
VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate);
/// Returns a reading of an accelerometer at p along n [m/s2]: acceleration minus gravity g, all in the tip's axes.
VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration);
/// Returns a reading of a joint's angle [rad]. It shows the vibration if sampled above 100 Hz.
VibrationReading jointAngleReading(int joint, double angle);
/// Returns a reading of the oil's torque on a joint from its cylinder's measured force [N m]: -force times arm, less
/// the torques of weight and motion.
VibrationReading oilTorqueReading(int joint, double torque);

}  // namespace hammer_loads
