/// Reference for the mechanism's loads, by other means than the code under test: pin C as the cut of two circles, rates
/// from the closed loop's derivatives, and the nine equations of Newton and Euler for all pin forces and the drive
/// torque at once, solved by elimination. 100 digits, because half of them cancel next to the blow.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <utility>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::test {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

struct Vector {
  Real x, y;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y}; }
inline Vector operator*(const Real& k, const Vector& a) { return {k * a.x, k * a.y}; }
inline Real cross(const Vector& a, const Vector& b) { return a.x * b.y - a.y * b.x; }
inline Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y; }
inline Vector left(const Vector& a) { return {-a.y, a.x}; }

inline Real realPi() { return boost::math::constants::pi<Real>(); }

/// One state of the mechanism with all its loads; forces in hull axes (x, z) stored as (x, y).
struct Reference {
  Real psi, beta;              ///< [rad]
  Real psi_rate, beta_rate;    ///< [rad/s]
  Real psi_accel, beta_accel;  ///< [rad/s2]
  Vector hull_force;           ///< on the hull [N]
  Real hull_torque;            ///< on the hull about D, about +y [N m]
  Real drive_torque;           ///< on the crank [N m]
  Vector r01, r12, r23, r03;   ///< [N]
  Vector momentum;             ///< of the links [N s]
  Real momentum_about_d;       ///< [N m s]
  Real kinetic_energy;         ///< [J]
  Real weight_power;           ///< [W]
};

class NewtonEuler {
 public:
  /// Level rocker: crank and rod without mass and inertia. The rod's length follows from the other three, unrounded.
  NewtonEuler(const HammerParameters& p, Level level) : p_(p), with_links_(level == Level::kLinkage) {
    l1_ = p.lengths.crank;
    l3_ = p.lengths.rocker;
    l0_ = p.lengths.pivot_distance;
    l2_ = l0_ + l3_ - l1_;
  }

  Reference at(CrankAngle angle, double speed, double acceleration, Gravity gravity) const {
    const Real phi = angle.side == Side::kAfterBlow ? Real(angle.offset) : 2 * realPi() + Real(angle.offset);
    return at(phi, speed, acceleration, gravity);
  }

  /// phi within (0, 2 pi), not at the blow itself.
  Reference at(const Real& phi, const Real& w, const Real& e, Gravity gravity) const {
    Reference out;
    Body crank = body(with_links_, p_.crank_mass, p_.crank_inertia_about_com);
    Body rod = body(with_links_, p_.rod_mass, p_.rod_inertia_about_com);
    Body rocker = body(true, p_.rocker_mass,
                       Real(p_.rocker_inertia_about_pivot) -
                           Real(p_.rocker_mass) * p_.rocker_com_distance * Real(p_.rocker_com_distance));
    const Vector a{0, 0}, d{l0_, 0};
    const Vector b = l1_ * unit(phi);
    const Vector c = cut(b, d);
    rod.angle = atan2(c.y - b.y, c.x - b.x);
    rocker.angle = atan2(c.y - d.y, c.x - d.x);
    crank.angle = phi;
    crank.rate = w;
    crank.accel = e;
    closeLoop(b, c - b, c - d, crank, rod, rocker);
    place(crank, a, {0, 0}, {0, 0}, {p_.crank_com_along, p_.crank_com_across});
    const Vector b_speed = w * left(b), b_accel = e * left(b) - w * w * b;
    place(rod, b, b_speed, b_accel, {p_.rod_com_along, p_.rod_com_across});
    const Real com_angle = p_.rocker_com_angle;
    place(rocker, d, {0, 0}, {0, 0}, Real(p_.rocker_com_distance) * unit(com_angle));

    const Vector g = fromHull({gravity.x, gravity.z});
    solve(a, b, c, d, crank, rod, rocker, g, out);
    for (const Body* link : {&crank, &rod, &rocker}) {
      const Vector momentum = link->mass * link->speed;
      out.momentum = out.momentum + momentum;
      out.momentum_about_d += cross(link->com - d, momentum) + link->inertia * link->rate;
      out.kinetic_energy += (dot(momentum, link->speed) + link->inertia * link->rate * link->rate) / 2;
      out.weight_power += dot(momentum, g);
    }
    out.momentum = toHull(out.momentum);
    out.psi = rocker.angle, out.psi_rate = rocker.rate, out.psi_accel = rocker.accel;
    out.beta = rod.angle, out.beta_rate = rod.rate, out.beta_accel = rod.accel;
    return out;
  }

 private:
  struct Body {
    Real mass, inertia;  ///< about its centre of mass
    Real angle, rate, accel;
    Vector com, speed, com_accel;
  };

  static Body body(bool with_mass, const Real& mass, const Real& inertia) {
    Body out;
    if (with_mass) out.mass = mass, out.inertia = inertia;
    return out;
  }
  static Vector unit(const Real& angle) { return {cos(angle), sin(angle)}; }

