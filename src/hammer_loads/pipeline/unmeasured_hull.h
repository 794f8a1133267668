/// Prior of a hull's own motion where nothing measures it: it yields to its loads as a free mass near a resonance.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// A boom holds the hull with an unknown stiffness. The motion of a free hull of `hull_mass_kg` is therefore multiplied
/// by the amplification of a resonance, with any phase.
class UnmeasuredHull {
 public:
  explicit UnmeasuredHull(const HammerParameters& hammer) noexcept
      : mass_(hammer.hull_mass > 0.0 ? hammer.hull_mass : kUsualMass * hammer.rocker_mass),
        resonance_(kResonance *
                   std::hypot(1.0, hammer.hull_mass > 0.0 ? hammer.hull_mass_std / hammer.hull_mass : kUsualDeviation)),
        striking_distance_(hammer.striking_distance),
        reflected_(square(hammer.rocker_mass * hammer.rocker_com_distance) / hammer.rocker_inertia_about_pivot) {}

  /// Covariance of the motion. scatter: variances of the load's components [N2, N2, N2 m2].
  HullMotionCovariance motion(const Eigen::Vector3d& scatter) const noexcept {
    const double factor = square(resonance_ / mass_), force = factor * (scatter[0] + scatter[1]);
    HullMotionCovariance covariance = HullMotionCovariance::Zero();
    covariance(0, 0) = covariance(1, 1) = force;
    covariance(3, 3) = factor * scatter[2] / square(square(kGyration)) + force / square(kGyration);
    return covariance;
  }
  /// Standard deviation of the striking point's velocity along z at a blow [m/s]. swing: momentum that the links' load
  /// has given a free hull by then, about the mean of the turn (TurnRecorder::swing()).
  double speedAtBlow(const LinkMomentum& swing) const noexcept {
    return kSpeedResonance / kResonance * resonance_ / mass_ *
           std::hypot(swing.z, striking_distance_ / square(kGyration) * swing.about_d);
  }
  /// Relative standard deviation of the rocker's inertia as the crank feels it at a blow: a hull that yields takes part
  /// of it. Blows are too short for a resonance.
  double reflectedInertia() const noexcept { return reflected_ / mass_; }

 private:
  static constexpr double kUsualMass = 10.0;      ///< times the rocker's, where none is given
  static constexpr double kUsualDeviation = 0.5;  ///< relative, for that mass
  static constexpr double kGyration = 0.4;        ///< [m] about D
  /// Motion over that of a free hull where the boom's frequency is near that of the blows: of the acceleration; of the
  /// velocity, of which the first harmonic is a larger part.
  static constexpr double kResonance = 2.0, kSpeedResonance = 3.0;

  double mass_;               ///< [kg]
  double resonance_;          ///< with the mass's own deviation
  double striking_distance_;  ///< [m]
  double reflected_;          ///< mass by which a free hull would halve it [kg]
};

}  // namespace hammer_loads
