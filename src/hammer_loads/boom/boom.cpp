#include "hammer_loads/boom/boom.h"

#include <cmath>
#include <set>
#include <utility>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/boom/load_errors.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kMostRefreshAngle = 0.05;  // [rad]; makes frequencies some 2 % wrong; modes of a farther pose diverge
// Limit: kMostRefreshAngle

void checkParameters(const BoomParameters& p, std::vector<std::string>& problems) {
  const auto check = [&](const char* key, double value, const char* unit, double least, double most) {
    checkRange(key, value, unit, least, most, problems);
  };
  const bool no_oil = p.cylinders.empty() && p.bulk_modulus == 0.0 && p.vibration.damping_ratio == 0.0 &&
                      p.vibration.refresh_angle == 0.0 && p.rigid_tolerance == 0.0;
  if (!no_oil) {
    check("bulk_modulus_Pa", p.bulk_modulus, "Pa", 1.0, 1e15);
    check("mode_refresh_angle_rad", p.vibration.refresh_angle, "rad", 0.0, kMostRefreshAngle);
    const double zeta = p.vibration.damping_ratio, tolerance = p.rigid_tolerance;
    if (!(zeta > 0.0 && zeta < 1.0)) problems.push_back(format("damping_ratio: %.9g, must be > 0 and < 1", zeta));
    if (!(tolerance > 0.0 && std::isfinite(tolerance)))
      problems.push_back(format("rigid_tolerance: %.9g, must be a finite number > 0", tolerance));
  }
  if (!p.supports) return;
  const Supports& s = *p.supports;
  check("support_front_x_m", s.front_x, "m", -figure::kMostLength, figure::kMostLength);
  check("support_front_half_width_m", s.front_half_width, "m", figure::kLeastLength, figure::kMostLength);
  check("support_rear_x_m", s.rear_x, "m", -figure::kMostLength, figure::kMostLength);
  check("support_rear_half_width_m", s.rear_half_width, "m", figure::kLeastLength, figure::kMostLength);
  if (!(s.front_x > s.rear_x))
    problems.push_back(format("support_front_x_m: %.9g m, must be > support_rear_x_m = %.9g m", s.front_x, s.rear_x));
}

std::vector<Section> makeSections(const std::vector<SectionParameters>& given, const Chain& chain,
                                  std::vector<std::string>& problems, std::vector<std::string>& notes) {
  std::vector<Section> sections;
  std::set<std::string> names;
  for (const SectionParameters& p : given) {
    if (!names.insert(p.name).second)
      problems.push_back(format("sections: %s, given twice, must be different names", p.name.c_str()));
    const Checked<Section> section = Section::make(p, chain);
    problems.insert(problems.end(), section.problems.begin(), section.problems.end());
    notes.insert(notes.end(), section.notes.begin(), section.notes.end());
    if (section.value) sections.push_back(*section.value);
  }
  if (given.size() > kMaxSections)
    problems.push_back(format("sections: %zu names, must be at most %d", given.size(), kMaxSections));
  return sections;
}

/// Requires inertia about the axis of each joint with a cylinder; otherwise its frequency would be infinite.
void checkInertia(const Chain& chain, const std::vector<Cylinder>& cylinders, std::vector<std::string>& problems) {
  JointVector middle(chain.joints());
  for (int j = 0; j < chain.joints(); ++j) {
    const double sum = 0.5 * chain.lower()[j] + 0.5 * chain.upper()[j];
    middle[j] = std::isfinite(sum) ? sum : 0.0;
  }
  const JointMatrix M = MassMatrix(chain).at(middle);
  for (const Cylinder& cylinder : cylinders) {
    const int j = cylinder.joint();
    if (M(j, j) > 0.0) continue;
    problems.push_back(format("robot_description: inertia beyond joint %s about its axis: %.6g kg m2, must be > 0",
                              cylinder.parameters().joint.c_str(), M(j, j)));
  }
}

}  // namespace

Checked<Boom> Boom::make(const RobotDescription& description, const BoomParameters& parameters) {
  Checked<Boom> result;
  checkParameters(parameters, result.problems);
  const Checked<Chain> chain = Chain::make(description, parameters.chain);
  result.problems.insert(result.problems.end(), chain.problems.begin(), chain.problems.end());
  result.notes = chain.notes;
  if (!chain.value) return result;

  std::vector<Cylinder> cylinders;
  std::set<std::string> spanned;
  for (const CylinderParameters& given : parameters.cylinders) {
    const Checked<Cylinder> cylinder = Cylinder::make(given, parameters.bulk_modulus, *chain.value);
    result.problems.insert(result.problems.end(), cylinder.problems.begin(), cylinder.problems.end());
    if (cylinder.value) cylinders.push_back(*cylinder.value);
    if (!spanned.insert(given.joint).second) {
      result.problems.push_back(format("%s_joint: %s, has a cylinder already, must have at most one",
                                       given.name.c_str(), given.joint.c_str()));
    }
  }
  std::vector<Section> sections = makeSections(parameters.sections, *chain.value, result.problems, result.notes);
  if (result.problems.empty()) checkInertia(*chain.value, cylinders, result.problems);
  if (result.problems.empty()) result.value = Boom(*chain.value, std::move(cylinders), std::move(sections), parameters);
  return result;
}

std::optional<Boom> Boom::weighed(const RobotDescription& description, std::vector<WeighedLink> links) const {
  BoomParameters parameters = parameters_;
  parameters.sections.clear();
  parameters.chain.weighed = std::move(links);
  const Checked<Chain> chain = Chain::make(description, parameters.chain);
  std::vector<std::string> problems;
  if (chain.value) checkInertia(*chain.value, cylinders_, problems);
  if (!chain.value || !problems.empty()) return std::nullopt;
  return Boom(*chain.value, cylinders_, {}, parameters);
}

