#include "hammer_loads/boom/hold_down.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

/// Returns the multiple of `load` that, added to `now`, reaches `limit`. All are positive in the direction of failure.
double factor(double now, double load, double limit) noexcept {
  if (!(now <= limit) || std::isnan(load)) return 0.0;
  return load > 0.0 ? (limit - now) / load : kInfinity;
}

/// Returns the moment about an edge of the supports; positive lifts the machine inside, to the left of the edge.
double tippingMoment(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& point,
                     const Eigen::Vector3d& force, const Eigen::Vector3d& moment) noexcept {
  return (to - from).normalized().dot(moment + (point - from).cross(force));
}

double cylinderFactor(const Cylinder& cylinder, double angle, double weight, double load) noexcept {
  const CylinderPosition at = cylinder.at(angle);
  if (at.zero_moment_arm) return weight == 0.0 && load == 0.0 ? kInfinity : 0.0;
  const double force_weight = -weight / at.arm, force_load = -load / at.arm;
  return std::min(factor(force_weight, force_load, cylinder.greatestPush()),
                  factor(-force_weight, -force_load, cylinder.greatestPull()));
}

/// Finds the least factor of the load at which the machine tips over an edge of its supports.
void tipOver(const Supports& s, const PointMass& machine, const Eigen::Vector3d& g_B, const Eigen::Vector3d& p_BH_B,
             const Eigen::Vector3d& f_B, const Eigen::Vector3d& t_B, HoldDown& result) noexcept {
  const std::array<Eigen::Vector3d, 4> corner{
      Eigen::Vector3d(s.front_x, -s.front_half_width, 0.0), Eigen::Vector3d(s.front_x, s.front_half_width, 0.0),
      Eigen::Vector3d(s.rear_x, s.rear_half_width, 0.0), Eigen::Vector3d(s.rear_x, -s.rear_half_width, 0.0)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d &from = corner[i], &to = corner[(i + 1) % 4];
    const double weight = tippingMoment(from, to, machine.p, machine.mass * g_B, Eigen::Vector3d::Zero());
    const double times = factor(weight, tippingMoment(from, to, p_BH_B, f_B, t_B), 0.0);
    if (times < result.machine) result.machine = times, result.edge = static_cast<int>(i);
  }
}

}  // namespace

HoldDown Boom::holdDown(const Wrench& w_mean) const noexcept {
  HoldDown result;
  result.machine = kInfinity;
  if (parameters_.supports) {
    const Pose& X_BH = pose_.tip();
    tipOver(*parameters_.supports, massFrom(chain_, pose_, 0), g_B_, X_BH.translation(), X_BH.linear() * w_mean.force,
            X_BH.linear() * w_mean.torque, result);
  }
  result.least = result.machine;
  const JointVector load = hammerTorque(w_mean);
  for (std::size_t i = 0; i < cylinders_.size(); ++i) {
    const int joint = cylinders_[i].joint();
    result.cylinder[i] = cylinderFactor(cylinders_[i], joints_.position[joint], weight_[joint], load[joint]);
    result.least = std::min(result.least, result.cylinder[i]);
  }
  return result;
}

InPlaneTip::InPlaneTip(const Jacobian& J, const std::array<int, 3>& joints) noexcept : joints_(joints) {
  // Torque on a joint per unit of (force x, force z, moment y).
  const auto row = [&](std::size_t i) {
    const int joint = joints[i];
    return Eigen::Vector3d(J(0, joint), J(2, joint), J(4, joint));
  };
  const Eigen::Vector3d a = row(0), b = row(1), c = row(2), bc = b.cross(c);
  const double determinant = a.dot(bc);
  const Eigen::Array3d size = a.array().square() + b.array().square() + c.array().square();
  known_ = square(determinant) > square(1e-3) * size.prod();
  inverse_ << bc, c.cross(a), a.cross(b);
  inverse_ *= 1.0 / determinant;
}

}  // namespace hammer_loads
