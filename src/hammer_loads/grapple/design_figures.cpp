#include "hammer_loads/grapple/design_figures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr int kPanels = 2048;
constexpr double kEndTolerance = 1e-9;  ///< [m]: an opening this far outside of the stroke's counts as its end

/// One point of the path; low and high are the extremes of y from the closed end up to it.
struct PathPoint {
  double slider{}, arc{}, y{};
  double low{}, high{};
  double deviation() const { return arc > 0.0 ? 0.5 * (high - low) / arc : 0.0; }
};

/// The path of P from closed to open; points at equidistant slider positions and wherever dy/ds = 0.
class Path {
 public:
  Path(const Grapple& grapple, double closed, double open) {
    GrappleMotion here = *grapple.at(closed);
    motions_.push_back(here);
    points_.push_back({closed, 0.0, here.p.im, here.p.im, here.p.im});
    for (int i = 1; i <= kPanels; ++i) {
      const double slider = i == kPanels ? open : closed + (open - closed) * i / kPanels;
      const std::optional<GrappleMotion> next = grapple.follow(here, slider);
      if (!next) continue;
      if (here.dp.im * next->dp.im < 0.0) {
        const double share = here.dp.im / (here.dp.im - next->dp.im);
        const auto flat = grapple.follow(here, here.slider + share * (slider - here.slider));
        if (flat) add(here, *flat);
        if (flat) here = *flat;
      }
      add(here, *next);
      here = *next;
      motions_.push_back(here);
    }
  }

  const std::vector<PathPoint>& points() const { return points_; }
  const std::vector<GrappleMotion>& motions() const { return motions_; }  ///< at the equidistant slider positions
  double length() const { return points_.back().arc; }

  /// Linear between points, which lie closer than 1e-3 of the path.
  PathPoint atShare(double share) const {
    const double arc = share * length();
    const auto after = std::lower_bound(points_.begin() + 1, points_.end() - 1, arc,
                                        [](const PathPoint& p, double a) { return p.arc < a; });
    const PathPoint& before = *(after - 1);
    const double part = (arc - before.arc) / (after->arc - before.arc);
    PathPoint point = before;
    point.arc = arc;
    point.y += part * (after->y - before.y);
    point.low = std::min(before.low, point.y);
    point.high = std::max(before.high, point.y);
    return point;
  }

  double straightShare(double tolerance) const {
    for (std::size_t i = points_.size() - 1; i > 0; --i) {
      const double inside = tolerance - points_[i].deviation();
      if (inside < 0.0) continue;
      if (i + 1 == points_.size()) return 1.0;
      const double outside = points_[i + 1].deviation() - tolerance;
      const double part = inside / (inside + outside);
      return (points_[i].arc + part * (points_[i + 1].arc - points_[i].arc)) / length();
    }
    return 0.0;
  }

 private:
  /// Arc length by the trapezoidal rule with end correction, fourth order.
  void add(const GrappleMotion& from, const GrappleMotion& to) {
    const double step = to.slider - from.slider;
    const double speed0 = norm(from.dp), speed1 = norm(to.dp);
    const double slope0 = dot(from.dp, from.ddp) / speed0, slope1 = dot(to.dp, to.ddp) / speed1;
    const PathPoint& last = points_.back();
    const double arc = last.arc + std::abs(0.5 * step * (speed0 + speed1) + step * step / 12.0 * (slope0 - slope1));
    points_.push_back({to.slider, arc, to.p.im, std::min(last.low, to.p.im), std::max(last.high, to.p.im)});
  }

  std::vector<PathPoint> points_;
  std::vector<GrappleMotion> motions_;
};

