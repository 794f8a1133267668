#include "hammer_loads/boom/cylinder.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kMostVolume = 1e6, kLeastVolume = 1e-12;  // [m3]
constexpr double kMostPressure = 1e12;                     // [Pa]

void checkRanges(const CylinderParameters& p, std::vector<std::string>& problems) {
  const auto check = [&](const char* key, double value, const char* unit, double least, double most) {
    checkRange(p.name + "_" + key, value, unit, least, most, problems);
  };
  constexpr double kMostFriction = 0.5, kMostZero = 0.5;  // [-], [rad]
  // Limit: kMostVolume, kLeastVolume, kMostPressure, kMostFriction, kMostZero
  check("base_x_m", p.base_x, "m", -figure::kMostLength, figure::kMostLength);
  check("base_z_m", p.base_z, "m", -figure::kMostLength, figure::kMostLength);
  check("rod_x_m", p.rod_x, "m", -figure::kMostLength, figure::kMostLength);
  check("rod_z_m", p.rod_z, "m", -figure::kMostLength, figure::kMostLength);
  check("bore_m", p.bore, "m", figure::kLeastLength, figure::kMostLength);
  check("rod_diameter_m", p.rod_diameter, "m", figure::kLeastLength, figure::kMostLength);
  check("closed_length_m", p.closed_length, "m", figure::kLeastLength, figure::kMostLength);
  check("stroke_m", p.stroke, "m", figure::kLeastLength, figure::kMostLength);
  check("bore_hose_volume_m3", p.bore_hose_volume, "m3", kLeastVolume, kMostVolume);
  check("rod_hose_volume_m3", p.rod_hose_volume, "m3", kLeastVolume, kMostVolume);
  check("relief_pressure_Pa", p.relief_pressure, "Pa", 1.0, kMostPressure);
  check("friction_force_N", p.friction_force, "N", 0.0, 1e6);
  if (!std::isnan(p.friction_force_std)) check("friction_force_std_N", p.friction_force_std, "N", 0.0, 1e6);
  check("friction", p.friction, "", 0.0, kMostFriction);
  check("friction_std", p.friction_std, "", 0.0, kMostFriction);
  check("stiffness_std", p.stiffness_std, "", 0.0, 1.0);
  check("joint_zero_rad", p.joint_zero, "rad", -kMostZero, kMostZero);
  check("joint_zero_std_rad", p.joint_zero_std, "rad", 0.0, kMostZero);
  check("pressure_offset_Pa", p.pressure_offset, "Pa", -1e7, 1e7);
  check("pressure_offset_std_Pa", p.pressure_offset_std, "Pa", 0.0, 1e7);
  if (!p.linkage) return;
  check("rocker_link_base_x_m", p.linkage->guide_x, "m", -figure::kMostLength, figure::kMostLength);
  check("rocker_link_base_z_m", p.linkage->guide_z, "m", -figure::kMostLength, figure::kMostLength);
  check("rocker_link_length_m", p.linkage->guide_length, "m", figure::kLeastLength, figure::kMostLength);
  check("coupler_length_m", p.linkage->coupler_length, "m", figure::kLeastLength, figure::kMostLength);
  if (std::abs(p.linkage->branch) != 1.0 && p.linkage->branch != 0.0)
    problems.push_back(format("%s_linkage_branch: %.9g, must be 1 or -1", p.name.c_str(), p.linkage->branch));
}

void checkSizes(const CylinderParameters& p, std::vector<std::string>& problems) {
  const char* name = p.name.c_str();
  if (!(p.rod_diameter < p.bore))
    problems.push_back(
        format("%s_rod_diameter_m: %.9g m, must be < %s_bore_m = %.9g m", name, p.rod_diameter, name, p.bore));
  if (!(p.closed_length > p.stroke))
    problems.push_back(
        format("%s_closed_length_m: %.9g m, must be > %s_stroke_m = %.9g m", name, p.closed_length, name, p.stroke));
}

constexpr double kInPlane = 1e-6;  // tolerance of pins and joint being in one plane [-], [m]
constexpr int kRangeSteps = 1000;  // steps over the joint's range
// Numerical: kInPlane, kRangeSteps

Eigen::Vector2d inPlane(const Eigen::Vector3d& v) { return {v.x(), v.z()}; }

