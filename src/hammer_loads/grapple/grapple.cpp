#include "hammer_loads/grapple/grapple.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/grapple/branches.h"

namespace hammer_loads {
namespace {

constexpr int kMostIterations = 20;
constexpr double kLargestPrediction = 0.3;  ///< largest predicted step along the branch [rad]
constexpr double kLargestCorrection = 0.1;  ///< by Newton after the prediction [rad]: more may mean another branch
constexpr double kSlopeMismatch = 0.1;      ///< largest relative mismatch of a step and the mean slope of its ends
constexpr double kSlopeNoise = 1e-6;        ///< [rad]
constexpr int kMostSteps = 400;
/// Closer to a limit than this [m] two branches lie within the square root of rounding of each other: which is which
/// does not show (4096 eps at one metre).
constexpr double kLimitGuard = 1e-12;

double longer(double x, double y) noexcept { return std::max(std::abs(x), std::abs(y)); }

}  // namespace

bool Grapple::inside(double slider) const noexcept {
  return slider > lower_.slider + kLimitGuard && slider < upper_.slider - kLimitGuard;
}

SliderRefusal Grapple::judge(double slider) const noexcept {
  if (!std::isfinite(slider)) return SliderRefusal::kNotFinite;
  if (inside(slider)) return SliderRefusal::kNone;
  if (!drive_.at(slider)) return SliderRefusal::kOutOfReach;
  const SliderLimit& passed = slider < reference_.slider ? lower_ : upper_;
  return passed.kind == SliderLimit::Kind::kDeadCentre ? SliderRefusal::kAcrossDeadCentre : SliderRefusal::kAcrossFold;
}

SliderRefusal Grapple::judgeInStroke(double slider) const noexcept {
  const SliderRefusal refusal = judge(slider);
  if (refusal != SliderRefusal::kNone) return refusal;
  const auto [low, high] = std::minmax(parameters_.slider_closed, parameters_.slider_open);
  const double margin = parameters_.slider_margin;
  return slider >= low - margin && slider <= high + margin ? SliderRefusal::kNone : SliderRefusal::kOutsideStroke;
}

GrappleMotion Grapple::motionOf(double slider, const DriveMotion& drive, const GroupPose& pose,
                                const Closure& closure) const noexcept {
  const GrappleParameters& k = parameters_;
  const Planar o1a = arm(drive);
  const GroupRates r = group_.rates(o1a, pose, closure);
  const double t1 = drive.dtheta1, t2 = drive.ddtheta1, tt = t1 * t1;
  GrappleMotion m;
  m.slider = slider;
  m.g = {k.slider_x, slider};
  m.h = k.o1 + drive.o1h;
  m.a = k.o1 + o1a;
  m.b = m.a + pose.b;
  m.c = m.a + pose.c;
  m.d = pose.d;
  m.e = pose.e;
  m.p = group_.edge(m.a, pose, closure);
  m.dp = t1 * r.dp;
  m.ddp = tt * r.ddp + t2 * r.dp;
  m.theta2 = pose.theta2;
  m.theta5 = pose.theta5;
  m.link1 = {t1, t2};
  m.link2 = {r.w2 * t1, r.z2 * tt + r.w2 * t2};
  m.link5 = {r.w5 * t1, r.z5 * tt + r.w5 * t2};
  // |u| is constant, so u x u' and u x u'' are |u|^2 times the derivatives of its direction.
  const double inverse = 1.0 / (k.bd * k.bd);
  const double w3 = cross(pose.u, r.du) * inverse, z3 = cross(pose.u, r.ddu) * inverse;
  m.jaw = {w3 * t1, z3 * tt + w3 * t2};
  m.determinant = closure.determinant;
  return m;
}

bool Grapple::step(const GrappleMotion& from, double slider, GrappleMotion& to) const noexcept {
  const std::optional<DriveMotion> drive = drive_.at(slider);
  if (!drive) return false;
  const double ds = slider - from.slider;
  const double predicted2 = ds * (from.link2.d + 0.5 * ds * from.link2.dd);
  const double predicted5 = ds * (from.link5.d + 0.5 * ds * from.link5.dd);
  if (!(longer(predicted2, predicted5) <= kLargestPrediction)) return false;

  const Planar a = parameters_.o1 + arm(*drive);
  GroupPose pose = group_.pose(a, from.theta2 + predicted2, from.theta5 + predicted5);
  Closure closure;
  if (!group_.solve(a, kMostIterations, pose, closure)) return false;
  const double moved2 = pose.theta2 - from.theta2, moved5 = pose.theta5 - from.theta5;
  if (!(longer(moved2 - predicted2, moved5 - predicted5) <= kLargestCorrection)) return false;
  if (!(closure.determinant * reference_.determinant > 0.0)) return false;

  to = motionOf(slider, *drive, pose, closure);
  const double mismatch =
      longer(moved2 - 0.5 * ds * (from.link2.d + to.link2.d), moved5 - 0.5 * ds * (from.link5.d + to.link5.d));
  return mismatch <= kSlopeMismatch * longer(moved2, moved5) + kSlopeNoise;
}

bool Grapple::walk(const GrappleMotion& from, double slider, GrappleMotion& to) const noexcept {
  GrappleMotion here = from;
  double stride = slider - from.slider;
  for (int i = 0; i < kMostSteps; ++i) {
    const bool last = std::abs(stride) >= std::abs(slider - here.slider);
    const double next = last ? slider : here.slider + stride;
    if (!last && next == here.slider) return false;
    if (!step(here, next, to)) {
      stride = 0.5 * (next - here.slider);
      continue;
    }
    if (last) return true;
    here = to;
    stride *= 2.0;
  }
  return false;
}

std::optional<GrappleMotion> Grapple::follow(const GrappleMotion& from, double slider) const noexcept {
  if (!inside(slider)) return std::nullopt;
  GrappleMotion to;
  if (step(from, slider, to) || walk(from, slider, to)) return to;
  return at(slider);
}

std::optional<GrappleMotion> Grapple::at(double slider) const noexcept {
  if (!inside(slider)) return std::nullopt;
  const DriveMotion drive = *drive_.at(slider);
  const Planar a = parameters_.o1 + arm(drive);
  const Branches all = enumerateBranches(group_, a);
  const Branches::Branch* candidate = nullptr;
  int candidates = 0;
  for (int i = 0; i < all.count; ++i) {
    const Branches::Branch& branch = all.branch[static_cast<std::size_t>(i)];
    if (!(branch.determinant * reference_.determinant > 0.0)) continue;
    candidate = &branch;
    ++candidates;
  }
  if (candidates == 1) {  // the working branch is among them, and det J keeps its sign along it
    const GroupPose pose = group_.pose(a, candidate->theta2, candidate->theta5);
    return motionOf(slider, drive, pose, group_.closure(pose));
  }
  GrappleMotion to;
  if (walk(reference_, slider, to)) return to;
  return std::nullopt;
}

std::array<LinkDirection, 6> Grapple::linkDirections(const GrappleMotion& m) const noexcept {
  const GrappleParameters& k = parameters_;
  const Planar o1h = m.h - k.o1, o1a = m.a - k.o1, ac = m.c - m.a, ce = m.e - m.c, gh = m.h - m.g;
  const Planar dce = turned(m.link5.d * m.e - m.link1.d * o1a - m.link2.d * ac);
  const Planar dgh = turned(m.link1.d * o1h) - Planar{0.0, 1.0};
  return {{{angleOf(o1a), m.link1.d},
           {angleOf(m.b - m.a), m.link2.d},
           {angleOf(m.d - m.b), m.jaw.d},
           {angleOf(ce), cross(ce, dce) / (k.ce * k.ce)},
           {angleOf(m.d), m.link5.d},
           {angleOf(gh), cross(gh, dgh) / (k.gh * k.gh)}}};
}

}  // namespace hammer_loads
