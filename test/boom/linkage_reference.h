/// Reference of the bucket linkage from the lengths of its links only: closure by Newton's method, forces by the
/// equilibrium of every body. Shares no code with src/hammer_loads/boom.
#pragma once

#include <Eigen/LU>

#include "hammer_loads/boom/bucket_linkage.h"

namespace hammer_loads::test {

/// Linkage in a plane (x, z). Rotations are positive about +y, from z to x.
struct LinkageReference {
  using Real = long double;
  using Point = Eigen::Matrix<Real, 2, 1>;

  Point base, pivot, driven;  ///< cylinder base, guide pivot, coupler's pin at zero, from the joint
  Real guide{}, coupler{};
  Real branch{}, sense{1};

  LinkageReference(const BucketLinkage::Pins& pins, const BucketLinkageParameters& p)
      : base(pins.base.cast<Real>()),
        pivot(pins.guide.cast<Real>()),
        driven(pins.driven.cast<Real>()),
        guide(p.guide_length),
        coupler(p.coupler_length),
        branch(p.branch),
        sense(pins.sense) {}

  static Point turned(const Point& v, Real by) {
    return {v.x() * std::cos(by) + v.y() * std::sin(by), v.y() * std::cos(by) - v.x() * std::sin(by)};
  }
  static Real moment(const Point& r, const Point& f) { return r.y() * f.x() - r.x() * f.y(); }  ///< about +y

  Point drivenPin(Real q) const { return turned(driven, sense * q); }

  /// Returns the common pin by Newton's method, from a start on the branch's side.
  Point rodPin(Real q) const {
    const Point d = drivenPin(q);
    Point c = pivot + guide * turned((d - pivot).normalized(), branch * 0.7L);
    for (int i = 0; i < 60; ++i) {
      const Point g = c - pivot, e = c - d;
      Eigen::Matrix<Real, 2, 2> slope;
      slope << 2 * g.x(), 2 * g.y(), 2 * e.x(), 2 * e.y();
      c -= slope.partialPivLu().solve(Point(g.squaredNorm() - guide * guide, e.squaredNorm() - coupler * coupler));
    }
    return c;
  }
  Real length(Real q) const { return (rodPin(q) - base).norm(); }

  /// Returns the derivative by differences of order 8.
  template <typename Function>
  static Real slope(const Function& f, Real at) {
    constexpr Real h = 1.0L / 8192, kWeight[] = {4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280};
    Real sum = 0;
    for (int k = 1; k <= 4; ++k) sum += kWeight[k - 1] / h * (f(at + k * h) - f(at - k * h));
    return sum;
  }
  Real arm(Real q) const {
    return slope([this](Real x) { return length(x); }, q);
  }

  /// Forces on the pins of the joint's two links, per N of the cylinder's push.
  struct Forces {
    Point base, pivot, driven;
  };
  /// Returns the pin forces. Unknown are those at both ends of guide and coupler. The equations are two forces and a
  /// moment for each link, and the balance of the common pin.
  Forces forces(Real q) const {
    const Point c = rodPin(q), d = drivenPin(q), push = (c - base).normalized();
    Eigen::Matrix<Real, 8, 8> A = Eigen::Matrix<Real, 8, 8>::Zero();
    Eigen::Matrix<Real, 8, 1> b = Eigen::Matrix<Real, 8, 1>::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      A(axis, axis) = A(axis, 2 + axis) = 1;              // guide
      A(2 + axis, 4 + axis) = A(2 + axis, 6 + axis) = 1;  // coupler
      A(4 + axis, 2 + axis) = A(4 + axis, 4 + axis) = 1;  // common pin: the rod's push acts on both
      b[4 + axis] = push[axis];
    }
    const auto about = [&](int row, int column, const Point& r) {
      A(row, column) = r.y(), A(row, column + 1) = -r.x();
    };
    about(6, 2, c - pivot);
    about(7, 4, c - d);
    const Eigen::Matrix<Real, 8, 1> x = A.fullPivLu().solve(b);
    return {-push, -x.segment<2>(0), -x.segment<2>(6)};
  }
};

}  // namespace hammer_loads::test
