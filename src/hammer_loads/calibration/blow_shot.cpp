#include "hammer_loads/calibration/blow_shot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/calibration/shot_way.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

// Numerical: kMaxStep, kMostSteps
constexpr double kMaxStep = 0.08;  // [rad]
constexpr int kMostSteps = 64;     // from one node of the torque to the next

using Path = ShotWay::Path;
using There = ShotWay::There;

struct Run {
  double time;
  Path path;
  ShotSlopes slopes;
  There there;
};

struct Node {
  double time;
  ShotPoint at;
  ShotSlopes slopes;
};

template <bool with_slopes>
void step(const ShotWay& way, double dt, Run& run) {
  const double middle = run.time + 0.5 * dt, end = run.time + dt;
  const Path k1 = way.rate(run.there, run.path), p2 = run.path + 0.5 * dt * k1;
  const There t2 = way.at(middle, p2);
  const Path k2 = way.rate(t2, p2), p3 = run.path + 0.5 * dt * k2;
  const There t3 = way.at(middle, p3);
  const Path k3 = way.rate(t3, p3), p4 = run.path + dt * k3;
  const There t4 = way.at(end, p4);
  const Path k4 = way.rate(t4, p4);
  if constexpr (with_slopes) {
    using S = ShotSlopes;
    const S s1 = way.rate(run.there, run.time, run.path, run.slopes);
    const S s2 = way.rate(t2, middle, p2, S(run.slopes + 0.5 * dt * s1));
    const S s3 = way.rate(t3, middle, p3, S(run.slopes + 0.5 * dt * s2));
    const S s4 = way.rate(t4, end, p4, S(run.slopes + dt * s3));
    run.slopes += dt / 6.0 * (s1 + 2.0 * (s2 + s3) + s4);
  }
  run.path += dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  run.time = end;
  run.there = way.at(end, run.path);
}

/// Motion within a step: the polynomial of degree 5 through offset, speed and acceleration at both ends, and that of
/// degree 3 for the derivatives.
class Between {
 public:
  Between(double sign, const Node& from, const Node& to)
      : sign_(sign), begin_(from.time), step_(to.time - from.time), from_(from), to_(to) {
    const double v0 = sign * step_ * from.at.speed, v1 = sign * step_ * to.at.speed;
    const double a0 = square(step_) * from.at.acceleration, a1 = square(step_) * to.at.acceleration;
    const double left = to.at.offset - from.at.offset - v0 - 0.5 * a0, gained = v1 - v0 - a0, bent = a1 - a0;
    c_ = {from.at.offset,
          v0,
          0.5 * a0,
          10.0 * left - 4.0 * gained + 0.5 * bent,
          -15.0 * left + 7.0 * gained - bent,
          6.0 * left - 3.0 * gained + 0.5 * bent};
  }
  ShotPoint point(double time) const {
    const double u = (time - begin_) / step_;
    return {c_[0] + u * (c_[1] + u * (c_[2] + u * (c_[3] + u * (c_[4] + u * c_[5])))),
            sign_ / step_ * (c_[1] + u * (2.0 * c_[2] + u * (3.0 * c_[3] + u * (4.0 * c_[4] + u * 5.0 * c_[5])))),
            (2.0 * c_[2] + u * (6.0 * c_[3] + u * (12.0 * c_[4] + u * 20.0 * c_[5]))) / square(step_)};
  }
  ShotSlopes slopes(double time) const {
    const double u = (time - begin_) / step_, v = 1.0 - u, signed_step = sign_ * step_;
    const auto &a = from_.slopes, &b = to_.slopes;
    ShotSlopes all;
    all.row(0) = v * v * (1.0 + 2.0 * u) * a.row(0) + u * u * (3.0 - 2.0 * u) * b.row(0) +
                 signed_step * u * v * (v * a.row(1) - u * b.row(1));
    all.row(1) = 6.0 * u * v / signed_step * (b.row(0) - a.row(0)) + v * (1.0 - 3.0 * u) * a.row(1) +
                 u * (1.0 - 3.0 * v) * b.row(1);
    return all;
  }

 private:
  double sign_, begin_, step_;
  const Node &from_, &to_;
  std::array<double, 6> c_;
};

template <bool with_slopes>
Node nodeOf(const ShotWay& way, const Run& run) {
  Node node{run.time, way.pointAt(run.there, run.path), {}};
  if constexpr (with_slopes) node.slopes = way.ofPoint(run.there, run.slopes);
  return node;
}

/// visit(i, motion within the step that holds the time) for each of the times. Steps end at the nodes of the torque.
template <bool with_slopes, class Visit>
void follow(const ShotWay& way, const HalfShot& half, const std::vector<double>& times, Run run, const Visit& visit) {
  run.there = way.at(0.0, run.path);
  Node from = nodeOf<with_slopes>(way, run);
  double node_end = half.node_step;
  for (std::size_t i = 0; i < times.size();) {
    const double left = node_end - run.time, needed = left / way.stepOf(run.there, kMaxStep);
    const int steps = needed < kMostSteps ? std::max(1, static_cast<int>(std::ceil(needed))) : kMostSteps;
    step<with_slopes>(way, left / steps, run);
    if (steps == 1) node_end += half.node_step;
    const Node to = nodeOf<with_slopes>(way, run);
    const Between between(half.before ? -1.0 : 1.0, from, to);
    for (; i < times.size() && times[i] <= to.time; ++i) visit(i, between);
    from = to;
  }
}

}  // namespace

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes) {
  const ShotWay way(model, half);
  points.resize(times.size());
  Run run{0.0, way.pathAtBlow(), ShotSlopes::Zero(), {}};
  if (!slopes) {
    follow<false>(way, half, times, run, [&](std::size_t i, const Between& at) { points[i] = at.point(times[i]); });
    return;
  }
  slopes->resize(times.size());
  run.slopes = way.slopesAtBlow();
  follow<true>(way, half, times, run, [&](std::size_t i, const Between& at) {
    points[i] = at.point(times[i]);
    (*slopes)[i] = at.slopes(times[i]);
  });
}

}  // namespace hammer_loads::calibration
