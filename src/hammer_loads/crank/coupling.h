/// The flexible coupling between the motor, on which the encoder sits, and the crank.
#pragma once

#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// As given. The drive inertia Jc is motor_share Jc on the motor's side and the rest, flywheel included, on the
/// crank's.
struct Coupling {
  double frequency{};            ///< natural, of both sides against each other, without the links [Hz], > 0
  double motor_share{};          ///< of the drive inertia [-], in (0, 1)
  double damping{};              ///< of critical, of the same oscillation [-], >= 0
  double stiffness_deviation{};  ///< standard deviation of the stiffness, relative [-], >= 0; 0: it is not learned
  double share_deviation{};      ///< as above of the motor's share [-]
  double damping_deviation{};    ///< standard deviation of the damping's logarithm [-], >= 0
};

/// Of the logarithm of the odds, motor's over crank's inertia; standard [-].
inline double oddsDeviationOf(const Coupling& c) noexcept {
  return c.share_deviation / (c.motor_share * (1.0 - c.motor_share));
}

/// The same for a drive inertia and a stiffness in force.
struct CouplingLaw {
  double motor_inertia, crank_inertia;  ///< [kg m2]
  double stiffness;                     ///< [N m/rad]
  double damping;                       ///< [N m s/rad]

  /// log_stiffness: logarithm of the stiffness over that of the given frequency; log_odds: logarithm of motor's over
  /// crank's inertia, less that of the given share.
  CouplingLaw(const Coupling& c, double drive_inertia, double log_stiffness, double log_odds) noexcept {
    const double motor = c.motor_share * std::exp(log_odds), share = motor / (1.0 - c.motor_share + motor);
    motor_inertia = share * drive_inertia;
    crank_inertia = drive_inertia - motor_inertia;
    const double reduced = share * crank_inertia, rate = 2.0 * kPi * c.frequency;
    const double root = std::exp(0.5 * log_stiffness);
    stiffness = reduced * rate * rate * root * root;
    damping = 2.0 * c.damping * reduced * rate * root;
  }
  /// Moment of the coupling on the crank [N m].
  double moment(double twist, double motor_speed, double speed) const noexcept {
    return stiffness * twist + damping * (motor_speed - speed);
  }
};

}  // namespace hammer_loads
