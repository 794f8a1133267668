#include "hammer_loads/calibration/blow_shot.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/shot_way.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kMaxStep = 0.06;  // [rad]
constexpr int kMostSteps = 64;     // from one time to the next

using Path = ShotWay::Path;
using There = ShotWay::There;

struct Run {
  double time;
  Path path;
  ShotSlopes slopes;
  There there;
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

/// visit(i, run) at each of the times.
template <bool with_slopes, class Visit>
void follow(const ShotWay& way, const std::vector<double>& times, Run run, const Visit& visit) {
  run.there = way.at(0.0, run.path);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double left = times[i] - run.time;
    const double needed = left / way.stepOf(run.there, kMaxStep);
    const int steps = needed < kMostSteps ? std::max(1, static_cast<int>(std::ceil(needed))) : kMostSteps;
    for (int k = 0; k < steps; ++k) step<with_slopes>(way, left / steps, run);
    visit(i, run);
  }
}

}  // namespace

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes) {
  const ShotWay way(model, half);
  points.resize(times.size());
  Run run{0.0, way.pathAtBlow(), ShotSlopes::Zero(), {}};
  if (!slopes) {
    follow<false>(way, times, run, [&](std::size_t i, const Run& at) { points[i] = way.pointAt(at.there, at.path); });
    return;
  }
  slopes->resize(times.size());
  run.slopes = way.slopesAtBlow();
  follow<true>(way, times, run, [&](std::size_t i, const Run& at) {
    points[i] = way.pointAt(at.there, at.path);
    (*slopes)[i] = way.ofPoint(at.there, at.slopes);
  });
}

}  // namespace hammer_loads::calibration
