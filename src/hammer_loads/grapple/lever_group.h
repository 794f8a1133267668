/// The grapple's four-link group: lever A-B-C, jaw B-D-P, rod C-E and main rocker O-E-D between the pins A and O.
///
/// Class IV of order 2: no chain of dyads, so no closed form for one pose; up to six poses for one place of A
/// (branches.h lists them all). Unknowns are theta2 = direction of AB and theta5 = direction of OD; the closures
/// f1 = (|BD|^2 - bd^2)/2 and f2 = (|CE|^2 - ce^2)/2 determine them. The group is singular where det J = 0, J = df by
/// (theta2, theta5): the lines AO, BD and CE then meet in one point or are parallel. Derivation: doc/grapple.md.
#pragma once

#include "hammer_loads/grapple/vectors.h"

namespace hammer_loads {

struct GrappleParameters;

/// One pose of the group; vectors in the grapple frame [m].
struct GroupPose {
  double theta2{}, theta5{};  ///< directions of AB and OD [rad]
  Planar b, c;                ///< from A to B and to C
  Planar d, e;                ///< from O to D and to E
  Planar u, v;                ///< from B to D and from C to E
};

/// Closures and their derivatives by (theta2, theta5).
struct Closure {
  double f1{}, f2{};                  ///< [m2]
  double j11{}, j12{}, j21{}, j22{};  ///< [m2]
  double determinant{};               ///< det J [m4]
};

/// Derivatives of the pose by theta1, the direction of O1A.
struct GroupRates {
  double w2{}, w5{};  ///< first derivative of theta2, theta5 [-]
  double z2{}, z5{};  ///< second derivative [1/rad]
  Planar du, ddu;     ///< derivatives of u [m/rad], [m/rad2]
  Planar dp, ddp;     ///< derivatives of the jaw edge P
};

/// The group's lengths [m] and the third points of its ternary links in units of their first side.
struct GroupShape {
  double ab{}, bd{}, ce{}, od{};
  Planar c_by_ab;  ///< AC = AB * c_by_ab, complex product
  Planar e_by_od;  ///< OE = OD * e_by_od
  Planar p_by_bd;  ///< BP = BD * p_by_bd
};

class LeverGroup {
 public:
  /// Needs finite values and positive lengths (Grapple::make checks them).
  explicit LeverGroup(const GrappleParameters& parameters);

  /// Links as the angles put them, closed or not; a = place of pin A.
  GroupPose pose(Planar a, double theta2, double theta5) const noexcept;
  Closure closure(const GroupPose& pose) const noexcept;

  /// Newton with the analytic Jacobian, steps of at most 0.3 rad; true after a step below 1e-10 rad (quadratic: the
  /// next one would be rounding) or, beside a fold, once both closures are met to rounding. The closure belongs to the
  /// pose.
  bool solve(Planar a, int most_iterations, GroupPose& pose, Closure& closure) const noexcept;

  /// o1a = from O1 to A. Precondition: det J != 0.
  GroupRates rates(Planar o1a, const GroupPose& pose, const Closure& closure) const noexcept;

  /// Jaw edge P [m]. A short side BD would magnify the rounding left in its length: f1 takes that out.
  Planar edge(Planar a, const GroupPose& pose, const Closure& closure) const noexcept {
    const double shortening = 1.0 - closure.f1 / (shape_.bd * shape_.bd);
    return a + pose.b + shortening * (pose.u * shape_.p_by_bd);
  }

  /// Returns true if both closures are met to rounding.
  bool isMet(const Closure& k) const noexcept {
    return std::abs(k.f1) <= closure_rounding_ && std::abs(k.f2) <= closure_rounding_;
  }

  const GroupShape& shape() const noexcept { return shape_; }

 private:
  void turn(Planar a, double step2, double step5, GroupPose& pose) const noexcept;

  GroupShape shape_;
  double closure_rounding_;  ///< [m2]
};

}  // namespace hammer_loads