  /// The cut of the circles about B (rod) and D (rocker) for which the rocker leads the rod counter-clockwise.
  Vector cut(const Vector& b, const Vector& d) const {
    const Vector bd = d - b;
    const Real distance = sqrt(dot(bd, bd));
    const Real along = (l2_ * l2_ - l3_ * l3_ + distance * distance) / (2 * distance);
    const Real across = sqrt(l2_ * l2_ - along * along);
    const Vector e = (1 / distance) * bd;
    const Vector c = b + along * e + across * left(e);
    return cross(c - b, c - d) > 0 ? c : b + along * e - across * left(e);
  }

  /// Rates and accelerations of rod and rocker from the first and second derivative of AB + BC = AD + DC.
  static void closeLoop(const Vector& b, const Vector& bc, const Vector& dc, const Body& crank, Body& rod,
                        Body& rocker) {
    const Vector u = left(bc), v = left(dc);
    const Real det = cross(v, u);
    const auto solve2 = [&](const Vector& rhs) {  // x u - y v = rhs
      return std::pair<Real, Real>{cross(v, rhs) / det, cross(u, rhs) / det};
    };
    std::tie(rod.rate, rocker.rate) = solve2(-crank.rate * left(b));
    const Vector rhs = -crank.accel * left(b) + crank.rate * crank.rate * b + rod.rate * rod.rate * bc -
                       rocker.rate * rocker.rate * dc;
    std::tie(rod.accel, rocker.accel) = solve2(rhs);
  }

  /// Centre of mass from a point of the link that moves as given; `local` in link axes.
  static void place(Body& link, const Vector& point, const Vector& speed, const Vector& accel, const Vector& local) {
    const Vector along = unit(link.angle);
    const Vector arm = local.x * along + local.y * left(along);
    link.com = point + arm;
    link.speed = speed + link.rate * left(arm);
    link.com_accel = accel + link.accel * left(arm) - link.rate * link.rate * arm;
  }

  /// Unknowns: R01, R12, R23, R03 and the drive torque.
  void solve(const Vector& a, const Vector& b, const Vector& c, const Vector& d, const Body& crank, const Body& rod,
             const Body& rocker, const Vector& g, Reference& out) const {
    std::array<std::array<Real, 10>, 9> m{};
    const auto link = [&](std::size_t row, const Body& l, std::size_t in, const Vector& at_in, std::size_t other,
                          const Vector& at_other, int sign) {
      const Vector rhs = l.mass * (l.com_accel - g);
      m[row][in] = 1, m[row + 1][in + 1] = 1;
      m[row][other] = sign, m[row + 1][other + 1] = sign;
      m[row + 2][in] = -(at_in - l.com).y, m[row + 2][in + 1] = (at_in - l.com).x;
      m[row + 2][other] = -sign * (at_other - l.com).y, m[row + 2][other + 1] = sign * (at_other - l.com).x;
      m[row][9] = rhs.x, m[row + 1][9] = rhs.y, m[row + 2][9] = l.inertia * l.accel;
    };
    link(0, crank, 0, a, 2, b, -1);
    link(3, rod, 2, b, 4, c, -1);
    link(6, rocker, 6, d, 4, c, 1);
    m[2][8] = 1;
    eliminate(m);
    const auto force = [&](std::size_t i) { return Vector{m[i][9], m[i + 1][9]}; };
    const Vector on_hull = Real(-1) * (force(0) + force(6));
    out.hull_force = toHull(on_hull);
    out.drive_torque = m[8][9];
    out.hull_torque = -cross(a - d, force(0)) - out.drive_torque;
    out.r01 = toHull(force(0)), out.r12 = toHull(force(2)), out.r23 = toHull(force(4)), out.r03 = toHull(force(6));
  }

  static void eliminate(std::array<std::array<Real, 10>, 9>& m) {
    for (std::size_t k = 0; k < 9; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k; i < 9; ++i) {
        if (abs(m[i][k]) > abs(m[pivot][k])) pivot = i;
      }
      std::swap(m[k], m[pivot]);
      for (std::size_t i = 0; i < 9; ++i) {
        if (i == k || m[i][k] == 0) continue;
        const Real factor = m[i][k] / m[k][k];
        for (std::size_t j = k; j < 10; ++j) m[i][j] -= factor * m[k][j];
      }
    }
    for (std::size_t k = 0; k < 9; ++k) m[k][9] /= m[k][k];
  }

  /// Mechanism frame <-> hull (x, z): a mirror, its own inverse (model.md 1).
  Vector toHull(const Vector& v) const {
    const Real angle = p_.rocker_com_angle;
    return {-(cos(angle) * v.x + sin(angle) * v.y), -sin(angle) * v.x + cos(angle) * v.y};
  }
  Vector fromHull(const Vector& v) const { return toHull(v); }

  HammerParameters p_;
  bool with_links_;
  Real l0_, l1_, l2_, l3_;
};

}  // namespace hammer_loads::test