/// Returns true if the joint turns both links about their common y and lies in the plane of the pins.
bool isPlanar(const ChainLink& link) {
  const Eigen::Matrix3d at_zero = link.steady + link.cosine;
  return std::abs(std::abs(link.axis.y()) - 1.0) < kInPlane && std::abs(at_zero(1, 1) - 1.0) < kInPlane &&
         std::abs(link.origin.y()) < kInPlane;
}

}  // namespace

Checked<Cylinder> Cylinder::make(const CylinderParameters& p, double bulk_modulus, const Chain& chain) {
  Checked<Cylinder> result;
  checkRanges(p, result.problems);
  if (result.problems.empty()) checkSizes(p, result.problems);
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
  if (std::isnan(p.friction_force_std))
    cylinder.parameters_.friction_force_std = CylinderParameters::kFrictionForceDeviation * cylinder.greatestPush();
  if (!cylinder.hasLimits(chain, result.problems)) return result;
  if (p.linkage)
    cylinder.findLinkage(chain, result.problems);
  else
    cylinder.findTriangle(chain);
  if (result.problems.empty()) cylinder.checkReach(chain, result.problems);
  if (result.problems.empty()) result.value = cylinder;
  return result;
}

/// Finds L^2 = |R(q) b - a|^2 with a, b from a point of the axis to the anchors. P: frame before; L: frame beyond.
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

/// Finds the linkage of the branch in the file, or else of the branch whose length fits the stroke.
void Cylinder::findLinkage(const Chain& chain, std::vector<std::string>& problems) {
  const ChainLink& link = chain.link(chain.linkBeyond(joint_));
  const char* name = parameters_.name.c_str();
  if (!isPlanar(link)) {
    problems.push_back(format("%s_linkage: bucket, %s must turn about y, with its origin at y = 0 of the link before",
                              name, parameters_.joint.c_str()));
    return;
  }
  BucketLinkageParameters& given = *parameters_.linkage;
  const Eigen::Vector2d origin = inPlane(link.origin);
  const Eigen::Vector3d driven(parameters_.rod_x, 0.0, parameters_.rod_z);
  const BucketLinkage::Pins pins{Eigen::Vector2d(parameters_.base_x, parameters_.base_z) - origin,
                                 Eigen::Vector2d(given.guide_x, given.guide_z) - origin,
                                 inPlane((link.steady + link.cosine) * driven), link.axis.y() > 0.0 ? 1.0 : -1.0};
  shorter_side_ = std::min(pins.driven.norm(), given.guide_length);
  if (!(shorter_side_ > 0.0)) return;
  const auto miss = [&](double branch) {
    given.branch = branch;
    linkage_.emplace(pins, given);
    return worstReach(chain).miss;
  };
  if (given.branch == 0.0) {
    const double one = miss(1.0), other = miss(-1.0);
    if (one == 0.0 && other == 0.0)
      problems.push_back(
          format("%s_linkage_branch: not given, must be 1 or -1: closed length and stroke fit both", name));
    given.branch = one < other ? 1.0 : -1.0;
  }
  linkage_.emplace(pins, given);
  checkClosure(chain, problems);
}

void Cylinder::checkClosure(const Chain& chain, std::vector<std::string>& problems) const {
  const double lower = chain.lower()[joint_], upper = chain.upper()[joint_];
  double worst = 0.0, worst_angle = 0.0, worst_reach = 0.0;
  for (int i = 0; i <= kRangeSteps; ++i) {
    const double angle = lower + (upper - lower) * i / kRangeSteps;
    const double reach = linkage_->reach(linkage_->at(std::cos(angle), std::sin(angle)));
    const double miss = std::max(linkage_->leastReach() - reach, reach - linkage_->mostReach());
    if (miss > worst) worst = miss, worst_angle = angle, worst_reach = reach;
  }
  if (!(worst > 0.0)) return;
  problems.push_back(
      format("%s_coupler_length_m: %.9g m, cannot close the linkage: at %s = %.6g rad guide pivot and driven pin are "
             "%.6g m apart, must be from %.6g to %.6g m",
             parameters_.name.c_str(), parameters_.linkage->coupler_length, parameters_.joint.c_str(), worst_angle,
             worst_reach, linkage_->leastReach(), linkage_->mostReach()));
}

bool Cylinder::hasLimits(const Chain& chain, std::vector<std::string>& problems) const {
  if (std::isfinite(chain.lower()[joint_]) && std::isfinite(chain.upper()[joint_])) return true;
  problems.push_back(format("%s_joint: %s, must have limits in robot_description", parameters_.name.c_str(),
                            parameters_.joint.c_str()));
  return false;
}

