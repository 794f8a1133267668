/// Masses of the links as one vector: the loads of a given motion are linear in it.
#pragma once

#include <Eigen/Core>
#include <tuple>

#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Masses, first moments and inertias of LinkMoments in this order; a complex one takes two numbers.
struct LinkMasses {
  enum Index {
    kMass,              ///< total mass of the links [kg]
    kAtA,               ///< mass of crank and connecting rod, concentrated at A [kg]
    kCrank,             ///< and the next: C1 [kg m]
    kRod = 4,           ///< and the next: C2 [kg m]
    kRocker = 6,        ///< C3 [kg m]
    kCrankInertia,      ///< J1 [kg m2]
    kRodInertia,        ///< J2 [kg m2]
    kRockerInertia,     ///< I [kg m2]
    kCoupling,          ///< and the next: l1 m2 rho2 [kg m2]
    kWithinDrive = 12,  ///< crankWithinDrive() [kg m2]
    kSize
  };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Effect = Eigen::Matrix<double, 3, kSize>;  ///< derivatives of three loads

  /// Masses that a level gives its links.
  static Vector of(const Mechanism& mechanism, Level level) noexcept {
    const HammerParameters& p = mechanism.parameters();
    const LinkMoments& k = mechanism.moments();
    Vector masses = Vector::Zero();
    masses[kMass] = p.rocker_mass;
    masses[kRocker] = k.rocker;
    masses[kRockerInertia] = p.rocker_inertia_about_pivot;
    masses[kWithinDrive] = crankWithinDrive(mechanism, level);
    if (level != Level::kLinkage) return masses;
    masses.head<6>() << k.mass, p.crank_mass + p.rod_mass, k.crank.re, k.crank.im, k.rod.re, k.rod.im;
    masses[kCrankInertia] = k.crank_inertia, masses[kRodInertia] = k.rod_inertia;
    masses[kCoupling] = k.coupling.re, masses[kCoupling + 1] = k.coupling.im;
    return masses;
  }
};

/// Returns true if two hammers differ by their masses alone.
inline bool haveLikeMotion(const Mechanism& a, const Mechanism& b) noexcept {
  const auto place = [](const Mechanism& m) {
    const LinkLengths& l = m.parameters().lengths;
    return std::tuple(l.crank, l.rocker, l.pivot_distance, m.parameters().rocker_com_angle,
                      m.parameters().drive_reaction_ratio);
  };
  return place(a) == place(b);
}

}  // namespace hammer_loads
