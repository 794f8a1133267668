/// Readings of the boom's vibration, as rows over its joints.
#pragma once

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

/// Clock of a reading's stamps. A sensor with a clock of its own may have a constant delay.
enum class Clock { kCrank, kImu, kPressures };

/// Reading of one channel of a sensor, as a function of the joints' vibration q: offset + displacement . q + velocity .
/// q' + acceleration . q'', or, for the oil, offset + oil . (K q + C q'). Everything else that the sensor sees (weight,
/// the boom's slow motion) must be subtracted from value first, as far as known; the offset absorbs the rest.
struct VibrationReading {
  /// One entry per joint of the chain, then zeros.
  using Row = Eigen::Matrix<double, kMaxJoints, 1>;
  Row displacement, velocity, acceleration, oil;
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
