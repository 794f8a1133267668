/// Crank, rod and rocker of a hammer with an elastic rod: the two angles are independent of each other.
#pragma once

#include <array>
#include <cmath>
#include <complex>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/moving_links.h"

namespace hammer_loads::simulation {

/// Angles, speeds or accelerations of crank and rocker, or forces on them.
using TwoBodies = std::array<double, 2>;

/// Stretch of the rod relative to its nominal length, with its derivatives by both angles.
struct RodStretch {
  double stretch{};   ///< [m]
  TwoBodies slope{};  ///< [m/rad]
  double rate(const TwoBodies& speed) const noexcept { return slope[0] * speed[0] + slope[1] * speed[1]; }
};

/// Spring with a parallel damper and joint clearance. Without clearance it transmits tension and compression. With
/// clearance each side only pushes, and its damper grows with the first 5 um of compression, as that of an oil film, so
/// that the force has no step.
class RodSpring {
 public:
  explicit RodSpring(const RodSettings& rod) noexcept;

  /// Returns the tension [N] at a stretch [m] and its rate [m/s]; negative in compression.
  double tension(double stretch, double rate) const noexcept;
  double energy(double stretch) const noexcept;   ///< [J]
  double pressed(double stretch) const noexcept;  ///< part of a stretch beyond the joint clearance, with its sign [m]

 private:
  double stiffness_, damping_, half_play_;  ///< [N/m], [N s/m], [m]
};

/// Rocker, and at level linkage crank and rod, as rigid bodies in the plane of the mechanism frame (model.md 1).
/// Positions are complex numbers from A. The rod's centre of mass keeps its position relative to both pins, so that its
/// mass and inertia enter unchanged. Motor and flywheel are not part of it.
class ElasticLinks {
 public:
  struct Body {
    double mass{}, inertia{};        ///< [kg], about the centre of mass [kg m2]
    std::complex<double> place;      ///< centre of mass [m]
    std::complex<double> slope[2];   ///< derivatives of the place by crank and rocker angle [m/rad]
    double turn[2]{};                ///< derivatives of the body's angle by these angles [-]
    std::complex<double> by_speeds;  ///< acceleration of the place at constant crank and rocker speeds [m/s2]
    double turn_by_speeds{};         ///< angular acceleration at constant speeds [rad/s2]
  };
  struct View {
    Body body[3];
    int count{};
    RodStretch rod;
    std::complex<double> rocker;  ///< cosine and sine of the rocker's angle
  };

  ElasticLinks(const HammerParameters& parameters, Level level);

  View at(const TwoBodies& angle, const TwoBodies& speed) const noexcept;
  RodStretch rod(const TwoBodies& angle) const noexcept;
  /// Returns the inertia matrix of both coordinates: [0] crank, [1] coupling term, [2] rocker [kg m2].
  std::array<double, 3> inertia(const View& view) const noexcept;
  /// Returns the torques on crank and rocker by weight [N m].
  TwoBodies weight(const View& view, Gravity gravity) const noexcept;
  /// Returns the torques on crank and rocker by inertia at constant speeds [N m].
  TwoBodies inertiaOfSpeeds(const View& view) const noexcept;
  /// Applies the momentum theorem. tool_force [N] acts along +z at the striking point, from outside hammer and hull.
  Load load(const View& view, const TwoBodies& acceleration, Gravity gravity, double tool_force) const noexcept;
  /// Returns cosine and sine of the rocker's angle, as in a View.
  static std::complex<double> rockerAt(double angle) noexcept { return {std::cos(angle), std::sin(angle)}; }
  /// Return the depth [m] of the striking point below its position at the dead centre, and its slope by the angle.
  double depth(std::complex<double> rocker) const noexcept { return -p_.striking_distance * rocker.imag(); }
  double depthSlope(std::complex<double> rocker) const noexcept { return -p_.striking_distance * rocker.real(); }
  /// Returns the rocker angle [rad] with a rod of nominal length, on the branch of the working revolution. The crank
  /// angle is in [0, 2 pi].
  double rockerAngle(double crank_angle) const noexcept;

 private:
  /// Returns the stretch of the rod between pin b, from A, and pin c, from D.
  RodStretch rodBetween(std::complex<double> b, std::complex<double> c) const noexcept;
  std::complex<double> inMechanism(Gravity gravity) const noexcept;
  HammerParameters p_;
  Level level_;
  double cos_a_, sin_a_;
};

}  // namespace hammer_loads::simulation
