#include "hammer_loads/ros/fill_boom.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kLongestLimit = 256;  // more than a cylinder's name has

// Vectors of Eigen 3.3 have no begin() and end().
void copy(const JointVector& from, std::vector<double>& to) { std::copy_n(from.data(), from.size(), to.begin()); }

void assign(const JointVector& from, std::vector<double>& to) { to.assign(from.data(), from.data() + from.size()); }

void copy(const Eigen::Vector3d& from, geometry_msgs::Vector3& to) {
  to.x = from.x(), to.y = from.y(), to.z = from.z();
}

void copy(const Wrench& from, geometry_msgs::Wrench& to) {
  copy(from.force, to.force);
  copy(from.torque, to.torque);
}

}  // namespace

void prepareJointLoads(const Boom& boom, JointLoads& message) {
  const auto joints = static_cast<std::size_t>(boom.chain().joints());
  message.header.frame_id = boom.parameters().chain.root;
  message.joint_name = boom.chain().jointNames();
  for (std::vector<double>* torque : {&message.hammer_torque, &message.weight_torque, &message.motion_torque,
                                      &message.vibration_torque, &message.total_torque})
    torque->resize(joints);
  for (const Cylinder& cylinder : boom.cylinders()) message.cylinder_name.push_back(cylinder.parameters().name);
  message.contact_torque.resize(joints);
  message.total_torque_std.resize(joints, kNaN);
  message.total_torque_systematic_std.resize(joints, kNaN);
  message.cylinder_force.resize(boom.cylinders().size());
  message.cylinder_force_std.resize(boom.cylinders().size(), kNaN);
  message.cylinder_force_systematic_std.resize(boom.cylinders().size(), kNaN);
  message.cylinder_flags.resize(boom.cylinders().size());
  message.cylinder_pressure.resize(boom.cylinders().size());
}

void prepareSections(const Boom& boom, SectionLoads& message) {
  message.header.frame_id = boom.parameters().chain.root;
  for (const Section& section : boom.sections()) message.section_name.push_back(section.name());
  message.load.resize(boom.sections().size());
  message.load_std.resize(boom.sections().size());
  message.load_systematic_std.resize(boom.sections().size());
}

void prepareReactions(const Boom& boom, JointReactions& message) {
  const auto joints = static_cast<std::size_t>(boom.chain().joints());
  message.header.frame_id = boom.parameters().chain.root;
  message.joint_name = boom.chain().jointNames();
  message.load.resize(joints);
  message.load_std.resize(joints);
  message.load_systematic_std.resize(joints);
  for (const Cylinder& cylinder : boom.cylinders()) message.cylinder_name.push_back(cylinder.parameters().name);
  message.base_force.resize(boom.cylinders().size());
  message.guide_force.resize(boom.cylinders().size());
  message.rod_force.resize(boom.cylinders().size());
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
  constexpr double kStep = 1e-5;  // of differences [rad]
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
  copy(state.loads.hammer, message.hammer_torque);
  copy(state.loads.weight, message.weight_torque);
  copy(state.loads.motion, message.motion_torque);
  copy(state.loads.vibration, message.vibration_torque);
  copy(state.contact_torque, message.contact_torque);
  copy(state.loads.total, message.total_torque);
  copy(state.deviations.torque, message.total_torque_std);
  copy(state.common.torque, message.total_torque_systematic_std);
  for (std::size_t i = 0; i < message.cylinder_name.size(); ++i) {
    message.cylinder_force[i] = state.loads.cylinder[i].force;
    message.cylinder_force_std[i] = state.deviations.cylinder[i];
    message.cylinder_force_systematic_std[i] = state.common.cylinder[i];
    message.cylinder_pressure[i] = state.loads.cylinder[i].pressure;
    message.cylinder_flags[i] = state.cylinder_flags[i];
  }
  message.flags = 0;
  if (state.hold_down_force_lost) message.flags |= JointLoads::FLAG_HOLD_DOWN_LOST;
  if (state.hold_down && state.hold_down->least < 1.0) message.flags |= JointLoads::FLAG_HOLD_DOWN;
  if (state.measured) message.flags |= JointLoads::FLAG_MEASURED;
}

void fillSections(const BoomState& state, SectionLoads& message) {
  message.header.stamp = timeOf(state.stamp);
  for (std::size_t i = 0; i < message.load.size(); ++i) {
    copy(state.steel.section[i], message.load[i]);
    copy(state.deviations.section[i], message.load_std[i]);
    copy(state.common.section[i], message.load_systematic_std[i]);
  }
}

void fillReactions(const BoomState& state, JointReactions& message) {
  message.header.stamp = timeOf(state.stamp);
  for (std::size_t i = 0; i < message.load.size(); ++i) {
    copy(state.steel.joint[i], message.load[i]);
    copy(state.deviations.joint[i], message.load_std[i]);
    copy(state.common.joint[i], message.load_systematic_std[i]);
  }
  for (std::size_t i = 0; i < message.base_force.size(); ++i) {
    copy(state.steel.pins[i].base, message.base_force[i]);
    copy(state.steel.pins[i].guide, message.guide_force[i]);
    copy(state.steel.pins[i].rod, message.rod_force[i]);
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
