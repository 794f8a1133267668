#include "hammer_loads/grapple/lever_group.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/grapple/grapple_parameters.h"

namespace hammer_loads {
namespace {

/// Residual of the closures below which a pose cannot be improved, relative to the squared size of the group: the
/// rounding of sums of some five terms of that size.
constexpr double kClosureRounding = 8.0 * 2.220446049250313e-16;
constexpr double kLargestStep = 0.3;  ///< largest Newton step [rad]: longer ones leave the basin
constexpr double kLastStep = 1e-10;   ///< [rad]: its square is below rounding
constexpr double kNoisyStep = 1e-8;   ///< [rad]: beside a fold steps may stay as long as this; its square is rounding
constexpr double kSlightTurn = 5e-3;  ///< [rad]: its 6th power over 720 is below rounding

/// Turning by less than kSlightTurn, without trigonometry.
class SlightTurn {
 public:
  explicit SlightTurn(double angle) noexcept {
    const double square = angle * angle;
    sine_ = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0));
    cosine_less_1_ = -0.5 * square * (1.0 - square / 12.0);
  }
  Planar operator()(Planar v) const noexcept { return v + (sine_ * turned(v) + cosine_less_1_ * v); }

 private:
  double sine_, cosine_less_1_;
};

}  // namespace

LeverGroup::LeverGroup(const GrappleParameters& p)
    : shape_{p.ab,
             p.bd,
             p.ce,
             p.od,
             (p.ac / p.ab) * direction(p.bac),
             (p.oe / p.od) * direction(p.doe),
             (p.bp / p.bd) * direction(p.dbp)} {
  const double size = std::max({p.ab, p.ac, p.bd, p.ce, p.od, p.oe});
  closure_rounding_ = kClosureRounding * size * size;
}

GroupPose LeverGroup::pose(Planar a, double theta2, double theta5) const noexcept {
  GroupPose p;
  p.theta2 = theta2;
  p.theta5 = theta5;
  p.b = shape_.ab * direction(theta2);
  p.c = p.b * shape_.c_by_ab;
  p.d = shape_.od * direction(theta5);
  p.e = p.d * shape_.e_by_od;
  p.u = p.d - a - p.b;
  p.v = p.e - a - p.c;
  return p;
}

Closure LeverGroup::closure(const GroupPose& p) const noexcept {
  Closure k;
  k.f1 = 0.5 * (squaredNorm(p.u) - shape_.bd * shape_.bd);
  k.f2 = 0.5 * (squaredNorm(p.v) - shape_.ce * shape_.ce);
  k.j11 = -cross(p.b, p.u);  // -u . i b
  k.j12 = cross(p.d, p.u);
  k.j21 = -cross(p.c, p.v);
  k.j22 = cross(p.e, p.v);
  k.determinant = k.j11 * k.j22 - k.j12 * k.j21;
  return k;
}

void LeverGroup::turn(Planar a, double step2, double step5, GroupPose& p) const noexcept {
  if (std::max(std::abs(step2), std::abs(step5)) > kSlightTurn) {
    p = pose(a, p.theta2 + step2, p.theta5 + step5);
    return;
  }
  const SlightTurn turn2(step2), turn5(step5);
  p.theta2 += step2;
  p.theta5 += step5;
  p.b = turn2(p.b);
  p.c = turn2(p.c);
  p.d = turn5(p.d);
  p.e = turn5(p.e);
  p.u = p.d - a - p.b;
  p.v = p.e - a - p.c;
}

bool LeverGroup::solve(Planar a, int most_iterations, GroupPose& p, Closure& k) const noexcept {
  k = closure(p);
  for (int i = 0; i < most_iterations; ++i) {
    const double inverse = 1.0 / k.determinant;
    const double step2 = (k.j12 * k.f2 - k.j22 * k.f1) * inverse;
    const double step5 = (k.j21 * k.f1 - k.j11 * k.f2) * inverse;
    const double longest = std::max(std::abs(step2), std::abs(step5));
    const bool met = isMet(k);
    if (met && !(longest < kNoisyStep)) return true;
    if (!(longest < 1e300)) return false;
    const double shortening = longest > kLargestStep ? kLargestStep / longest : 1.0;
    turn(a, shortening * step2, shortening * step5, p);
    k = closure(p);
    if (met || longest < kLastStep) return true;
  }
  return isMet(k);
}

GroupRates LeverGroup::rates(Planar o1a, const GroupPose& p, const Closure& k) const noexcept {
  const double inverse = 1.0 / k.determinant;
  // J x = -(y1, y2)
  const auto solution = [&](double y1, double y2, double& x2, double& x5) {
    x2 = (k.j12 * y2 - k.j22 * y1) * inverse;
    x5 = (k.j21 * y1 - k.j11 * y2) * inverse;
  };
  GroupRates r;
  solution(-cross(o1a, p.u), -cross(o1a, p.v), r.w2, r.w5);  // df/dtheta1 = -(u . i o1a, v . i o1a)
  const double ww2 = r.w2 * r.w2, ww5 = r.w5 * r.w5;
  r.du = turned(r.w5 * p.d - o1a - r.w2 * p.b);
  const Planar dv = turned(r.w5 * p.e - o1a - r.w2 * p.c);
  const Planar ddu_at_rest = o1a + ww2 * p.b - ww5 * p.d;  // without the second derivatives of the angles
  const Planar ddv_at_rest = o1a + ww2 * p.c - ww5 * p.e;
  solution(squaredNorm(r.du) + dot(p.u, ddu_at_rest), squaredNorm(dv) + dot(p.v, ddv_at_rest), r.z2, r.z5);
  r.ddu = ddu_at_rest + turned(r.z5 * p.d - r.z2 * p.b);
  r.dp = turned(o1a + r.w2 * p.b) + r.du * shape_.p_by_bd;
  r.ddp = turned(r.z2 * p.b) - o1a - ww2 * p.b + r.ddu * shape_.p_by_bd;
  return r;
}

}  // namespace hammer_loads
