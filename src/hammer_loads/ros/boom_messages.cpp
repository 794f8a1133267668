#include "hammer_loads/ros/boom_messages.h"

#include <algorithm>
#include <limits>

#include "hammer_loads/ros/stamp.h"

namespace hammer_loads {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLongestLimit = 256;  // more than a cylinder's name has

void copy(const JointVector& from, std::vector<double>& to) { std::copy(from.begin(), from.end(), to.begin()); }

void copy(const Eigen::Vector3d& from, geometry_msgs::Vector3& to) {
  to.x = from.x(), to.y = from.y(), to.z = from.z();
}

}  // namespace

std::vector<std::string> framesBesideChain(const std::vector<std::string>& wrench_links, const Boom* boom) {
  std::vector<std::string> frames;
  for (const std::string& link : wrench_links) {
    if (boom == nullptr || !boom->chain().linkIndex(link)) frames.push_back(link);
  }
  return frames;
}

BoomMessages::BoomMessages(const BoomFollower& follower, const std::vector<std::string>& wrench_links)
    : follower_(follower) {
  const Boom& boom = follower.boom();
  const auto joints = static_cast<std::size_t>(boom.chain().joints());
  joint_loads_.header.frame_id = boom.parameters().chain.root;
  joint_loads_.joint_name = boom.chain().jointNames();
  for (std::vector<double>* torque :
       {&joint_loads_.hammer_torque_Nm, &joint_loads_.weight_torque_Nm, &joint_loads_.motion_torque_Nm,
        &joint_loads_.vibration_torque_Nm, &joint_loads_.total_torque_Nm})
    torque->resize(joints);
  for (const Cylinder& cylinder : boom.cylinders()) joint_loads_.cylinder_name.push_back(cylinder.parameters().name);
  joint_loads_.cylinder_force_N.resize(boom.cylinders().size());
  joint_loads_.cylinder_pressure_Pa.resize(boom.cylinders().size());
  vibration_.header.frame_id = boom.parameters().chain.tip;
  vibration_.natural_frequency_Hz.reserve(kMaxJoints);
  vibration_.hold_down_limit.reserve(kLongestLimit);
  for (const std::string& link : wrench_links) {
    const auto index = follower.linkIndex(link);
    if (!index) continue;
    links_.push_back(link);
    indices_.push_back(*index);
    wrenches_.emplace_back().header.frame_id = link;
  }
}

const JointLoads& BoomMessages::jointLoads() {
  const BoomState& state = follower_.state();
  joint_loads_.header.stamp = timeOf(state.stamp);
  copy(state.loads.hammer, joint_loads_.hammer_torque_Nm);
  copy(state.loads.weight, joint_loads_.weight_torque_Nm);
  copy(state.loads.motion, joint_loads_.motion_torque_Nm);
  copy(state.loads.vibration, joint_loads_.vibration_torque_Nm);
  copy(state.loads.total, joint_loads_.total_torque_Nm);
  for (std::size_t i = 0; i < joint_loads_.cylinder_name.size(); ++i) {
    joint_loads_.cylinder_force_N[i] = state.loads.cylinder[i].force;
    joint_loads_.cylinder_pressure_Pa[i] = state.loads.cylinder[i].pressure;
  }
  return joint_loads_;
}

const BoomVibration& BoomMessages::vibration() {
  const BoomState& state = follower_.state();
  vibration_.header.stamp = timeOf(state.stamp);
  copy(state.tip.displacement.head<3>(), vibration_.displacement_m);
  copy(state.tip.displacement.tail<3>(), vibration_.rotation_rad);
  copy(state.tip.acceleration.head<3>(), vibration_.acceleration_m_s2);
  vibration_.natural_frequency_Hz.assign(state.frequency.begin(), state.frequency.end());
  vibration_.reduced_mass_kg = state.reduced.mass;
  vibration_.reduced_stiffness_N_m = state.reduced.stiffness;
  vibration_.compliant = state.choice.compliant;
  vibration_.dead_point = state.dead_point;
  vibration_.rigid_error = state.choice.judged ? state.choice.rigid_error : kNaN;
  vibration_.rigid_tolerance = state.choice.rigid_tolerance;
  vibration_.pulse_length_s = state.choice.judged ? state.choice.pulse_length : kNaN;
  vibration_.hold_down_factor = state.hold_down ? state.hold_down->least : kNaN;
  vibration_.hold_down_limit = follower_.firstToGive();
  return vibration_;
}

const geometry_msgs::WrenchStamped& BoomMessages::wrench(std::size_t link, const ros::Time& stamp,
                                                         const HullWrench& load) {
  geometry_msgs::WrenchStamped& message = wrenches_[link];
  const Wrench w = follower_.wrenchAtLink(indices_[link], load);
  message.header.stamp = stamp;
  copy(w.force, message.wrench.force);
  copy(w.torque, message.wrench.torque);
  return message;
}

}  // namespace hammer_loads
