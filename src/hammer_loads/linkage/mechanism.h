/// Striking mechanism of a hammer by its nominal parameters and its weighing: lengths, masses, inertias, and the
/// reaction of its drive, whose stator is part of the hull.
#pragma once

#include <array>

#include "hammer_loads/linkage/crank_rocker.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/planar.h"
#include "hammer_loads/linkage/rod_spring.h"

namespace hammer_loads {

/// Standard deviations of the constants of a hammer, in the order and the units of kHammerConstants; 0: exact.
using HammerDeviations = std::array<double, 21>;

/// Parameters of the hammer file (contract); keys of the same names with the unit appended.
struct HammerParameters {
  LinkLengths lengths;                  ///< [m]
  double rocker_com_distance{};         ///< ls = DS [m], > 0
  double rocker_com_angle{};            ///< a = angle C-D-S [rad]
  double rocker_mass{};                 ///< m3 [kg], > 0
  double rocker_inertia_about_pivot{};  ///< I about D [kg m2], >= m3 ls^2
  double striking_distance{};           ///< lK: distance of the striking point K from D along D-S [m], > 0
  double striking_offset{};             ///< zK: height of K over the line D-S, towards +z at the blow [m]
  double striking_friction{};           ///< f between rocker and tool [-], >= 0; no effect while zK is 0
  double crank_mass{};                  ///< [kg], >= 0
  double crank_com_along{};             ///< from A towards B [m]
  double crank_com_across{};            ///< along turned by +90 deg in (xi, eta) [m]
  double crank_inertia_about_com{};     ///< [kg m2], >= 0
  double rod_mass{};                    ///< [kg], >= 0
  double rod_com_along{};               ///< from B towards C [m]
  double rod_com_across{};              ///< along turned by +90 deg in (xi, eta) [m]
  double rod_inertia_about_com{};       ///< [kg m2], >= 0
  double drive_inertia{};               ///< motor and flywheel on the crank's shaft [kg m2], > 0; a first guess
  double drive_reaction_ratio{1.0};     ///< r of DriveReaction [-], finite
  RodSpring rod;                  ///< spring and damping of the connecting rod; 0 stands for unknown, see priorOf()
  RodSpring rod_std;              ///< standard deviations of it, >= 0
  double hull_mass{};             ///< housing and what is fixed to it [kg]; 0: hullMass() assumes it
  double hull_mass_std{};         ///< standard deviation [kg], >= 0; counts with hull_mass > 0
  HammerDeviations deviations{};  ///< standard deviations of the constants above but the spring; 0: exact
};

/// Masses of the links in the form in which they enter momentum and energy. `Seen from the hull`: in the mechanism
/// frame turned by the centre-of-mass angle a, so that hull x = -re and hull z = im (model.md 1).
struct LinkMoments {
  double mass{};              ///< m1 + m2 + m3 [kg]
  Planar crank;               ///< C1 = m1 rho1 + m2 l1, seen from the hull, times e^(i phi) [kg m]
  Planar rod;                 ///< C2 = m2 rho2, seen from the hull, times e^(i beta) [kg m]
  double rocker{};            ///< C3 = m3 ls, seen from the hull, times e^(i psi) [kg m]
  Planar fixed;               ///< first moment about D of crank and rod placed at A, seen from the hull [kg m]
  Planar rod_at_b;            ///< m2 l1, seen from the hull, times e^(i phi): the rod's mass at B [kg m]
  Planar pivot;               ///< from A to D, seen from the hull [m]
  Planar coupling;            ///< l1 m2 rho2, in the mechanism frame [kg m2]
  double crank_inertia{};     ///< J1: crank about A with the rod's mass at B [kg m2]
  double rod_inertia{};       ///< J2: rod about B [kg m2]
  double rod_force_factor{};  ///< r0^2/(2 l3): s r/l3/sin mu [1/m]
  double rocker_over_rod{};   ///< l3/l2 [-]
  double inv_rod_length{};    ///< 1/l2 [1/m]
};

/// Mechanism of a possible hammer. Built once, then only read.
class Mechanism {
 public:
  /// Makes a mechanism, or reports every violated rule at once; keys as in the hammer file.
  static Checked<Mechanism> make(const HammerParameters& parameters);

  const CrankRocker& linkage() const noexcept { return linkage_; }
  /// Parameters as given, with the rod's length corrected to the change-point condition.
  const HammerParameters& parameters() const noexcept { return parameters_; }
  /// First moment of the rocker about D, m3 ls [kg m].
  double rockerFirstMoment() const noexcept { return rocker_first_moment_; }
  double cosComAngle() const noexcept { return cos_com_angle_; }  ///< cos a
  double sinComAngle() const noexcept { return sin_com_angle_; }  ///< sin a
  const LinkMoments& moments() const noexcept { return moments_; }

 private:
  explicit Mechanism(const CrankRocker& linkage) : linkage_(linkage) {}
  CrankRocker linkage_;
  HammerParameters parameters_;
  LinkMoments moments_;
  double rocker_first_moment_{}, cos_com_angle_{}, sin_com_angle_{};
};

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

/// Inertia of the crank about A [kg m2] where the level counts it as part of Jc and not as that of a link: it turns
/// with r = 1. With r = 0 the whole reaction is left out.
inline double crankWithinDrive(const Mechanism& mechanism, Level level) noexcept {
  const HammerParameters& p = mechanism.parameters();
  if (level == Level::kLinkage || p.drive_reaction_ratio == 0.0) return 0.0;
  return p.crank_inertia_about_com +
         p.crank_mass * (p.crank_com_along * p.crank_com_along + p.crank_com_across * p.crank_com_across);
}

/// Reaction of the drive. drive_inertia: Jc [kg m2]; 0, where it is not known: no reaction but the crank's.
inline DriveReaction driveReaction(const Mechanism& mechanism, Level level, double drive_inertia) noexcept {
  const double r = mechanism.parameters().drive_reaction_ratio, crank = crankWithinDrive(mechanism, level);
  return {r * drive_inertia + (1.0 - r) * crank, r * r * drive_inertia + (1.0 - r * r) * crank};
}

}  // namespace hammer_loads
