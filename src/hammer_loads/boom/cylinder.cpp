#include "hammer_loads/boom/cylinder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Beyond these no figure of a cylinder lies, and no product of figures overflows.
constexpr double kLeastLength = 1e-6;                      // [m]
constexpr double kMostVolume = 1e6, kLeastVolume = 1e-12;  // [m3]
constexpr double kMostPressure = 1e12;                     // [Pa]

/// Finite figures that no cylinder has.
void checkRange(const CylinderParameters& p, std::vector<std::string>& problems) {
  const auto check = [&](const char* key, double value, const char* unit, double least, double most) {
    if (value >= least && value <= most) return;
    problems.push_back(
        format("%s_%s: %.9g %s, must be from %.0e to %.0e %s", p.name.c_str(), key, value, unit, least, most, unit));
  };
  for (const auto& [key, value] : {std::pair{"base_x_m", p.base_x}, std::pair{"base_z_m", p.base_z},
                                   std::pair{"rod_x_m", p.rod_x}, std::pair{"rod_z_m", p.rod_z}}) {
    check(key, value, "m", -figure::kMostLength, figure::kMostLength);
  }
  for (const auto& [key, value] : {std::pair{"bore_m", p.bore}, std::pair{"rod_diameter_m", p.rod_diameter},
                                   std::pair{"closed_length_m", p.closed_length}, std::pair{"stroke_m", p.stroke}}) {
    check(key, value, "m", kLeastLength, figure::kMostLength);
  }
  check("bore_hose_volume_m3", p.bore_hose_volume, "m3", kLeastVolume, kMostVolume);
  check("rod_hose_volume_m3", p.rod_hose_volume, "m3", kLeastVolume, kMostVolume);
  check("relief_pressure_Pa", p.relief_pressure, "Pa", 1.0, kMostPressure);
}

/// Friction, and what is off with sensors.
void checkOptional(const CylinderParameters& p, std::vector<std::string>& problems) {
  const auto within = [&](const char* key, double value, const char* unit, double least, double most) {
    if (value >= least && value <= most) return;
    problems.push_back(
        format("%s_%s: %.9g%s, must be from %g to %g%s", p.name.c_str(), key, value, unit, least, most, unit));
  };
  constexpr double kMostFriction = 0.5, kMostZero = 0.5;  // [-], [rad]
  // Limit: kLeastLength, kMostVolume, kLeastVolume, kMostPressure, kMostFriction, kMostZero
  within("friction_force_N", p.friction_force, " N", 0.0, 1e6);
  within("friction_force_deviation_N", p.friction_force_deviation, " N", 0.0, 1e6);
  within("friction", p.friction, "", 0.0, kMostFriction);
  within("friction_deviation", p.friction_deviation, "", 0.0, kMostFriction);
  within("stiffness_deviation", p.stiffness_deviation, "", 0.0, 1.0);
  within("joint_zero_rad", p.joint_zero, " rad", -kMostZero, kMostZero);
  within("joint_zero_deviation_rad", p.joint_zero_deviation, " rad", 0.0, kMostZero);
  within("pressure_offset_Pa", p.pressure_offset, " Pa", -1e7, 1e7);
  within("pressure_offset_deviation_Pa", p.pressure_offset_deviation, " Pa", 0.0, 1e7);
}

void checkSizes(const CylinderParameters& p, std::vector<std::string>& problems) {
  const char* name = p.name.c_str();
  const auto check = [&](const char* key, double value, const char* unit, bool good, const char* rule) {
    if (!good || !std::isfinite(value)) {
      problems.push_back(format("%s_%s: %.9g %s, must be %s", name, key, value, unit, rule));
    }
  };
  const char* positive = "a finite number > 0";
  for (const auto& [key, value] : {std::pair{"base_x_m", p.base_x}, std::pair{"base_z_m", p.base_z},
                                   std::pair{"rod_x_m", p.rod_x}, std::pair{"rod_z_m", p.rod_z}}) {
    check(key, value, "m", true, "a finite number");
  }
  for (const auto& [key, value] : {std::pair{"bore_m", p.bore}, std::pair{"rod_diameter_m", p.rod_diameter},
                                   std::pair{"closed_length_m", p.closed_length}, std::pair{"stroke_m", p.stroke}}) {
    check(key, value, "m", value > 0.0, positive);
  }
  check("bore_hose_volume_m3", p.bore_hose_volume, "m3", p.bore_hose_volume > 0.0, positive);
  check("rod_hose_volume_m3", p.rod_hose_volume, "m3", p.rod_hose_volume > 0.0, positive);
  check("relief_pressure_Pa", p.relief_pressure, "Pa", p.relief_pressure > 0.0, positive);
  if (!problems.empty()) return;
  checkRange(p, problems);
  if (!problems.empty()) return;
  checkOptional(p, problems);
  check("rod_diameter_m", p.rod_diameter, "m", p.rod_diameter < p.bore,
        format("< %s_bore_m = %.9g m", name, p.bore).c_str());
  check("closed_length_m", p.closed_length, "m", p.closed_length > p.stroke,
        format("> %s_stroke_m = %.9g m", name, p.stroke).c_str());
}

}  // namespace

