#include "hammer_loads/calibration/blow_shot.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads::calibration {
namespace {

constexpr double kMaxStep = 0.06;  // [rad]

/// Angle and sqrt(inertia) speed, or their rates.
using Path = Eigen::Vector2d;

/// Their derivatives, or the rates of these; one column without: nothing is to be known of them.
template <bool with_slopes>
using Slopes = Eigen::Matrix<double, 2, with_slopes ? static_cast<int>(kHalfMoving) : 1>;

/// Between which nodes of the torque an instant lies.
struct NodePlace {
  int node;
  double part;
};

NodePlace nodePlace(const HalfShot& half, double time) {
  const double place = std::min(time / half.node_step, static_cast<double>(kNodesBeside));
  const int node = std::min(static_cast<int>(place), kNodesBeside - 1);
  return {node, place - node};
}

/// One side's equation of motion; time runs away from the blow.
class Way {
 public:
  Way(const ShaftModel& model, const HalfShot& half) : model_(model), half_(half) {}

  struct There {
    ShaftLoad load;
    double inv_root, speed, torque;
  };

  There at(double time, const Path& path) const {
    There t{model_({path[0], half_.before ? Side::kBeforeBlow : Side::kAfterBlow}), 0.0, 0.0, 0.0};
    t.inv_root = 1.0 / std::sqrt(half_.drive_inertia + t.load.inertia);
    t.speed = path[1] * t.inv_root;
    const NodePlace place = nodePlace(half_, time);
    const DriveLaw& law = half_.law;
    t.torque = half_.torque[place.node] + place.part * (half_.torque[place.node + 1] - half_.torque[place.node]) +
               law.stiffness * ahead(time, path) - law.drag * (t.speed - law.mean_speed) + t.load.weight_torque;
    return t;
  }

  Path rate(const There& t, const Path& path) const { return sign() * t.inv_root * Path(path[1], t.torque); }

  /// Of the slopes.
  Slopes<true> rate(const There& t, double time, const Path& path, const Slopes<true>& slopes) const {
    const double gain = sign() * t.inv_root, square = t.inv_root * t.inv_root;
    const double by_angle = t.load.half_inertia_slope * square, by_inertia = 0.5 * half_.drive_inertia * square;
    const DriveLaw& law = half_.law;
    Eigen::Matrix2d own;
    own << -sign() * t.speed * by_angle, gain,
        gain * (t.load.weight_torque_slope - law.stiffness + law.drag * t.speed * by_angle - t.torque * by_angle),
        -gain * law.drag * t.inv_root;
    Slopes<true> rate = own * slopes;
    const NodePlace place = nodePlace(half_, time);
    rate(1, kOwnTorques + place.node) += gain * (1.0 - place.part);
    rate(1, kOwnTorques + place.node + 1) += gain * place.part;
    rate(0, kOwnLogInertia) -= sign() * t.speed * by_inertia;
    rate(1, kOwnLogInertia) += gain * by_inertia * (law.drag * t.speed - t.torque);
    rate(1, kOwnStiffness) += gain * ahead(time, path);
    rate(1, kOwnDrag) -= gain * (t.speed - law.mean_speed);
    return rate;
  }
  Slopes<false> rate(const There&, double, const Path&, const Slopes<false>& slopes) const { return slopes; }

  double acceleration(const There& t) const {
    return (t.torque - t.load.half_inertia_slope * t.speed * t.speed) * t.inv_root * t.inv_root;
  }

  /// d(offset, speed) from d(offset, sqrt(inertia) speed).
  ShotSlopes ofSpeed(const There& t, Slopes<true> slopes) const {
    const double square = t.inv_root * t.inv_root;
    slopes.row(1) = t.inv_root * slopes.row(1) - t.speed * t.load.half_inertia_slope * square * slopes.row(0);
    slopes(1, kOwnLogInertia) -= 0.5 * t.speed * half_.drive_inertia * square;
    return slopes;
  }

  Path pathAtBlow() const { return {0.0, std::sqrt(half_.drive_inertia + atBlow().inertia) * half_.speed}; }
  Slopes<true> slopesAtBlow() const {
    Slopes<true> slopes = Slopes<true>::Zero();
    const double root = std::sqrt(half_.drive_inertia + atBlow().inertia);
    slopes(1, kOwnSpeed) = root;
    slopes(1, kOwnLogInertia) = 0.5 * half_.drive_inertia * half_.speed / root;
    return slopes;
  }

 private:
  double sign() const { return half_.before ? -1.0 : 1.0; }
  ShaftLoad atBlow() const { return model_({0.0, half_.before ? Side::kBeforeBlow : Side::kAfterBlow}); }
  /// How far the mean speed would be ahead of the crank.
  double ahead(double time, const Path& path) const { return half_.law.mean_speed * sign() * time - path[0]; }

  const ShaftModel& model_;
  const HalfShot& half_;
};

template <bool with_slopes>
struct Run {
  double time;
  Path path;
  Slopes<with_slopes> slopes;
  Way::There there;
};

template <bool with_slopes>
void step(const Way& way, double dt, Run<with_slopes>& run) {
  const double middle = run.time + 0.5 * dt, end = run.time + dt;
  const Path k1 = way.rate(run.there, run.path), p2 = run.path + 0.5 * dt * k1;
  const Way::There t2 = way.at(middle, p2);
  const Path k2 = way.rate(t2, p2), p3 = run.path + 0.5 * dt * k2;
  const Way::There t3 = way.at(middle, p3);
  const Path k3 = way.rate(t3, p3), p4 = run.path + dt * k3;
  const Way::There t4 = way.at(end, p4);
  const Path k4 = way.rate(t4, p4);
  if (with_slopes) {
    using S = Slopes<with_slopes>;
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
void follow(const Way& way, const std::vector<double>& times, Run<with_slopes> run, const Visit& visit) {
  run.there = way.at(0.0, run.path);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double left = times[i] - run.time;
    const double turned = left * std::max(std::abs(run.there.speed), 1.0);
    const int steps = std::clamp(static_cast<int>(std::ceil(turned / kMaxStep)), 1, 64);
    for (int k = 0; k < steps; ++k) step(way, left / steps, run);
    visit(i, run);
  }
}

}  // namespace

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points) {
  const Way way(model, half);
  points.resize(times.size());
  follow<false>(way, times, {0.0, way.pathAtBlow(), {}, {}}, [&](std::size_t i, const Run<false>& run) {
    points[i] = {run.path[0], run.there.speed, way.acceleration(run.there)};
  });
}

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>& slopes) {
  const Way way(model, half);
  points.resize(times.size());
  slopes.resize(times.size());
  follow<true>(way, times, {0.0, way.pathAtBlow(), way.slopesAtBlow(), {}}, [&](std::size_t i, const Run<true>& run) {
    points[i] = {run.path[0], run.there.speed, way.acceleration(run.there)};
    slopes[i] = way.ofSpeed(run.there, run.slopes);
  });
}

}  // namespace hammer_loads::calibration
