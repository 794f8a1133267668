/// The loads by the formulas that P0 prints, signs corrected (model.md 7).
///
/// All of (1) to (14): positions by inverse trigonometry or by the sines and cosines of the same triangles, transfer
/// functions, pin forces from the group of rod and rocker, hull force as the sum of both pivots' reactions. P0 knows
/// neither crank acceleration nor weight: they are added where they belong, to the inertia force at S in (1). Crank and
/// rod are massless.
#pragma once

#include <cmath>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads::test {

/// How rod and rocker find their place.
enum class Positions {
  kInverseTrigonometry,  ///< (2), (3) as printed: arctg and arccos, then sine and cosine of the angles
  kTrigonometry,         ///< the same triangles by the law of cosines and sqrt(1 - cos^2), without an angle
};

struct LinkLoads {
  HullWrench wrench;
  PinReactions pins;
};

class PrintedFormulas {
 public:
  /// Lengths as given: the printed formulas know no correction.
  PrintedFormulas(const HammerParameters& p, Positions positions) : p_(p), positions_(positions) {
    l0_ = p.lengths.pivot_distance / p.lengths.crank;
    l2_ = p.lengths.rod / p.lengths.crank;
    l3_ = p.lengths.rocker / p.lengths.crank;
    a_ = (l0_ + 1.0) * (l0_ + 1.0) / (4.0 * l0_);
    b_ = (1.0 - l0_ * l0_) / (2.0 * l0_);
    c_ = l2_ * (l0_ - 1.0) / (2.0 * l0_) + 1.0;
    g_ = l2_ * l3_ / l0_ - 1.0;
    com_inertia_ = p.rocker_inertia_about_pivot - p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance;
    cos_a_ = std::cos(p.rocker_com_angle), sin_a_ = std::sin(p.rocker_com_angle);
  }

  struct Transfer {
    double u{};   ///< dpsi/dphi [-]
    double du{};  ///< d2psi/dphi2 [1/rad]
  };

  /// (4), (5); angle in (0, 2 pi) [rad].
  Transfer transfer(double angle) const noexcept {
    const double s = std::sin(0.5 * angle), y = std::cos(0.5 * angle), yy = y * y;
    const double bracket = (2.0 * l0_ * s * s + l2_ * (l0_ - 1.0)) * y / std::sqrt(l2_ * l3_ / l0_ - s * s);
    const double root = std::sqrt((g_ + yy) * (g_ + yy) * (g_ + yy));
    const double sum = b_ * y + ((g_ + 2.0 * (c_ - a_)) * yy * yy + g_ * (c_ - 3.0 * a_) * yy + a_ * c_ * g_) / root;
    return {(1.0 - l0_ + 2.0 * l0_ * s * s + bracket) / squaredBD(angle), -s / (4.0 * (a_ - yy) * (a_ - yy)) * sum};
  }

  /// angle in (0, 2 pi) [rad]. The drive torque, which P0 does not print, is left at zero.
  LinkLoads operator()(double angle, double speed, double acceleration, Gravity gravity) const noexcept {
    const Transfer t = transfer(angle);
    const Places places = positions_ == Positions::kInverseTrigonometry ? byAngles(angle) : byTriangles(angle);
    return reactions(places, t.u * speed, t.du * speed * speed + t.u * acceleration, gravity);
  }

 private:
  /// Directions e^(i psi), e^(i beta) and the sine and cosine of psi - beta.
  struct Places {
    Planar psi, beta, mu;
  };

  double squaredBD(double angle) const noexcept { return 1.0 + l0_ * l0_ - 2.0 * l0_ * std::cos(angle); }

  Places byAngles(double angle) const noexcept {
    const double d = squaredBD(angle);
    const double to_d = std::atan(std::sin(angle) / (l0_ - std::cos(angle)));
    const double psi =
        3.14159265358979323846 - to_d - std::acos((l3_ * l3_ - l2_ * l2_ + d) / (2.0 * l3_ * std::sqrt(d)));  // (2)
    const double beta = std::acos((l2_ * l2_ - l3_ * l3_ + d) / (2.0 * l2_ * std::sqrt(d))) - to_d;           // (3)
    return {
        {std::cos(psi), std::sin(psi)}, {std::cos(beta), std::sin(beta)}, {std::cos(psi - beta), std::sin(psi - beta)}};
  }

  Places byTriangles(double angle) const noexcept {
    const double d = squaredBD(angle);
    const double bd = std::sqrt(d);
    const Planar from_d = (1.0 / bd) * Planar{l0_ - std::cos(angle), -std::sin(angle)};  // direction B->D
    const double cos_d = (l3_ * l3_ - l2_ * l2_ + d) / (2.0 * l3_ * bd);
    const double cos_b = (l2_ * l2_ - l3_ * l3_ + d) / (2.0 * l2_ * bd);
    const Planar at_d{cos_d, std::sqrt(1.0 - cos_d * cos_d)}, at_b{cos_b, std::sqrt(1.0 - cos_b * cos_b)};
    const Planar psi = -1.0 * (from_d * conj(at_d)), beta = from_d * at_b;
    return {psi, beta, psi * conj(beta)};
  }

  LinkLoads reactions(const Places& q, double rate, double accel, Gravity gravity) const noexcept {
    const double mass = p_.rocker_mass, ls = p_.rocker_com_distance, l3 = p_.lengths.rocker;
    // (1), along D->S and across; Deviates: signs, weight.
    const double pn = mass * (ls * rate * rate - q.psi.re * gravity.x + q.psi.im * gravity.z);
    const double pt = mass * (-ls * accel + q.psi.im * gravity.x + q.psi.re * gravity.z);
    const double moment = -com_inertia_ * accel;                                 // Deviates: about S
    const double r03t = moment / l3 + pt * (ls / l3 - cos_a_) - pn * sin_a_;     // (9)
    const double r12 = (pt * cos_a_ + pn * sin_a_ + r03t) / q.mu.im;             // (11)
    const Planar com = Planar{cos_a_, sin_a_} * q.mu;                            // e^(i (psi + a - beta))
    const double r03n = (pn * com.im + pt * com.re + r03t * q.mu.re) / q.mu.im;  // (10)
    const Planar rocker = q.psi * Planar{cos_a_, -sin_a_}, rod = q.beta * Planar{cos_a_, -sin_a_};
    LinkLoads loads;
    loads.pins.rod_on_rocker = {-r12 * rod.re, r12 * rod.im};
    loads.pins.crank_on_rod = loads.pins.hull_on_crank = loads.pins.rod_on_rocker;
    loads.pins.hull_on_rocker = {r03n * rocker.re + r03t * rocker.im, -r03n * rocker.im + r03t * rocker.re};
    // (13), (14)
    loads.wrench.force_x = r12 * rod.re - r03n * rocker.re - r03t * rocker.im;
    loads.wrench.force_z = -r12 * rod.im + r03n * rocker.im - r03t * rocker.re;
    loads.wrench.torque_y = moment + pt * ls;
    return loads;
  }

  HammerParameters p_;
  Positions positions_;
  double l0_, l2_, l3_;   ///< ratios to the crank
  double a_, b_, c_, g_;  ///< P0's constants of (5)
  double com_inertia_, cos_a_, sin_a_;
};

}  // namespace hammer_loads::test
