/// Striking mechanism of a hammer by its nominal parameters and its weighing: lengths, masses, inertias, and the
/// reaction of its drive, whose stator is part of the hull.
#pragma once

#include <array>
#include <cmath>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/planar.h"
#include "hammer_loads/util/checked.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Rod, pins and bearings as one spring along the rod, its damping, and the joint clearance and friction of the pins.
/// Level elastic models all four; the other levels model none of them.
struct RodSpring {
  double stiffness{};        ///< k [N/m]; 0: not known
  double damping_ratio{};    ///< damping ratio of an oscillator of kReference on k [-]; 0: not known
  double play{};             ///< joint clearance of both pins together, along the rod [m], >= 0
  double friction_radius{};  ///< radius of a pin's friction circle, coefficient of friction times pin radius [m], >= 0

  static constexpr double kReference = kTwoPi * 200.0;                                      ///< [rad/s]
  double damping() const noexcept { return 2.0 * damping_ratio * stiffness / kReference; }  ///< [N s/m]
};

/// Prior of a connecting rod before any measurement. No source gives values, so estimates replace what a file leaves
/// out.
struct RodPrior {
  RodSpring rod;
  double log_stiffness{}, log_damping{};  ///< standard deviations of their logarithms
  double play{};                          ///< standard deviation [m]
  double friction_radius{};               ///< standard deviation [m]
  bool is_elastic{};                      ///< false: the rod is given as rigid, its pins as tight

  static constexpr double kStiffness = 8e8, kDamping = 0.4;  ///< 4e8 to 1e9 N/m and 0.2 to 0.6: estimates
  static constexpr double kStiffest = 1e11;                  ///< stands for a rigid rod [N/m]
};

/// Standard deviations where a file gives none; 0 in the rod: not known.
inline RodSpring usualDeviation(const RodSpring& rod) noexcept {
  return {rod.stiffness > 0.0 ? 0.2 * rod.stiffness : 0.5 * RodPrior::kStiffness,
          rod.damping_ratio > 0.0 ? 0.4 * rod.damping_ratio : 0.8 * RodPrior::kDamping, 1e-4, 1e-3};
}

/// deviation: standard deviations of rod. A stiffness that is neither known nor uncertain is that of a rigid rod.
inline RodPrior priorOf(const RodSpring& rod, const RodSpring& deviation) noexcept {
  RodPrior prior{rod, 0.0, 0.0, deviation.play, deviation.friction_radius, true};
  if (!(rod.stiffness > 0.0)) prior.rod.stiffness = deviation.stiffness > 0.0 ? prior.kStiffness : prior.kStiffest;
  if (!(rod.damping_ratio > 0.0)) prior.rod.damping_ratio = prior.kDamping;
  prior.log_stiffness = deviation.stiffness / prior.rod.stiffness;
  prior.log_damping = deviation.damping_ratio / prior.rod.damping_ratio;
  prior.is_elastic = rod.stiffness > 0.0 || deviation.stiffness > 0.0 || rod.play > 0.0 || deviation.play > 0.0;
  return prior;
}

/// Clearance and friction of the pins as identified from the readings.
struct IdentifiedPins {
  double clearance{};            ///< joint clearance along the rod, of both pins together [m]; 0 if they are tight
  double friction_radius_std{};  ///< standard deviation of RodSpring::friction_radius [m]
};

/// Damped oscillator y'' = -square y - 2 decay y', solved exactly for any damping.
struct Oscillator {
  double square{};  ///< square of the undamped angular frequency [rad2/s2], > 0
  double decay{};   ///< [1/s], >= 0

  void move(double time, double& y, double& speed) const noexcept {
    const double rest = square - decay * decay, from = y, v = speed;
    double cosine, sine;  // sine over the frequency, both with the decay
    if (rest > 0.0) {
      const double frequency = std::sqrt(rest), e = std::exp(-decay * time);
      const SineCosine at = sineCosine(frequency * time);
      cosine = e * at.cosine, sine = e * at.sine / frequency;
    } else {
      const double s = std::sqrt(-rest);
      const double slow = std::exp((s - decay) * time), fast = std::exp(-(s + decay) * time);
      cosine = 0.5 * (slow + fast), sine = s > 0.0 ? 0.5 * (slow - fast) / s : time * slow;
    }
    y = from * cosine + (v + decay * from) * sine;
    speed = v * cosine - (square * from + decay * v) * sine;
  }
};

