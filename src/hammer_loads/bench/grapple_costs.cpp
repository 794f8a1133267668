#include "hammer_loads/bench/grapple_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "hammer_loads/bench/explicit_curve.h"
#include "hammer_loads/grapple/branches.h"
#include "hammer_loads/grapple/grapple_tracker.h"

namespace hammer_loads::accuracy {
namespace {

constexpr std::size_t kSwing = 2000;  // samples of one swing over the stroke and back: 2 s at 1 kHz
constexpr std::size_t kJudged = 100;  // of them, compared with the reference

std::vector<double> swing(const GrappleParameters& p) {
  const double middle = 0.5 * (p.slider_closed + p.slider_open), half = 0.5 * (p.slider_open - p.slider_closed);
  std::vector<double> sliders;
  for (std::size_t i = 0; i < kSwing; ++i)
    sliders.push_back(middle + half * std::cos(kTwoPi * static_cast<double>(i) / static_cast<double>(kSwing)));
  return sliders;
}

/// 1e-2 to 1e-10 m before the fold or dead point above the stroke.
std::vector<double> besideTheLimit(const Grapple& grapple) {
  std::vector<double> sliders;
  for (int decade = 2; decade <= 10; ++decade) sliders.push_back(grapple.upperLimit().slider - std::pow(10.0, -decade));
  return sliders;
}

using Pose = std::function<std::optional<GrappleMotion>(double slider)>;

/// Jaw edge P, dP/ds and d2P/ds2, computed and exact.
using Vectors = std::array<Planar, 3>;
using ExactVectors = std::array<std::array<Digits50, 2>, 3>;
constexpr std::array<const char*, 3> kVectorNames{"P", "dP/ds", "d2P/ds2"};

std::optional<ExactVectors> exactVectors(const Grapple& grapple, const GrappleMotion& m) {
  const std::optional<ExplicitPose> exact = exactPoseOf(grapple.parameters(), m);
  if (!exact) return std::nullopt;
  const PsiPoint edge = exact->edgeBySlider();
  return ExactVectors{{{edge.x.v, edge.y.v}, {edge.x.d, edge.y.d}, {edge.x.dd, edge.y.dd}}};
}

double missOf(Planar value, const std::array<Digits50, 2>& exact) {
  const Digits50 x = value.re - exact[0], y = value.im - exact[1];
  return static_cast<double>(sqrt(x * x + y * y));
}

/// Relative errors to max(1, size). A pose that is not there counts as infinitely wrong.
std::array<Error, 3> worstErrors(const Grapple& grapple, const std::vector<double>& sliders, const Pose& pose) {
  std::array<Error, 3> worst;
  std::array<double, 3> peaks{};
  for (const double slider : sliders) {
    const std::optional<GrappleMotion> m = pose(slider);
    const std::optional<ExactVectors> exact = m ? exactVectors(grapple, *m) : std::nullopt;
    if (!exact) return {{{HUGE_VAL, HUGE_VAL}, {HUGE_VAL, HUGE_VAL}, {HUGE_VAL, HUGE_VAL}}};
    const Vectors vectors{m->p, m->dp, m->ddp};
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const double miss = missOf(vectors[i], (*exact)[i]), size = norm(vectors[i]);
      peaks[i] = std::max(peaks[i], size);
      worst[i].of_peak = std::max(worst[i].of_peak, miss);
      worst[i].relative = std::max(worst[i].relative, miss / std::max(1.0, size));
    }
  }
  for (std::size_t i = 0; i < worst.size(); ++i) worst[i].of_peak /= peaks[i];
  return worst;
}

std::vector<CaseError> errorsOf(const Grapple& grapple, const std::vector<double>& stroke, const Pose& pose) {
  std::vector<double> judged;
  for (std::size_t i = 0; i < stroke.size(); i += stroke.size() / kJudged) judged.push_back(stroke[i]);
  std::vector<CaseError> errors;
  const auto add = [&](const std::string& where, const std::vector<double>& sliders) {
    const std::array<Error, 3> worst = worstErrors(grapple, sliders, pose);
    for (std::size_t i = 0; i < worst.size(); ++i) errors.push_back({kVectorNames[i] + where, worst[i]});
  };
  add(", stroke", judged);
  add(", beside the limit", besideTheLimit(grapple));
  return errors;
}

CostRow warmStep(const Grapple& grapple, const std::vector<double>& sliders) {
  GrappleTracker tracker(grapple);
  const Cost cost = costOf(sliders.size(), [&] {
    for (const double slider : sliders) {
      tracker.update({slider, 0.3, -0.2});
      keep(tracker.right());
      keep(tracker.left());
    }
  });
  GrappleMotion last = grapple.at(sliders.front()).value();
  const Pose pose = [&](double slider) {
    const auto next = grapple.follow(last, slider);
    if (next) last = *next;
    return next;
  };
  return {"grapple", "warm step, both jaws", cost, errorsOf(grapple, sliders, pose), {}};
}

CostRow coldPose(const Grapple& grapple, const std::vector<double>& sliders) {
  const Cost cost = costOf(sliders.size(), [&] {
    for (const double slider : sliders) keep(grapple.at(slider));
  });
  return {"grapple", "cold pose", cost, errorsOf(grapple, sliders, [&](double s) { return grapple.at(s); }), {}};
}

CostRow enumeration(const Grapple& grapple, const std::vector<double>& sliders) {
  const LeverGroup group(grapple.parameters());
  std::vector<Planar> places;
  for (const double slider : sliders) places.push_back(grapple.at(slider).value().a);
  const Cost cost = costOf(places.size(), [&] {
    for (const Planar& a : places) keep(enumerateBranches(group, a));
  });
  return {"grapple", "all branches", cost, {}, {}};
}

}  // namespace

std::vector<CostRow> grappleCosts(const Grapple& grapple) {
  const std::vector<double> sliders = swing(grapple.parameters());
  return {warmStep(grapple, sliders), coldPose(grapple, sliders), enumeration(grapple, sliders)};
}

}  // namespace hammer_loads::accuracy
