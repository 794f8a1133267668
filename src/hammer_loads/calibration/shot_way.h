/// The equations of motion on one side of a blow, with their derivatives: of a rigid shaft, of one with a coupling.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/blow_shot.h"
#include "hammer_loads/crank/flexible_rates.h"

namespace hammer_loads::calibration {

/// Time runs away from the blow.
class ShotWay {
 public:
  ShotWay(const ShaftModel& model, const HalfShot& half) : model_(model), half_(half) {}

 protected:
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
  /// How far the mean speed would be ahead of what stands at `offset`.
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

  const ShaftModel& model_;
  const HalfShot& half_;
};

/// Angle and sqrt(inertia) speed.
class RigidWay : public ShotWay {
 public:
  using ShotWay::ShotWay;
  using Path = Eigen::Vector2d;
  using Slopes = Eigen::Matrix<double, 2, kRigidMoving>;
  struct There {
    ShaftLoad load;
    double inv_root, speed, torque;
  };

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
  ShotSlopes ofPoint(const There& t, Slopes slopes) const {
    const double square = t.inv_root * t.inv_root;
    slopes.row(1) = t.inv_root * slopes.row(1) - t.speed * t.load.half_inertia_slope * square * slopes.row(0);
    slopes(1, kOwnLogInertia) -= 0.5 * t.speed * half_.drive_inertia * square;
    ShotSlopes all = ShotSlopes::Zero();
    all.leftCols<kRigidMoving>() = slopes;
    return all;
  }
  Path pathAtBlow() const { return {0.0, rootAtBlow() * half_.speed}; }
  Slopes slopesAtBlow() const {
    Slopes slopes = Slopes::Zero();
    slopes(1, kOwnSpeed) = rootAtBlow();
    slopes(1, kOwnLogInertia) = 0.5 * half_.drive_inertia * half_.speed / rootAtBlow();
    return slopes;
  }

 private:
  double rootAtBlow() const { return std::sqrt(half_.drive_inertia + model_({0.0, side()}).inertia); }
};

/// Crank and motor; slopes are of the motor's angle in place of the twist.
class FlexibleWay : public ShotWay {
 public:
  using Path = FlexiblePath;
  using Slopes = Eigen::Matrix<double, 4, kHalfMoving>;
  struct There {
    ShaftLoad load;
    double torque;  ///< of the motor
  };
  FlexibleWay(const ShaftModel& model, const HalfShot& half)
      : ShotWay(model, half), law_(*model.coupling(), half.drive_inertia, half.log_coupling, half.log_odds) {
    law_.damping *= std::exp(half.log_damping);
  }

  There at(double time, const Path& path) const {
    return {model_({path[kPathOffset], side()}), torqueAt(time, offsetOf(path), path[kPathMotor])};
  }
  Path rate(const There& t, const Path& path) const { return sign() * shaft(t).rate(path, t.load); }
  Slopes rate(const There& t, double time, const Path& path, const Slopes& slopes) const {
    LinearisedFlexible d = linearised(shaft(t), path, t.load);
    const auto by_torque = d.by_input.col(0);
    d.by_path.col(kPathTwist) -= half_.law.stiffness * by_torque;
    d.by_path.col(kPathMotor) -= half_.law.drag * by_torque;
    Slopes rate = sign() * d.by_path * slopes;
    addTorqueSlopes(sign() * by_torque[kPathMotor], time, offsetOf(path), path[kPathMotor], rate.row(kPathMotor));
    rate.col(kOwnLogInertia) += sign() * d.by_input.col(1);
    rate.middleCols<3>(kOwnCoupling) += sign() * d.by_input.rightCols<3>();
    return rate;
  }

  double stepOf(const There& /*t*/, double most_turned) const {
    constexpr double kMostPhase = 0.4;  // [rad] of the oscillation: as the filter's steps
    // Numerical: kMostPhase
    const double reduced = law_.motor_inertia * law_.crank_inertia / (law_.motor_inertia + law_.crank_inertia);
    return std::min(most_turned / std::max(half_.speed, half_.law.mean_speed),
                    kMostPhase * std::sqrt(reduced / law_.stiffness));
  }
  ShotPoint pointAt(const There& t, const Path& path) const {
    return {offsetOf(path), path[kPathMotor], shaft(t).rate(path, t.load)[kPathMotor]};
  }
  ShotSlopes ofPoint(const There& /*t*/, const Slopes& slopes) const { return slopes.bottomRows<2>(); }
  Path pathAtBlow() const { return {0.0, rootAtBlow() * half_.speed, half_.twist, half_.motor_speed}; }
  Slopes slopesAtBlow() const {
    const double half_speed = 0.5 * half_.speed / rootAtBlow(), total = law_.crank_inertia + law_.motor_inertia;
    Slopes slopes = Slopes::Zero();
    slopes(kPathH, kOwnSpeed) = rootAtBlow();
    slopes(kPathH, kOwnLogInertia) = half_speed * law_.crank_inertia;
    slopes(kPathH, kOwnOdds) = -half_speed * law_.crank_inertia * law_.motor_inertia / total;
    slopes(kPathTwist, kOwnTwist) = slopes(kPathMotor, kOwnMotorSpeed) = 1.0;
    return slopes;
  }

 private:
  FlexibleShaft shaft(const There& t) const { return {model_, law_, side(), t.torque}; }
  static double offsetOf(const Path& path) { return path[kPathOffset] + path[kPathTwist]; }
  double rootAtBlow() const { return std::sqrt(law_.crank_inertia + model_({0.0, side()}).inertia); }

  CouplingLaw law_;
};

}  // namespace hammer_loads::calibration
