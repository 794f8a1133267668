/// The striking mechanism's links by loop closure and differentiation: independent of linkage/ and hammer/.
#pragma once

#include <cmath>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::simulation {

/// Value f with its derivatives df/dx and d2f/dx2 by one variable, for kinematics without derived formulas.
struct Jet {
  double value{};
  double first{};
  double second{};
};

/// Returns f(a) from f and its derivatives at a.value.
inline Jet chain(const Jet& a, double f, double df, double ddf) noexcept {
  return {f, df * a.first, ddf * a.first * a.first + df * a.second};
}

inline Jet operator+(const Jet& a, const Jet& b) noexcept {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline Jet operator-(const Jet& a, const Jet& b) noexcept {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
inline Jet operator*(const Jet& a, const Jet& b) noexcept {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}
inline Jet operator+(const Jet& a, double b) noexcept { return {a.value + b, a.first, a.second}; }
inline Jet operator-(double a, const Jet& b) noexcept { return {a - b.value, -b.first, -b.second}; }
inline Jet operator*(double a, const Jet& b) noexcept { return {a * b.value, a * b.first, a * b.second}; }
inline Jet operator/(const Jet& a, const Jet& b) noexcept {
  const double inv = 1.0 / b.value;
  return a * chain(b, inv, -inv * inv, 2.0 * inv * inv * inv);
}
inline Jet sqrt(const Jet& a) noexcept {
  const double root = std::sqrt(a.value);
  return chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}
inline Jet sin(const Jet& a) noexcept {
  const double s = std::sin(a.value);
  return chain(a, s, std::cos(a.value), -s);
}
inline Jet cos(const Jet& a) noexcept {
  const double c = std::cos(a.value);
  return chain(a, c, -std::sin(a.value), -c);
}
inline Jet asin(const Jet& a) noexcept {
  const double w = 1.0 / ((1.0 - a.value) * (1.0 + a.value));
  const double root = std::sqrt(w);
  return chain(a, std::asin(a.value), root, a.value * w * root);
}
inline Jet atan(const Jet& a) noexcept {
  const double w = 1.0 / (1.0 + a.value * a.value);
  return chain(a, std::atan(a.value), w, -2.0 * a.value * w * w);
}

/// Crank angle as the signed distance from the nearest dead centre [rad], and the side on which it lies.
struct TurnAngle {
  double offset{};
  bool before_blow{};
  bool mirrored{};  ///< rocker on the other side of the line A-D, after it passed the dead centre without a tool
};

/// Load of the links on the crank's shaft at one angle.
struct ShaftView {
  double inertia{};        ///< J: kinetic energy of the links = J/2 w^2 [kg m2]
  double inertia_slope{};  ///< dJ/dphi [kg m2/rad]
  double weight_torque{};  ///< torque of the links' weight on the crank [N m]
};

/// Load BY the links ON the hull, about the rocker pivot D, axes of hammer_hull (model.md 1).
struct Load {
  double force_x{};   ///< [N]
  double force_z{};   ///< [N]
  double torque_y{};  ///< [N m]
};

/// Energy, impulse and speeds of one passage of the blow at crank speed w.
struct Strike {
  double rocker_speed_before{};  ///< psi' [rad/s]
  double rocker_speed_after{};   ///< psi' [rad/s]
  double energy{};               ///< kinetic energy that the links give to the tool [J]
  double tool_impulse{};         ///< along +z BY the tool ON the rocker [N s]
  double crank_speed_after{};    ///< once rod and crank follow the rocker again [rad/s]
  double linkage_loss{};         ///< kinetic energy lost in linkage and crank until then [J]
};

/// Rigid links in the mechanism frame (model.md 1), as functions of the crank angle.
struct LinkBodies {
  struct Body {
    double mass{};               ///< [kg]
    double inertia_about_com{};  ///< [kg m2]
    Jet xi, eta;                 ///< centre of mass from A [m]
    Jet angle;                   ///< counter-clockwise [rad]; value unused
  };
  Body body[3];
  int count{};
};

/// Throws std::invalid_argument with every problem of the parameters.
Mechanism mechanismFrom(const HammerParameters& parameters);

/// Rocker, and at level linkage crank and rod too, as rigid bodies in a plane. Positions come from the triangle B-D-C
/// with half angles, derivatives by the crank angle from jets. Motor and flywheel are not part of it.
class MovingLinks {
 public:
  MovingLinks(const Mechanism& mechanism, Level level);

  /// Returns the positions of the links at a crank angle.
  LinkBodies at(TurnAngle angle) const noexcept;
  ShaftView shaft(const LinkBodies& links, Gravity gravity) const noexcept;
  /// Returns the load at crank speed [rad/s] and acceleration [rad/s2], by Newton-Euler in the mechanism frame.
  Load load(const LinkBodies& links, double speed, double acceleration, Gravity gravity) const noexcept;
  /// Returns the strike at which the crank keeps its speed.
  Strike strike(double crank_speed) const noexcept;
  /// Returns the strike with a given restitution; drive_inertia [kg m2] is that of the parts rotating with the crank.
  Strike strike(double crank_speed, double restitution, double drive_inertia) const noexcept;
  /// Returns the strike of a tool of a mass [kg] at rest, away from the dead centre and without restitution.
  Strike strikeTool(TurnAngle angle, double crank_speed, double tool_mass, double drive_inertia) const noexcept;
  /// Returns psi [rad] with its derivatives by the crank angle.
  Jet rockerAngle(TurnAngle angle) const noexcept;

 private:
  Jet rockerAngleUp(TurnAngle angle) const noexcept;
  HammerParameters p_;
  Level level_;
  double cos_a_{}, sin_a_{};
};

}  // namespace hammer_loads::simulation