Boom::Boom(const Chain& chain, std::vector<Cylinder> cylinders, std::vector<Section> sections,
           const BoomParameters& parameters)
    : chain_(chain),
      cylinders_(std::move(cylinders)),
      parameters_(parameters),
      vibration_(chain, cylinders_, parameters.vibration),
      steel_(chain, cylinders_, std::move(sections)) {
  const JointVector zero = JointVector::Zero(chain.joints());
  const Eigen::Index joints = chain.joints(), held = static_cast<Eigen::Index>(cylinders_.size());
  const Eigen::Index rows = 7 * joints + 6 * static_cast<Eigen::Index>(this->sections().size()) + 3 * held;
  response_.setZero(rows, held + 6);
  response_in_plane_.setZero(rows, held + 3);
  rows_in_plane_.setZero(rows);
  variance_.setZero(rows);
  deviation_.setZero(rows);
  weight_std_ = zero;
  bending_ = JointMatrix::Zero(joints, 0);
  response_at_ = JointVector::Constant(joints, kNaN);
  move({zero, zero, zero}, Eigen::Vector3d::Zero());
}

void Boom::move(const JointMotion& motion, const Eigen::Vector3d& g_B) noexcept {
  joints_ = motion;
  steady_position_ = motion.position;
  g_B_ = g_B;
  forwardKinematics(chain_, joints_.position, pose_);
  jacobian_ = hammer_loads::tipJacobian(pose_);
  for (std::size_t i = 0; i < cylinders_.size(); ++i) {
    const auto joint = static_cast<std::size_t>(cylinders_[i].joint());
    at_[i] = cylinders_[i].at(pose_.cosine[joint], pose_.sine[joint]);
  }
  weight_ = jointTorqueOfWeight(chain_, pose_, g_B);
  placeBodies(chain_, pose_, bodies_);
  motion_ = torqueOfMotion(chain_, pose_, bodies_, motion);
}

void Boom::moveCompliant(const JointMotion& motion, const Eigen::Vector3d& g_B) noexcept {
  move(motion, g_B);
  vibration_.setPose(motion.position, g_B);
}

void Boom::moveVibrating(const JointMotion& motion, const JointVector& displacement,
                         const Eigen::Vector3d& g_B) noexcept {
  vibration_.setPose(motion.position, g_B);
  JointMotion displaced = motion;
  displaced.position += displacement;
  move(displaced, g_B);
  steady_position_ = motion.position;
}

Eigen::Vector3d Boom::gravityAtTip() const noexcept { return pose_.tip().linear().transpose() * g_B_; }

Boom::TipVibration Boom::tipVibration() const noexcept {
  const auto ofTip = [&](const JointVector& of_joints) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    withCount<4>(chain_.joints(), [&](auto joints) {
      for (int j = 0; j < joints; ++j) sum += of_joints[j] * jacobian_.col(j);
    });
    return sum;
  };
  return {ofTip(vibration_.displacement()), ofTip(vibration_.velocity()), ofTip(vibration_.acceleration())};
}

ReducedHull Boom::reducedHull(const Eigen::Vector3d& direction) const noexcept {
  const BoomModes& modes = vibration_.modes();
  const JointVector modal = modalForce(modes, hammerTorque({direction, Eigen::Vector3d::Zero()}));
  const double mobility = modal.squaredNorm(), compliance = modal.cwiseQuotient(modes.omega).squaredNorm();
  return {mobility > 0.0 ? 1.0 / mobility : kInfinity, compliance > 0.0 ? 1.0 / compliance : kInfinity};
}

ChainLoads Boom::chainLoads(bool rigid) const noexcept {
  JointMotion motion = joints_;
  if (!rigid) motion.velocity += vibration_.velocity(), motion.acceleration += vibration_.acceleration();
  ChainLoads links;
  findChainLoads(chain_, pose_, bodies_, motion, g_B_, links);
  return links;
}

bool Boom::loads(const Wrench& w_tip, bool rigid, const ChainLoads& links, BoomLoads& result) const noexcept {
  result.hammer = hammerTorque(w_tip);
  result.weight = weight_;
  result.motion = motion_;
  if (rigid || vibration_.rests()) {
    result.vibration.setZero(chain_.joints());
  } else {
    result.vibration = jointTorque(chain_, pose_, links) - weight_ - motion_;
  }
  result.total = result.hammer + result.weight + result.motion + result.vibration;
  bool finite = result.total.allFinite();
  for (std::size_t i = 0; i < cylinders_.size(); ++i) {
    const Cylinder& cylinder = cylinders_[i];
    CylinderForce& load = result.cylinder[i];
    load = cylinder.load(at_[i], result.total[cylinder.joint()]);
    finite = finite && (load.zero_moment_arm || (std::isfinite(load.force) && std::isfinite(load.pressure)));
  }
  return finite;
}

bool Boom::steelLoads(const Wrench& w_tip, const ChainLoads& links, SteelLoads& result) const noexcept {
  return steel_.find({pose_, links, w_tip, at_.data()}, result);
}

JointVector Boom::jointZeros() const noexcept {
  JointVector zeros = JointVector::Zero(chain_.joints());
  for (const Cylinder& cylinder : cylinders_) zeros[cylinder.joint()] = cylinder.parameters().joint_zero;
  return zeros;
}

double Boom::rigidError(const Wrench& w_peak, double pulse_length) const noexcept {
  const double damping = vibration_.known() ? vibration_.mode(0).zeta : parameters_.vibration.damping_ratio;
  return hammer_loads::rigidError(vibration_.modes(), damping, hammerTorque(w_peak), pulse_length);
}

}  // namespace hammer_loads
