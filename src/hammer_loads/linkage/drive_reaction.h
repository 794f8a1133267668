/// The hull's reaction to the motor's rotor and the flywheel, whose stator is part of it.
#pragma once

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Moment BY the rotor ON the hull about +y: -(by_crank e + by_hull alpha), with e the crank's acceleration relative to
/// the hull and alpha the hull's own. A rotor that turns i times as fast as the crank has r = 1/i, negative if it turns
/// the other way, and Jc = i^2 times its inertia: by_crank = r Jc, by_hull = r^2 Jc. The crank, in turn, feels
/// -by_crank alpha.
struct DriveReaction {
  double by_crank{};  ///< [kg m2]
  double by_hull{};   ///< [kg m2]

  double torque(double crank_acceleration, double hull_acceleration) const noexcept {
    return -(by_crank * crank_acceleration + by_hull * hull_acceleration);
  }
};

/// The crank's own inertia about A [kg m2] where the level counts it as part of Jc, not as that of a link: it turns
/// with r = 1. With r = 0 the whole reaction is left
/// out.
inline double crankWithinDrive(const Mechanism& mechanism, Level level) noexcept {
  const HammerParameters& p = mechanism.parameters();
  if (level == Level::kLinkage || p.drive_reaction_ratio == 0.0) return 0.0;
  return p.crank_inertia_about_com +
         p.crank_mass * (p.crank_com_along * p.crank_com_along + p.crank_com_across * p.crank_com_across);
}

/// drive_inertia: Jc [kg m2]; 0, where it is not known: no reaction but the crank's.
inline DriveReaction driveReaction(const Mechanism& mechanism, Level level, double drive_inertia) noexcept {
  const double r = mechanism.parameters().drive_reaction_ratio, crank = crankWithinDrive(mechanism, level);
  return {r * drive_inertia + (1.0 - r) * crank, r * r * drive_inertia + (1.0 - r * r) * crank};
}

}  // namespace hammer_loads
