/// The equations of motion on one side of a blow, with their derivatives.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/blow_shot.h"

namespace hammer_loads::calibration {

/// Angle and sqrt(inertia) speed. Time runs away from the blow.
class ShotWay {
 public:
  using Path = Eigen::Vector2d;
  using Slopes = ShotSlopes;
  struct There {
    ShaftLoad load;
    double inv_root, speed, torque;
  };

  ShotWay(const ShaftModel& model, const HalfShot& half) : model_(model), half_(half) {}

  There at(double time, const Path& path) const {
    There t{model_({path[0], side()}), 0.0, 0.0, 0.0};
    t.inv_root = 1.0 / std::sqrt(half_.drive_inertia + t.load.inertia);
    t.speed = path[1] * t.inv_root;
    t.torque = torqueAt(time, path[0], t.speed) + t.load.weight_torque;
    return t;
  }
  Path rate(const There& t, const Path& path) const { return sign() * t.inv_root * Path(path[1], t.torque); }
  Slopes rate(const There& t, double time, const Path& path, const Slopes& slopes) const {
    const double gain = sign() * t.inv_root, square = t.inv_root * t.inv_root;
    const double by_angle = t.load.half_inertia_slope * square, by_inertia = 0.5 * half_.drive_inertia * square;
    const DriveLaw& law = half_.law;
    Eigen::Matrix2d own;
    own << -sign() * t.speed * by_angle, gain,
        gain * (t.load.weight_torque_slope - law.stiffness + law.drag * t.speed * by_angle - t.torque * by_angle),
        -gain * law.drag * t.inv_root;
    Slopes rate = own * slopes;
    addTorqueSlopes(gain, time, path[0], t.speed, rate.row(1));
    rate(0, kOwnLogInertia) -= sign() * t.speed * by_inertia;
    rate(1, kOwnLogInertia) += gain * by_inertia * (law.drag * t.speed - t.torque);
    return rate;
  }

  /// Longest step [s] for a turn of so many radians.
  double stepOf(const There& t, double most_turned) const { return most_turned / std::max(std::abs(t.speed), 1.0); }
  ShotPoint pointAt(const There& t, const Path& path) const {
    const double acceleration = (t.torque - t.load.half_inertia_slope * t.speed * t.speed) * t.inv_root * t.inv_root;
    return {path[0], t.speed, acceleration};
  }
  /// d(offset, speed) from d(offset, sqrt(inertia) speed).
  Slopes ofPoint(const There& t, Slopes slopes) const {
    const double square = t.inv_root * t.inv_root;
    slopes.row(1) = t.inv_root * slopes.row(1) - t.speed * t.load.half_inertia_slope * square * slopes.row(0);
    slopes(1, kOwnLogInertia) -= 0.5 * t.speed * half_.drive_inertia * square;
    return slopes;
  }
  Path pathAtBlow() const { return {0.0, rootAtBlow() * half_.speed}; }
  Slopes slopesAtBlow() const {
    Slopes slopes = Slopes::Zero();
    slopes(1, kOwnSpeed) = rootAtBlow();
    slopes(1, kOwnLogInertia) = 0.5 * half_.drive_inertia * half_.speed / rootAtBlow();
    return slopes;
  }

 private:
  /// Between which nodes of the torque an instant lies.
  struct NodePlace {
    int node;
    double part;
  };
  NodePlace nodePlace(double time) const {
    const double place = std::fmin(time / half_.node_step, static_cast<double>(kNodesBeside));  // NaN: the last one
    const int node = std::min(static_cast<int>(place), kNodesBeside - 1);
    return {node, place - node};
  }
  double sign() const { return half_.before ? -1.0 : 1.0; }
  Side side() const { return half_.before ? Side::kBeforeBlow : Side::kAfterBlow; }
  /// Lead of the mean speed over the state at `offset`.
  double ahead(double time, double offset) const { return half_.law.mean_speed * sign() * time - offset; }
  double torqueAt(double time, double offset, double speed) const {
    const NodePlace place = nodePlace(time);
    const DriveLaw& law = half_.law;
    return half_.torque[place.node] + place.part * (half_.torque[place.node + 1] - half_.torque[place.node]) +
           law.stiffness * ahead(time, offset) - law.drag * (speed - law.mean_speed);
  }
  /// A row's rate by the torque is `gain`.
  template <class Row>
  void addTorqueSlopes(double gain, double time, double offset, double speed, Row rate) const {
    const NodePlace place = nodePlace(time);
    rate[kOwnTorques + place.node] += gain * (1.0 - place.part);
    rate[kOwnTorques + place.node + 1] += gain * place.part;
    rate[kOwnStiffness] += gain * ahead(time, offset);
    rate[kOwnDrag] -= gain * (speed - half_.law.mean_speed);
  }
  double rootAtBlow() const { return std::sqrt(half_.drive_inertia + model_({0.0, side()}).inertia); }

  const ShaftModel& model_;
  const HalfShot& half_;
};

}  // namespace hammer_loads::calibration
