#include <cmath>

#include "hammer_loads/ros/fill_messages.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kLongestLimit = 256;  // reserved characters, more than a cylinder's name has

// Vectors of Eigen 3.3 have no begin() and end().
void assign(const JointVector& from, std::vector<double>& to) { to.assign(from.data(), from.data() + from.size()); }

void copy(const Eigen::Vector3d& from, geometry_msgs::Vector3& to) {
  to.x = from.x(), to.y = from.y(), to.z = from.z();
}

void copy(const Wrench& from, geometry_msgs::Wrench& to) {
  copy(from.force, to.force);
  copy(from.torque, to.torque);
}

void copy(const Wrench& from, boost::array<double, 6>& to) {
  Eigen::Map<Eigen::Vector3d>(to.data()) = from.force, Eigen::Map<Eigen::Vector3d>(to.data() + 3) = from.torque;
}

}  // namespace

void prepareJointLoads(const Boom& boom, JointLoads& message) {
  message.header.frame_id = boom.parameters().chain.root;
  message.joint.clear(), message.cylinder.clear();
  for (const std::string& name : boom.chain().jointNames()) {
    JointLoad& joint = message.joint.emplace_back();
    joint.name = name;
    joint.total_torque_std = joint.total_torque_systematic_std = kNaN;
  }
  for (const Cylinder& of_boom : boom.cylinders()) {
    CylinderLoad& cylinder = message.cylinder.emplace_back();
    cylinder.name = of_boom.parameters().name;
    cylinder.force_std = cylinder.force_systematic_std = kNaN;
  }
}

void prepareSections(const Boom& boom, SectionLoads& message) {
  message.header.frame_id = boom.parameters().chain.root;
  message.section.clear();
  for (const Section& section : boom.sections()) message.section.emplace_back().name = section.name();
}

void prepareReactions(const Boom& boom, JointReactions& message) {
  message.header.frame_id = boom.parameters().chain.root;
  message.joint.clear(), message.cylinder.clear();
  for (const std::string& name : boom.chain().jointNames()) message.joint.emplace_back().name = name;
  for (const Cylinder& cylinder : boom.cylinders()) message.cylinder.emplace_back().name = cylinder.parameters().name;
}

CylinderJoints::CylinderJoints(const Boom& boom, sensor_msgs::JointState& message) {
  for (const Cylinder& cylinder : boom.cylinders()) {
    const CylinderDrawing& drawing = drawings_.emplace_back(boom.chain(), cylinder);
    message.name.insert(message.name.end(), drawing.names().begin(), drawing.names().end());
  }
  message.position.resize(message.name.size());
  message.velocity.resize(message.name.size());
}

void CylinderJoints::fill(const Boom& boom, sensor_msgs::JointState& message) const {
  constexpr double kStep = 1e-5;  // step of differences [rad]
  // Numerical: kStep
  std::size_t first = message.name.size();
  for (std::size_t k = drawings_.size(); k-- > 0;) {
    const CylinderDrawing& drawing = drawings_[k];
    const int joint = boom.cylinders()[k].joint();
    const double angle = boom.motion().position[joint], rate = boom.motion().velocity[joint];
    const auto now = drawing.positions(angle), up = drawing.positions(angle + kStep),
               down = drawing.positions(angle - kStep);
    first -= drawing.names().size();
    for (std::size_t i = 0; i < drawing.names().size(); ++i) {
      message.position[first + i] = now[i];
      message.velocity[first + i] = std::remainder(up[i] - down[i], kTwoPi) / (2.0 * kStep) * rate;
    }
  }
}

void prepareVibration(const Boom& boom, BoomVibration& message) {
  message.header.frame_id = boom.parameters().chain.tip;
  for (std::vector<double>* values :
       {&message.natural_frequency, &message.natural_frequency_std, &message.damping_ratio})
    values->reserve(kMaxJoints);
  message.hold_down_limit.reserve(kLongestLimit);
}