/// Bounds of the size of every parameter in SI units, the lower one for those that must be > 0: far beyond any hammer,
/// and no product of such numbers overflows.
constexpr double kLeastParameter = 1e-9, kMostParameter = 1e9;

/// Nominal link lengths [m]; pins A (crank on hull), B (crank-rod), C (rod-rocker), D (rocker on hull).
struct LinkLengths {
  double crank{};           ///< l1 = AB [m], > 0, shortest
  double rod{};             ///< l2 = BC [m]
  double rocker{};          ///< l3 = DC [m]
  double pivot_distance{};  ///< l0 = AD [m]
};

/// A crank-rocker that satisfies the change-point condition l1 + l2 = l0 + l3 exactly (P0, "special position"):
/// at crank angle 0 all four pins are in line, and there the rocker strikes.
class CrankRocker {
 public:
  /// Accepts lengths that miss the condition by at most 1e-3 l1 (whole millimetres satisfy it only on paper), corrects
  /// the rod by the difference and notes it; refuses a larger miss, non-positive lengths and a crank that cannot turn.
  static Checked<CrankRocker> make(const LinkLengths& lengths);

  const LinkLengths& lengths() const noexcept { return lengths_; }  ///< rod corrected [m]

  /// Ratios to the crank length and the combinations of them that motion() uses [-]. Differences such as
  /// lambda0 - 1 are formed from the lengths, so no digits are lost when links are nearly equal.
  struct Ratios {
    double lambda0{}, lambda2{}, lambda3{};
    double sigma{};                ///< lambda0 + lambda3 = 1 + lambda2
    double g{};                    ///< r^2 - cos^2(phi/2) = lambda2 lambda3/lambda0 - 1 (P0 (5))
    double two_over_r0_squared{};  ///< 2 lambda0/(lambda2 lambda3); r0 = sqrt(lambda2 lambda3/lambda0)
    double k_cos{}, k_sin{};       ///< lambda3 (lambda0 - 1), lambda0 (lambda3 - 1)
    double w0{};                   ///< lambda2 (lambda0 - 1)/lambda0
    double lambda0_squared{}, lambda3_squared{}, lambda03{};  ///< lambda0^2, lambda3^2, lambda0 lambda3
    double sigma_squared{}, lambda3_sigma{}, lambda3_over_sigma_squared{};
  };
  const Ratios& ratios() const noexcept { return ratios_; }

 private:
  LinkLengths lengths_;
  Ratios ratios_;
};

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
  HammerDeviations deviations{};  ///< standard deviations of the constants above except the spring; 0: exact
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
  double rockerFirstMoment() const noexcept { return moments_.rocker; }
  double cosComAngle() const noexcept { return cos_com_angle_; }  ///< cos a
  double sinComAngle() const noexcept { return sin_com_angle_; }  ///< sin a
  const LinkMoments& moments() const noexcept { return moments_; }

 private:
  explicit Mechanism(const CrankRocker& linkage) : linkage_(linkage) {}
  CrankRocker linkage_;
  HammerParameters parameters_;
  LinkMoments moments_;
  double cos_com_angle_{}, sin_com_angle_{};
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

/// Inertia of the crank about A [kg m2] if the level counts it in Jc and not as a link, else 0; it turns with r = 1.
/// With r = 0 the whole reaction is neglected.
inline double crankWithinDrive(const Mechanism& mechanism, Level level) noexcept {
  const HammerParameters& p = mechanism.parameters();
  if (level == Level::kLinkage || p.drive_reaction_ratio == 0.0) return 0.0;
  return p.crank_inertia_about_com +
         p.crank_mass * (p.crank_com_along * p.crank_com_along + p.crank_com_across * p.crank_com_across);
}

/// Reaction of the drive. drive_inertia: Jc [kg m2]; 0 if not known: no reaction except the crank's.
inline DriveReaction driveReaction(const Mechanism& mechanism, Level level, double drive_inertia) noexcept {
  const double r = mechanism.parameters().drive_reaction_ratio, crank = crankWithinDrive(mechanism, level);
  return {r * drive_inertia + (1.0 - r) * crank, r * r * drive_inertia + (1.0 - r * r) * crank};
}

}  // namespace hammer_loads
