#include <algorithm>
#include <cmath>

#include "hammer_loads/grapple/branches.h"
#include "hammer_loads/grapple/grapple.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kReferenceTolerance = 0.05;  ///< tolerance of the reference angles [rad], which only distinguish poses
constexpr double kClosedTolerance = 1e-9;     ///< largest distance of P beyond the axis when closed [m]
constexpr double kSameTheta1 = 1e-6;          ///< [rad]; distinguishes the drive's two assemblies

void checkNumbers(GrappleParameters p, std::vector<std::string>& problems) {
  using Range = GrappleKey::Range;
  for (const GrappleKey& key : kGrappleKeys) {
    const double value = key.of(p);
    const bool in_range = key.range == Range::kAny || value > 0.0 || (key.range == Range::kNotNegative && value == 0.0);
    if (std::isfinite(value) && in_range) continue;
    const char* allowed = key.range == Range::kPositive      ? "> 0 and finite"
                          : key.range == Range::kNotNegative ? ">= 0 and finite"
                                                             : "finite";
    problems.push_back(format("%s: %.9g %s, must be %s", key.key, value, key.unit, allowed));
  }
  if (std::abs(p.drive_sign) != 1) problems.push_back(format("drive_sign: %d, must be 1 or -1", p.drive_sign));
}

double apart(double angle, double other) { return std::abs(std::remainder(angle - other, kTwoPi)); }

}  // namespace

const char* nameOf(SliderLimit::Kind kind) noexcept {
  constexpr const char* kNames[] = {"dead centre", "fold", "crossing of branches"};
  return kNames[static_cast<std::size_t>(kind)];
}

const char* nameOf(SliderRefusal refusal) noexcept {
  constexpr const char* kNames[kSliderRefusalKinds] = {
      "accepted", "not finite", "out of reach", "across dead centre", "across fold", "outside stroke", "not found"};
  return kNames[static_cast<std::size_t>(refusal)];
}

Grapple::Grapple(const GrappleParameters& p)
    : parameters_(p), drive_(p), group_(p), a_by_h_((p.o1a / p.o1h) * direction(-p.ho1a)) {}

Checked<Grapple> Grapple::make(const GrappleParameters& parameters) {
  Checked<Grapple> result;
  checkNumbers(parameters, result.problems);
  if (!result.problems.empty()) return result;
  Grapple grapple(parameters);
  if (!grapple.findReference(result.problems)) return result;
  grapple.findLimits();
  grapple.checkStroke(result.problems);
  if (result.problems.empty()) result.value = grapple;
  return result;
}

bool Grapple::findReference(std::vector<std::string>& problems) {
  const GrappleParameters& p = parameters_;
  const std::optional<DriveMotion> drive = drive_.at(p.reference_slider);
  if (!drive) {
    problems.push_back(format(
        "reference_slider_m: %.9g m, out of reach: |O1G| = %.9g m, must lie between |gh - o1h| = %.9g m and gh + "
        "o1h = %.9g m",
        p.reference_slider, norm(Planar{p.slider_x, p.reference_slider} - p.o1), std::abs(p.gh - p.o1h), p.gh + p.o1h));
    return false;
  }
  const Planar a = p.o1 + arm(*drive);
  const Branches all = enumerateBranches(group_, a);
  std::string found;
  double nearest = kReferenceTolerance;
  std::optional<GroupPose> reference;
  for (int i = 0; i < all.count; ++i) {
    const Branches::Branch& branch = all.branch[static_cast<std::size_t>(i)];
    found += format(" (%.6g, %.6g)", branch.theta2, branch.theta5);
    const double distance = std::max(apart(branch.theta2, p.reference_ab), apart(branch.theta5, p.reference_od));
    if (!(distance <= nearest)) continue;
    nearest = distance;
    reference = group_.pose(a, branch.theta2, branch.theta5);
  }
  if (reference) {
    reference_ = motionOf(p.reference_slider, *drive, *reference, group_.closure(*reference));
    return true;
  }
  const char* lead = all.self_motion ? "; and the links can move with the slider held" : "";
  problems.push_back(
      format("reference_ab_angle_rad: (%.9g, %.9g) rad with reference_od_angle_rad, must be within %g rad of "
             "a pose at reference_slider_m = %.9g m:%s%s",
             p.reference_ab, p.reference_od, kReferenceTolerance, p.reference_slider,
             found.empty() ? " there is none" : found.c_str(), lead));
  return false;
}