void fillJointLoads(const BoomState& state, JointLoads& message) {
  message.header.stamp = timeOf(state.stamp);
  for (std::size_t i = 0; i < message.joint.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    JointLoad& joint = message.joint[i];
    joint.hammer_torque = state.loads.hammer[at];
    joint.weight_torque = state.loads.weight[at];
    joint.motion_torque = state.loads.motion[at];
    joint.vibration_torque = state.loads.vibration[at];
    joint.contact_torque = state.contact_torque[at];
    joint.total_torque = state.loads.total[at];
    joint.total_torque_std = state.deviations.torque[at];
    joint.total_torque_systematic_std = state.common.torque[at];
  }
  for (std::size_t i = 0; i < message.cylinder.size(); ++i) {
    CylinderLoad& cylinder = message.cylinder[i];
    cylinder.force = state.loads.cylinder[i].force;
    cylinder.force_std = state.deviations.cylinder[i];
    cylinder.force_systematic_std = state.common.cylinder[i];
    cylinder.pressure = state.loads.cylinder[i].pressure;
    cylinder.flags = state.cylinder_flags[i];
  }
  message.flags = 0;
  if (state.hold_down_force_lost) message.flags |= JointLoads::FLAG_HOLD_DOWN_LOST;
  if (state.hold_down && state.hold_down->least < 1.0) message.flags |= JointLoads::FLAG_HOLD_DOWN;
  if (state.measured) message.flags |= JointLoads::FLAG_MEASURED;
}

void fillSections(const BoomState& state, SectionLoads& message) {
  message.header.stamp = timeOf(state.stamp);
  for (std::size_t i = 0; i < message.section.size(); ++i) {
    SectionLoad& section = message.section[i];
    copy(state.steel.section[i], section.load);
    copy(state.deviations.section[i], section.load_std);
    copy(state.common.section[i], section.load_systematic_std);
  }
}

void fillReactions(const BoomState& state, JointReactions& message) {
  message.header.stamp = timeOf(state.stamp);
  for (std::size_t i = 0; i < message.joint.size(); ++i) {
    JointReaction& joint = message.joint[i];
    copy(state.steel.joint[i], joint.load);
    copy(state.deviations.joint[i], joint.load_std);
    copy(state.common.joint[i], joint.load_systematic_std);
  }
  for (std::size_t i = 0; i < message.cylinder.size(); ++i) {
    CylinderReaction& cylinder = message.cylinder[i];
    copy(state.steel.pins[i].base, cylinder.base_force);
    copy(state.steel.pins[i].guide, cylinder.guide_force);
    copy(state.steel.pins[i].rod, cylinder.rod_force);
  }
}

void fillVibration(const BoomFollower& follower, BoomVibration& message) {
  const BoomState& state = follower.state();
  message.header.stamp = timeOf(state.stamp);
  copy(state.tip.displacement.head<3>(), message.displacement);
  copy(state.tip.displacement.tail<3>(), message.rotation);
  copy(state.tip.acceleration.head<3>(), message.acceleration);
  assign(state.frequency, message.natural_frequency);
  assign(state.frequency_std, message.natural_frequency_std);
  assign(state.damping, message.damping_ratio);
  message.identified = state.identified;
  message.reduced_mass = state.reduced.mass;
  message.reduced_stiffness = state.reduced.stiffness;
  message.compliant = state.choice.compliant;
  message.zero_moment_arm = state.zero_moment_arm;
  message.rigid_error = state.choice.judged ? state.choice.rigid_error : kNaN;
  message.rigid_tolerance = state.choice.rigid_tolerance;
  message.pulse_length = state.choice.judged ? state.choice.pulse_length : kNaN;
  message.hold_down_factor = state.hold_down ? state.hold_down->least : kNaN;
  message.hold_down_limit = follower.firstToGive();
}

void fillWrench(StampNs stamp, const Wrench& wrench, geometry_msgs::WrenchStamped& message) {
  message.header.stamp = timeOf(stamp);
  copy(wrench.force, message.wrench.force);
  copy(wrench.torque, message.wrench.torque);
}

}  // namespace hammer_loads
