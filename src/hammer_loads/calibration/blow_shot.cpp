#include "hammer_loads/calibration/blow_shot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

// Numerical: kMaxStep, kMostSteps
constexpr double kMaxStep = 0.08;  // [rad]
constexpr int kMostSteps = 64;     // from one node of the torque to the next

/// Equations of motion on one side of a blow and their derivatives. The state is angle and sqrt(inertia) speed; time is
/// counted from the blow.
class ShotIntegrator {
 public:
  using Path = Eigen::Vector2d;
  struct There {
    ShaftLoad load;
    double inv_root, speed, torque;
  };
  struct Run {
    double time;
    Path path;
    ShotSlopes slopes;
    There there;
  };

  ShotIntegrator(const ShaftModel& model, const HalfShot& half) : model_(model), half_(half) {}

  There at(double time, const Path& path) const {
    There t{model_({path[0], side()}), 0.0, 0.0, 0.0};
    t.inv_root = 1.0 / std::sqrt(half_.drive_inertia + t.load.inertia);
    t.speed = path[1] * t.inv_root;
    t.torque = torqueAt(time, path[0], t.speed) + t.load.weight_torque;
    return t;
  }
  Path rate(const There& t, const Path& path) const { return sign() * t.inv_root * Path(path[1], t.torque); }
  ShotSlopes rate(const There& t, double time, const Path& path, const ShotSlopes& slopes) const {
    const double gain = sign() * t.inv_root, square = t.inv_root * t.inv_root;
    const double by_angle = t.load.half_inertia_slope * square, by_inertia = 0.5 * half_.drive_inertia * square;
    const DriveLaw& law = half_.law;
    Eigen::Matrix2d own;
    own << -sign() * t.speed * by_angle, gain,
        gain * (t.load.weight_torque_slope - law.stiffness + law.drag * t.speed * by_angle - t.torque * by_angle),
        -gain * law.drag * t.inv_root;
    ShotSlopes rate = own * slopes;
    addTorqueSlopes(gain, time, path[0], t.speed, rate.row(1));
    rate(0, kOwnLogInertia) -= sign() * t.speed * by_inertia;
    rate(1, kOwnLogInertia) += gain * by_inertia * (law.drag * t.speed - t.torque);
    return rate;
  }

  ShotPoint pointAt(const There& t, const Path& path) const {
    const double acceleration = (t.torque - t.load.half_inertia_slope * t.speed * t.speed) * t.inv_root * t.inv_root;
    return {path[0], t.speed, acceleration};
  }
  /// Converts derivatives of (offset, sqrt(inertia) speed) to those of (offset, speed).
  ShotSlopes ofPoint(const There& t, ShotSlopes slopes) const {
    const double square = t.inv_root * t.inv_root;
    slopes.row(1) = t.inv_root * slopes.row(1) - t.speed * t.load.half_inertia_slope * square * slopes.row(0);
    slopes(1, kOwnLogInertia) -= 0.5 * t.speed * half_.drive_inertia * square;
    return slopes;
  }
  Run atBlow() const {
    const double root = std::sqrt(half_.drive_inertia + model_({0.0, side()}).inertia);
    Run run{0.0, {0.0, root * half_.speed}, ShotSlopes::Zero(), {}};
    run.slopes(1, kOwnSpeed) = root;
    run.slopes(1, kOwnLogInertia) = 0.5 * half_.drive_inertia * half_.speed / root;
    run.there = at(0.0, run.path);
    return run;
  }

 private:
  /// Interval between two torque nodes and the fraction of it up to an instant.
  struct NodePlace {
    int node;
    double part;
  };
  NodePlace nodePlace(double time) const {
    const double place = std::fmin(time / half_.node_step, static_cast<double>(kNodesPerSide));  // NaN: last node
    const int node = std::min(static_cast<int>(place), kNodesPerSide - 1);
    return {node, place - node};
  }
  double sign() const { return half_.before ? -1.0 : 1.0; }
  Side side() const { return half_.before ? Side::kBeforeBlow : Side::kAfterBlow; }
  /// Returns the lead of a crank at the mean speed over the actual crank at `offset` [rad].
  double ahead(double time, double offset) const { return half_.law.mean_speed * sign() * time - offset; }
  double torqueAt(double time, double offset, double speed) const {
    const NodePlace place = nodePlace(time);
    const DriveLaw& law = half_.law;
    return half_.torque[place.node] + place.part * (half_.torque[place.node + 1] - half_.torque[place.node]) +
           law.stiffness * ahead(time, offset) - law.drag * (speed - law.mean_speed);
  }
  /// Adds the contribution of the torque's parameters to a row; `gain` is the row's derivative by the torque.
  template <class Row>
  void addTorqueSlopes(double gain, double time, double offset, double speed, Row rate) const {
    const NodePlace place = nodePlace(time);
    rate[kOwnTorques + place.node] += gain * (1.0 - place.part);
    rate[kOwnTorques + place.node + 1] += gain * place.part;
    rate[kOwnStiffness] += gain * ahead(time, offset);
    rate[kOwnDrag] -= gain * (speed - half_.law.mean_speed);
  }