/// 2-norm condition number of the lever group's Jacobian.
double conditionNumber(const GrappleMotion& m) {
  const Planar u = m.d - m.b, v = m.e - m.c;
  const double j11 = cross(m.b - m.a, u), j12 = cross(m.d, u), j21 = cross(m.c - m.a, v), j22 = cross(m.e, v);
  const double half_sum = 0.5 * (j11 * j11 + j12 * j12 + j21 * j21 + j22 * j22);
  const double determinant = std::abs(m.determinant);
  return (half_sum + std::sqrt(std::max((half_sum - determinant) * (half_sum + determinant), 0.0))) / determinant;
}

double transmissionAngle(const GrappleMotion& m, Planar o1) {
  const Planar to_o1 = o1 - m.h, to_g = m.g - m.h;
  return std::atan2(std::abs(cross(to_o1, to_g)), dot(to_o1, to_g));
}

void addConditioning(const std::vector<GrappleMotion>& motions, Planar o1, DesignFigures& f) {
  f.least_determinant.value = f.least_transmission.value = kInfinity;
  const auto least = [](Extreme& extreme, double value, double slider) {
    if (value < extreme.value) extreme = {value, slider};
  };
  const auto most = [](Extreme& extreme, double value, double slider) {
    if (value > extreme.value) extreme = {value, slider};
  };
  for (const GrappleMotion& m : motions) {
    least(f.least_determinant, std::abs(m.determinant), m.slider);
    most(f.worst_condition, conditionNumber(m), m.slider);
    least(f.least_transmission, transmissionAngle(m, o1), m.slider);
    most(f.most_transmission, transmissionAngle(m, o1), m.slider);
  }
}

}  // namespace

DesignFigures designFigures(const Grapple& grapple, double slider_closed, double slider_open) {
  DesignFigures f;
  f.slider_closed = slider_closed;
  f.slider_open = slider_open;
  const Planar closed = grapple.at(slider_closed)->p, open = grapple.at(slider_open)->p;
  f.opening = 2.0 * open.re;
  f.jaw_travel = open.re - closed.re;
  const Path path(grapple, slider_closed, slider_open);
  const PathPoint straight_end = path.atShare(kClaimedStraightShare);
  f.path_length = path.length();
  f.line_height = 0.5 * (straight_end.low + straight_end.high);
  f.scoop_height = open.im - f.line_height;
  f.deviation_first_80 = straight_end.deviation();
  f.deviation_whole = path.points().back().deviation();
  f.straight_share_band = path.straightShare(0.5 * kClaimedDeviation);
  f.straight_share_off = path.straightShare(kClaimedDeviation);
  addConditioning(path.motions(), grapple.parameters().o1, f);
  return f;
}

Checked<double> sliderForOpening(const Grapple& grapple, double opening) {
  Checked<double> result;
  const GrappleParameters& p = grapple.parameters();
  double low = p.slider_closed, high = p.slider_open;  // x_P - x is <= 0 at low, >= 0 at high
  GrappleMotion m = *grapple.at(low);
  const double x_low = m.p.re, x_high = grapple.at(high)->p.re;
  const double x = std::clamp(0.5 * opening, x_low, x_high);
  if (!(std::abs(0.5 * opening - x) <= kEndTolerance)) {
    result.problems.push_back(format("opening: %.9g m, must lie between %.9f m (closed) and %.9f m (open)", opening,
                                     2.0 * x_low + 0.0, 2.0 * x_high));
    return result;
  }
  double slider = low + (high - low) * (x - x_low) / (x_high - x_low);
  for (int i = 0; i < 100; ++i) {
    const std::optional<GrappleMotion> next = grapple.follow(m, slider);
    if (!next) break;
    m = *next;
    const double miss = m.p.re - x;
    (miss < 0.0 ? low : high) = slider;
    const double newton = slider - miss / m.dp.re;
    const bool within = (newton - low) * (newton - high) <= 0.0;
    const double better = within ? newton : 0.5 * (low + high);
    const bool settled = std::abs(better - slider) <= 4e-16 * (1.0 + std::abs(slider));
    slider = better;
    if (settled || low == high) break;
  }
  result.value = slider;
  return result;
}

}  // namespace hammer_loads