void Grapple::findLimits() {
  const FirstRocker rocker{parameters_.o1, parameters_.o1a};
  const CurvePoint start{drive_.theta1(reference_.slider), reference_.theta2, reference_.theta5};
  const std::array<BranchEnd, 2> ends = {findBranchEnd(group_, rocker, start, -1, kTwoPi),
                                         findBranchEnd(group_, rocker, start, +1, kTwoPi)};
  const Reach reach = *drive_.reachAround(reference_.slider);
  lower_ = limit(reach, ends, -1);
  upper_ = limit(reach, ends, +1);
}

SliderLimit Grapple::limit(const Reach& reach, const std::array<BranchEnd, 2>& ends, int side) const {
  SliderLimit nearest{SliderLimit::Kind::kDeadCentre, side < 0 ? reach.low : reach.high};
  for (const BranchEnd& end : ends) {
    if (end.kind == BranchEnd::Kind::kNone) continue;
    for (const double slider : drive_.slidersAt(end.point.theta1)) {
      const bool between = side * slider > side * reference_.slider && side * slider < side * nearest.slider;
      if (!between || !drive_.at(slider) || std::abs(drive_.theta1(slider) - end.point.theta1) > kSameTheta1) continue;
      nearest = {end.kind == BranchEnd::Kind::kFold ? SliderLimit::Kind::kFold : SliderLimit::Kind::kSingular, slider};
    }
  }
  return nearest;
}

void Grapple::checkStroke(std::vector<std::string>& problems) const {
  const GrappleParameters& p = parameters_;
  const std::pair<const char*, double> named[] = {{"reference_slider_m", p.reference_slider},
                                                  {"slider_closed_m", p.slider_closed},
                                                  {"slider_open_m", p.slider_open}};
  for (const auto& [key, slider] : named) {
    if (inside(slider)) continue;
    problems.push_back(format("%s: %.12g m, must lie between the %s at %.13g m and the %s at %.13g m", key, slider,
                              nameOf(lower_.kind), lower_.slider, nameOf(upper_.kind), upper_.slider));
  }
  if (!problems.empty()) return;
  const std::optional<GrappleMotion> closed = at(p.slider_closed), open = at(p.slider_open);
  if (!closed || !open) {
    problems.push_back(format("slider_closed_m: %.12g m, no pose found there or at slider_open_m", p.slider_closed));
    return;
  }
  if (closed->p.re < -kClosedTolerance) {
    problems.push_back(
        format("slider_closed_m: %.12g m, must not put the jaw edge beyond the axis (x = %.6g m): the jaws "
               "would overlap",
               p.slider_closed, closed->p.re));
  }
  if (!(open->p.re > closed->p.re)) {
    problems.push_back(
        format("slider_open_m: %.12g m, must put the jaw edge farther out (x = %.6g m) than "
               "slider_closed_m does (x = %.6g m)",
               p.slider_open, open->p.re, closed->p.re));
  }
}

std::string Grapple::explain(SliderRefusal refusal, double slider, const std::string& name) const {
  const GrappleParameters& p = parameters_;
  const std::string given = format("%s: %.12g m, %s: must ", name.c_str(), slider, nameOf(refusal));
  switch (refusal) {
    case SliderRefusal::kNone:
      return {};
    case SliderRefusal::kNotFinite:
      return given + "be a finite number";
    case SliderRefusal::kOutOfReach:
    case SliderRefusal::kAcrossDeadCentre:
    case SliderRefusal::kAcrossFold:
      return given + format("lie between the %s at %.13g m and the %s at %.13g m", nameOf(lower_.kind), lower_.slider,
                            nameOf(upper_.kind), upper_.slider);
    case SliderRefusal::kOutsideStroke:
      return given + format("lie between %.9g m and %.9g m (+- %.3g m)", std::min(p.slider_closed, p.slider_open),
                            std::max(p.slider_closed, p.slider_open), p.slider_margin);
    case SliderRefusal::kNotFound:
      break;
  }
  return given + "have a pose on the working branch";
}

}  // namespace hammer_loads
