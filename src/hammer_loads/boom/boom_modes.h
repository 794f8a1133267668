/// Modes of the boom on the oil of its cylinders at one pose, and readings of its vibration as rows over the joints.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/boom/chain_pose.h"
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

/// Joint torques of the hammer over one step, signs as in Boom::hammerTorque() [N m].
struct TorqueStep {
  JointVector from, to;  ///< at the step's ends; where the load jumps (a blow), end a step there and start the next
  JointVector mean;      ///< over the step; linear between the ends makes it their mean
};

/// One entry a cylinder, then zeros: logarithms of its oil's stiffness over that given [-].
using LogOil = Eigen::Matrix<double, kMaxJoints, 1>;

/// Modes at a pose; at most one cylinder per joint. g_B: gravity in the root's axes [m/s2]. No allocation.
void findModes(MassMatrix& mass, const std::vector<Cylinder>& cylinders, const JointVector& position,
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

/// Clock of a reading's stamps. A sensor with a clock of its own may have a constant delay.
enum class Clock { kCrank, kImu, kPressures };

/// Reading of one channel of a sensor, as a function of the joints' vibration q: offset + displacement . q + velocity .
/// q' + acceleration . q'', or, for the oil, offset + oil . (K q + C q'). Everything else that the sensor sees (weight,
/// the boom's slow motion) must be subtracted from value first, as far as known; the offset absorbs the rest.
struct VibrationReading {
  /// One entry per joint of the chain, then zeros.
  using Row = Eigen::Matrix<double, kMaxJoints, 1>;
  Row displacement = Row::Zero(), velocity = displacement, acceleration = displacement, oil = displacement;
  bool of_oil{};  ///< `oil` counts, else the three others
  int channel{-1};
  double value{};
  double ahead{};              ///< instant of the reading less the present one [s]; negative: it is older
  Clock clock{Clock::kCrank};  ///< clock whose stamps are late by ModeIdentifier::delay()
  double noise{};              ///< standard deviation of one reading, unit of value
  double neglected{};    ///< part that the modes cannot describe: it lowers the weight of the reading, but not the
                         ///< reaction to a large innovation
  double offset_std{};   ///< standard deviation of its offset at the start, unit of value
  double offset_walk{};  ///< random walk of the offset in a second, unit of value
};

/// Turning rate [rad/s] about a unit vector n in the tip's axes; J of tipJacobian().
VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate);
/// Reading of an accelerometer at p along n [m/s2]: acceleration less gravity g (all in the tip's axes).
VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration);
/// Reading of a joint's angle [rad]. Sampled above 100 Hz, it shows the vibration.
VibrationReading jointAngleReading(int joint, double angle);
/// Torque of hammer and rock on a joint by its cylinder's measured force [N m]: -force times arm, less weight and
/// motion.
VibrationReading oilTorqueReading(int joint, double torque);

}  // namespace hammer_loads