Cylinder::Reach Cylinder::worstReach(const Chain& chain) const {
  const double lower = chain.lower()[joint_], upper = chain.upper()[joint_];
  const double open = parameters_.closed_length + parameters_.stroke;
  Reach worst;
  const auto judge = [&](double angle) {
    const double length = at(angle).length, miss = std::max(parameters_.closed_length - length, length - open);
    if (miss > worst.miss) worst = {miss, angle, length};
  };
  judge(lower), judge(upper);
  if (linkage_) {  // extremes between two steps are wrong by 1e-6 of a length
    for (int i = 1; i < kRangeSteps; ++i) judge(lower + (upper - lower) * i / kRangeSteps);
    return worst;
  }
  // The length is extreme where the anchors are in line with the joint. Only angles within the limits count.
  const double longest = std::atan2(sine_, cosine_);
  for (double angle : {longest - kPi, longest, longest + kPi})
    if (angle > lower && angle < upper) judge(angle);
  return worst;
}

void Cylinder::checkReach(const Chain& chain, std::vector<std::string>& problems) const {
  const char* joint = parameters_.joint.c_str();
  const char* name = parameters_.name.c_str();
  if (!(shorter_side_ > 0.0)) {
    problems.push_back(format("%s_joint: %s, an anchor lies on its axis, must be beside it", name, joint));
    return;
  }
  const Reach worst = worstReach(chain);
  if (!(worst.miss > 0.0)) return;
  problems.push_back(
      format("%s_closed_length_m: %.9g m, cannot close the %s: at %s = %.6g rad its length must be "
             "%.6g m, from closed to open are %.6g to %.6g m",
             name, parameters_.closed_length, linkage_ ? "linkage" : "triangle", joint, worst.angle, worst.length,
             parameters_.closed_length, parameters_.closed_length + parameters_.stroke));
}

CylinderPosition Cylinder::at(double joint_angle) const noexcept {
  return at(std::cos(joint_angle), std::sin(joint_angle));
}

CylinderPosition Cylinder::at(double c, double s) const noexcept {
  CylinderPosition position;
  if (linkage_) {
    const BucketLinkagePosition links = linkage_->at(c, s);
    position.length = links.length, position.arm = links.arm, position.arm_rate = links.arm_rate;
    position.rod_pin = links.rod_pin, position.driven_pin = links.driven_pin;
  } else {
    position.length = std::sqrt(steady_ + cosine_ * c + sine_ * s);
    position.arm = (sine_ * c - cosine_ * s) / (2.0 * position.length);
    position.arm_rate = -(0.5 * (cosine_ * c + sine_ * s) + position.arm * position.arm) / position.length;
  }
  position.zero_moment_arm = !(std::abs(position.arm) >= kZeroMomentArmRatio * shorter_side_);
  return position;
}

CylinderForce Cylinder::load(const CylinderPosition& position, double joint_torque) const noexcept {
  if (position.zero_moment_arm) {
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

ChamberPressures chamberPressures(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                                  double total_torque) noexcept {
  const double steady = -steady_torque / position.arm, change = -(total_torque - steady_torque) / position.arm;
  const OilVolumes volume = cylinder.volumes(position.length);
  const double bore = cylinder.boreArea(), rod = cylinder.rodArea();
  // Both chambers have the same displacement dL, so that dp = B A dL/V.
  const double bore_share = bore / volume.bore, rod_share = rod / volume.rod;
  const double stroke = change / (bore * bore_share + rod * rod_share);
  return {std::max(steady, 0.0) / bore + bore_share * stroke, std::max(-steady, 0.0) / rod - rod_share * stroke};
}

std::uint16_t cylinderFlags(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                            double total_torque) noexcept {
  if (position.zero_moment_arm) return kZeroMomentArm;
  constexpr double kVacuum = -1.0e5;  // [Pa]
  // Limit: kVacuum
  const ChamberPressures p = chamberPressures(cylinder, position, steady_torque, total_torque);
  const double relief = cylinder.parameters().relief_pressure;
  const bool empty = p.bore < kVacuum || p.rod < kVacuum;
  const bool reversed = steady_torque * total_torque < 0.0;
  const bool yields = p.bore >= relief || p.rod >= relief;
  return static_cast<std::uint16_t>((empty ? kChamberEmpty : 0) | (reversed ? kForceReversed : 0) |
                                    (yields ? kReliefReached : 0));
}

}  // namespace hammer_loads