Checked<Cylinder> Cylinder::make(const CylinderParameters& p, double bulk_modulus, const Chain& chain) {
  Checked<Cylinder> result;
  checkSizes(p, result.problems);
  const std::optional<int> joint = chain.jointIndex(p.joint);
  if (!joint || chain.link(chain.linkBeyond(*joint)).prismatic) {
    result.problems.push_back(
        format("%s_joint: %s, must be a revolute joint of the chain", p.name.c_str(), p.joint.c_str()));
  }
  if (!result.problems.empty()) return result;

  Cylinder cylinder;
  cylinder.parameters_ = p;
  cylinder.joint_ = *joint;
  cylinder.bulk_modulus_ = bulk_modulus;
  cylinder.bore_area_ = 0.25 * kPi * p.bore * p.bore;
  cylinder.rod_area_ = cylinder.bore_area_ - 0.25 * kPi * p.rod_diameter * p.rod_diameter;
  cylinder.findTriangle(chain);
  cylinder.checkReach(chain, result.problems);
  if (result.problems.empty()) result.value = cylinder;
  return result;
}

/// L^2 = |R(q) b - a|^2 with a, b from a point of the joint's axis to the anchors, P: frame before, L: frame beyond.
void Cylinder::findTriangle(const Chain& chain) {
  const ChainLink& link = chain.link(chain.linkBeyond(joint_));
  const Eigen::Vector3d a_P = Eigen::Vector3d(parameters_.base_x, 0.0, parameters_.base_z) - link.origin;
  const Eigen::Vector3d b_L(parameters_.rod_x, 0.0, parameters_.rod_z);
  steady_ = a_P.squaredNorm() + b_L.squaredNorm() - 2.0 * a_P.dot(link.steady * b_L);
  cosine_ = -2.0 * a_P.dot(link.cosine * b_L);
  sine_ = -2.0 * a_P.dot(link.sine * b_L);
  const Eigen::Vector3d b_P = (link.steady + link.cosine) * b_L;
  shorter_side_ = std::min(link.axis.cross(a_P).norm(), link.axis.cross(b_P).norm());
}

void Cylinder::checkReach(const Chain& chain, std::vector<std::string>& problems) const {
  const double lower = chain.lower()[joint_], upper = chain.upper()[joint_];
  const char* joint = parameters_.joint.c_str();
  const char* name = parameters_.name.c_str();
  if (!(shorter_side_ > 0.0)) {
    problems.push_back(format("%s_joint: %s, an anchor lies on its axis, must be beside it", name, joint));
    return;
  }
  if (!std::isfinite(lower) || !std::isfinite(upper)) {
    problems.push_back(format("%s_joint: %s, must have limits in robot_description", name, joint));
    return;
  }
  // Longest and shortest where the anchors are in line with the joint, if within the limits, else at a limit.
  const double longest = std::atan2(sine_, cosine_);
  const double open = parameters_.closed_length + parameters_.stroke;
  double worst = 0.0, worst_angle = 0.0, worst_length = 0.0;
  for (double angle : {lower, upper, longest - kPi, longest, longest + kPi}) {
    if (angle < lower || angle > upper) continue;
    const double length = std::sqrt(std::max(0.0, steady_ + cosine_ * std::cos(angle) + sine_ * std::sin(angle)));
    const double miss = std::max(parameters_.closed_length - length, length - open);
    if (miss > worst) worst = miss, worst_angle = angle, worst_length = length;
  }
  if (worst > 0.0) {
    problems.push_back(
        format("%s_closed_length_m: %.9g m, cannot close the triangle: at %s = %.6g rad its length must be "
               "%.6g m, from closed to open are %.6g to %.6g m",
               name, parameters_.closed_length, joint, worst_angle, worst_length, parameters_.closed_length, open));
  }
}

CylinderPosition Cylinder::at(double joint_angle) const noexcept {
  return at(std::cos(joint_angle), std::sin(joint_angle));
}

CylinderPosition Cylinder::at(double c, double s) const noexcept {
  CylinderPosition position;
  position.length = std::sqrt(steady_ + cosine_ * c + sine_ * s);
  position.arm = (sine_ * c - cosine_ * s) / (2.0 * position.length);
  position.dead_centre = !(std::abs(position.arm) >= kDeadCentreRatio * shorter_side_);
  return position;
}

CylinderLoad Cylinder::load(const CylinderPosition& position, double joint_torque) const noexcept {
  if (position.dead_centre) {
    return {kNaN, kNaN, true};
  }
  const double force = -joint_torque / position.arm;
  return {force, force >= 0.0 ? force / bore_area_ : -force / rod_area_, false};
}

OilVolumes Cylinder::volumes(double length) const noexcept {
  const double extension = std::clamp(length - parameters_.closed_length, 0.0, parameters_.stroke);
  return {parameters_.bore_hose_volume + bore_area_ * extension,
          parameters_.rod_hose_volume + rod_area_ * (parameters_.stroke - extension)};
}

double Cylinder::stiffness(double length) const noexcept {
  const OilVolumes volume = volumes(length);
  return bulk_modulus_ * (bore_area_ * bore_area_ / volume.bore + rod_area_ * rod_area_ / volume.rod);
}

double Cylinder::jointStiffness(const CylinderPosition& position) const noexcept {
  return stiffness(position.length) * position.arm * position.arm;
}

}  // namespace hammer_loads
