#include "hammer_loads/calibration/blow_shot.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads::calibration {
namespace {

constexpr double kMaxStep = 0.06;  // [rad]

struct Run {
  double offset, h, time;  // time away from the blow
};

double torqueAt(const HalfShot& half, double time, double offset, double speed) {
  const double place = std::min(time / half.node_step, static_cast<double>(kNodesBeside));
  const int node = std::min(static_cast<int>(place), kNodesBeside - 1);
  const double part = place - node;
  const DriveLaw& law = half.law;
  const double since = half.before ? -time : time;
  return half.torque[node] + part * (half.torque[node + 1] - half.torque[node]) +
         law.stiffness * (law.mean_speed * since - offset) - law.drag * (speed - law.mean_speed);
}

}  // namespace

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points) {
  const Side side = half.before ? Side::kBeforeBlow : Side::kAfterBlow;
  const double way = half.before ? -1.0 : 1.0;
  const auto rates = [&](double offset, double h, double time, double& offset_rate, double& h_rate) {
    const ShaftLoad load = model({offset, side});
    const double inv_root = 1.0 / std::sqrt(half.drive_inertia + load.inertia);
    offset_rate = way * h * inv_root;
    h_rate = way * (torqueAt(half, time, offset, h * inv_root) + load.weight_torque) * inv_root;
  };
  Run run{0.0, std::sqrt(half.drive_inertia + model({0.0, side}).inertia) * half.speed, 0.0};
  points.resize(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    double speed = std::abs(run.h) / std::sqrt(half.drive_inertia + model({run.offset, side}).inertia);
    const double left = times[i] - run.time;
    const int steps = std::clamp(static_cast<int>(std::ceil(left * std::max(speed, 1.0) / kMaxStep)), 1, 64);
    const double dt = left / steps;
    for (int k = 0; k < steps; ++k) {
      double o1, h1, o2, h2, o3, h3, o4, h4;
      rates(run.offset, run.h, run.time, o1, h1);
      rates(run.offset + 0.5 * dt * o1, run.h + 0.5 * dt * h1, run.time + 0.5 * dt, o2, h2);
      rates(run.offset + 0.5 * dt * o2, run.h + 0.5 * dt * h2, run.time + 0.5 * dt, o3, h3);
      rates(run.offset + dt * o3, run.h + dt * h3, run.time + dt, o4, h4);
      run.offset += dt / 6.0 * (o1 + 2.0 * (o2 + o3) + o4);
      run.h += dt / 6.0 * (h1 + 2.0 * (h2 + h3) + h4);
      run.time += dt;
    }
    run.time = times[i];
    const ShaftLoad load = model({run.offset, side});
    const double inertia = half.drive_inertia + load.inertia;
    speed = run.h / std::sqrt(inertia);
    points[i] = {
        run.offset, speed,
        (torqueAt(half, run.time, run.offset, speed) + load.weight_torque - load.half_inertia_slope * speed * speed) /
            inertia};
  }
}

}  // namespace hammer_loads::calibration
