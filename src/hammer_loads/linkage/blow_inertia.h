/// Inertia of the mechanism at the instant of its blow, where crank and rocker move independently.
#pragma once

#include <cmath>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// With all pins in line the loop leaves crank phi' and rocker psi' independent; the rod follows: l2 beta' = l3 psi' -
/// l1 phi'. Kinetic energy 1/2 (crank phi'^2 + 2 coupling phi' psi' + rocker psi'^2). Level linkage: J1 and J2 as in
/// LinkMoments; else crank = Jc, coupling = 0, rocker = I. Neglects impulses along rod and rocker.
///
/// A blow has two parts. The tool changes psi' from u- w- to R |u-| w-; the crank's momentum crank phi' + coupling psi'
/// is kept. Then the linkage takes both onto the branch psi' = u+ phi'; that impulse does no work along (1, u+).
struct BlowInertia {
  double crank{};     ///< with the drive [kg m2]
  double coupling{};  ///< [kg m2]
  double rocker{};    ///< [kg m2]
  double u_before{};  ///< psi'/phi' just before the blow [-], < 0
  double u_after{};   ///< just after [-], > 0

  /// Reduced inertia of crank and rocker on the branch before the blow [kg m2].
  double before() const noexcept { return crank + u_before * (2.0 * coupling + u_before * rocker); }
  /// Reduced inertia of crank and rocker on the branch after the blow [kg m2].
  double after() const noexcept { return crank + u_after * (2.0 * coupling + u_after * rocker); }
  /// Inertia of the rocker alone while the crank is free to follow [kg m2].
  double freeRocker() const noexcept { return rocker - coupling * coupling / crank; }
  /// Crank speed after over before for a restitution R of rocker on tool.
  double factor(double restitution) const noexcept { return withoutRebound() + restitution * perRestitution(); }
  /// Restitution from a factor; at level rocker R = (k (Jc + I u+^2) - Jc)/(I u+ |u-|).
  double restitution(double factor) const noexcept { return (factor - withoutRebound()) / perRestitution(); }
  /// Factor of the rebound without an impulse within the linkage: 1 for a massless rod.
  double smoothFactor() const noexcept { return (crank + coupling * u_before) / (crank + coupling * u_after); }
  /// Derivative of restitution() by the factor.
  double restitutionPerFactor() const noexcept { return 1.0 / perRestitution(); }

 private:
  double perRestitution() const noexcept { return -u_before * u_after * freeRocker() / after(); }
  double withoutRebound() const noexcept {
    const double tool = coupling * u_before;  // momentum that the crank gains when the rocker stops, over its speed
    return (crank + tool + u_after * coupling * (1.0 + tool / crank)) / after();
  }
};

/// drive_inertia: Jc [kg m2], > 0.
inline BlowInertia blowInertia(const Mechanism& mechanism, Level level, double drive_inertia) noexcept {
  BlowInertia b;
  b.u_before = motion(mechanism.linkage(), {0.0, Side::kBeforeBlow}).u;
  b.u_after = motion(mechanism.linkage(), {0.0, Side::kAfterBlow}).u;
  b.crank = drive_inertia;
  b.rocker = mechanism.parameters().rocker_inertia_about_pivot;
  if (level != Level::kLinkage) return b;
  const LinkMoments& k = mechanism.moments();
  const LinkLengths& l = mechanism.linkage().lengths();
  const double crank_part = l.crank / l.rod, rocker_part = l.rocker / l.rod;
  b.crank += k.crank_inertia + crank_part * (k.rod_inertia * crank_part - 2.0 * k.coupling.re);
  b.coupling = rocker_part * (k.coupling.re - k.rod_inertia * crank_part);
  b.rocker += k.rod_inertia * rocker_part * rocker_part;
  return b;
}

}  // namespace hammer_loads