  const ShaftModel& model_;
  const HalfShot& half_;
};

struct Node {
  double time;
  ShotPoint at;
  ShotSlopes slopes;
};

template <bool with_slopes>
void step(const ShotIntegrator& integrator, double dt, ShotIntegrator::Run& run) {
  const double middle = run.time + 0.5 * dt, end = run.time + dt;
  using Path = ShotIntegrator::Path;
  const Path k1 = integrator.rate(run.there, run.path), p2 = run.path + 0.5 * dt * k1;
  const ShotIntegrator::There t2 = integrator.at(middle, p2);
  const Path k2 = integrator.rate(t2, p2), p3 = run.path + 0.5 * dt * k2;
  const ShotIntegrator::There t3 = integrator.at(middle, p3);
  const Path k3 = integrator.rate(t3, p3), p4 = run.path + dt * k3;
  const ShotIntegrator::There t4 = integrator.at(end, p4);
  const Path k4 = integrator.rate(t4, p4);
  if constexpr (with_slopes) {
    using S = ShotSlopes;
    const S s1 = integrator.rate(run.there, run.time, run.path, run.slopes);
    const S s2 = integrator.rate(t2, middle, p2, S(run.slopes + 0.5 * dt * s1));
    const S s3 = integrator.rate(t3, middle, p3, S(run.slopes + 0.5 * dt * s2));
    const S s4 = integrator.rate(t4, end, p4, S(run.slopes + dt * s3));
    run.slopes += dt / 6.0 * (s1 + 2.0 * (s2 + s3) + s4);
  }
  run.path += dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  run.time = end;
  run.there = integrator.at(end, run.path);
}

/// Interpolation within a step. The motion is a polynomial of degree 5 through offset, speed and acceleration at both
/// ends; the derivatives are a polynomial of degree 3.
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
Node nodeOf(const ShotIntegrator& integrator, const ShotIntegrator::Run& run) {
  Node node{run.time, integrator.pointAt(run.there, run.path), {}};
  if constexpr (with_slopes) node.slopes = integrator.ofPoint(run.there, run.slopes);
  return node;
}

/// Integrates over all times in steps that end at the torque nodes; `slopes` is used only if with_slopes is true.
template <bool with_slopes>
void follow(const ShotIntegrator& integrator, const HalfShot& half, const std::vector<double>& times,
            std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes) {
  ShotIntegrator::Run run = integrator.atBlow();
  Node from = nodeOf<with_slopes>(integrator, run);
  double node_end = half.node_step;
  for (std::size_t i = 0; i < times.size();) {
    const double left = node_end - run.time, longest = kMaxStep / std::max(std::abs(run.there.speed), 1.0),
                 needed = left / longest;
    const int steps = needed < kMostSteps ? std::max(1, static_cast<int>(std::ceil(needed))) : kMostSteps;
    step<with_slopes>(integrator, left / steps, run);
    if (steps == 1) node_end += half.node_step;
    const Node to = nodeOf<with_slopes>(integrator, run);
    const Between between(half.before ? -1.0 : 1.0, from, to);
    for (; i < times.size() && times[i] <= to.time; ++i) {
      points[i] = between.point(times[i]);
      if constexpr (with_slopes) (*slopes)[i] = between.slopes(times[i]);
    }
    from = to;
  }
}

}  // namespace

void shoot(const ShaftModel& model, const HalfShot& half, const std::vector<double>& times,
           std::vector<ShotPoint>& points, std::vector<ShotSlopes>* slopes) {
  const ShotIntegrator integrator(model, half);
  points.resize(times.size());
  if (slopes) {
    slopes->resize(times.size());
    follow<true>(integrator, half, times, points, slopes);
  } else {
    follow<false>(integrator, half, times, points, nullptr);
  }
}

}  // namespace hammer_loads::calibration
