#include "hammer_loads/ros/loads_flow.h"

#include <algorithm>

#include "hammer_loads/linkage/pin_forces.h"
#include "hammer_loads/ros/stamp.h"

namespace hammer_loads {
namespace {

constexpr char kHullFrame[] = "hammer_hull";

/// Angle in [0, 2 pi) [rad].
double crankAngle(CrankAngle angle) { return angle.offset < 0.0 ? angle.offset + kTwoPi : angle.offset; }

}  // namespace

LoadsFlow::LoadsFlow(const Settings& settings, LoadsSink& sink) : settings_(settings), sink_(sink) {
  run_info_.version = HAMMER_LOADS_VERSION;
  run_info_.revision = HAMMER_LOADS_REVISION;
  for (std_msgs::Header* header :
       {&wrench_.header, &hull_loads_.header, &mechanism_.header, &pin_forces_.header, &blow_.header, &pulse_.header})
    header->frame_id = kHullFrame;
  mechanism_.name = {settings.pipeline.crank_joint, "hammer_rod_joint", "hammer_rocker_joint"};
  mechanism_.position.resize(mechanism_.name.size());
  mechanism_.velocity.resize(mechanism_.name.size());
  const std::vector<std::string> frames =
      framesBesideChain(settings.pipeline.boom_wrench_links, settings.boom ? &*settings.boom : nullptr);
  if (!frames.empty()) {
    frame_wrenches_.emplace(
        frames, kHullFrame, settings.pipeline.tf_max_wait,
        [this](std::size_t frame, const geometry_msgs::WrenchStamped& wrench, const ros::Time& time) {
          sink_.boomWrench(frame_wrenches_->frames()[frame], wrench, time);
        });
  }
  reset();
}

void LoadsFlow::begin(const Settings& settings) {
  settings_ = settings;
  const IntakeCounts counts = pipeline_ ? pipeline_->counts() : IntakeCounts{};
  pipeline_.emplace(settings_.mechanism, settings_.pipeline, settings_.boom, counts);
  boom_messages_.reset();
  if (pipeline_->boom()) boom_messages_.emplace(*pipeline_->boom(), settings_.pipeline.boom_wrench_links);
  if (frame_wrenches_) frame_wrenches_->reset();
  run_info_.parameters_yaml = settings_.yaml;
  run_info_.robot_description = settings_.robot_description;
  run_info_.notes = settings_.notes;
  for (const auto& [name, level] : kLevelNames)
    if (level == settings_.pipeline.level) hull_loads_.level = name;
  run_begun_ = false;
}

void LoadsFlow::hullImu(const sensor_msgs::Imu& message, const ros::Time& record_time) {
  beginRun(record_time);
  const geometry_msgs::Vector3 &a = message.linear_acceleration, &w = message.angular_velocity;
  pipeline_->hullImu(stampOf(message.header.stamp), {{a.x, a.y, a.z}, {w.x, w.y, w.z}});
}

void LoadsFlow::transforms(const tf2_msgs::TFMessage& message, bool is_static, const ros::Time& record_time) {
  if (!frame_wrenches_) return;
  if (!is_static) beginRun(record_time);
  frame_wrenches_->transforms(message, is_static, record_time);
}

/// Stamped with the first input: a second run over the same input says the same.
void LoadsFlow::beginRun(const ros::Time& record_time) {
  if (run_begun_) return;
  run_begun_ = true;
  run_info_.header.stamp = record_time;
  sink_.runInfo(run_info_, record_time);
}

void LoadsFlow::jointStates(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  beginRun(record_time);
  pipeline_->boomJoints(stampOf(message.header.stamp), message.name, message.position, message.velocity);
}

void LoadsFlow::crank(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  beginRun(record_time);
  pipeline_->wantTurns(sink_.wantsTurns());
  pipeline_->wantBoom(wantsBoom());
  const Loads& loads =
      pipeline_->crankJoint(stampOf(message.header.stamp), message.name, message.position, message.velocity);
  for (std::size_t i = 0; i < loads.turn_ends; ++i) publishTurnEnd(loads.ends[i], record_time);
  HullOutput output;
  while (pipeline_->nextOutput(output)) publishOutput(output, record_time);
  if (loads.refusal) return;
  if (loads.boom != nullptr && !loads.boom->fault) publishBoom(record_time);
  if (sink_.wantsMechanism()) publishMechanism(loads, record_time);
  if (sink_.wantsPinForces()) publishPinForces(loads, record_time);
}

void LoadsFlow::publishOutput(const HullOutput& output, const ros::Time& record_time) {
  wrench_.header.stamp = timeOf(output.stamp);
  wrench_.wrench.force.x = output.wrench.force_x;
  wrench_.wrench.force.z = output.wrench.force_z;
  wrench_.wrench.torque.y = output.wrench.torque_y;
  sink_.hullWrench(wrench_, record_time);
  if (sink_.wantsHullLoads()) publishHullLoads(output, record_time);
  if (frame_wrenches_ && wantsAny(frame_wrenches_->frames())) frame_wrenches_->wrench(wrench_, record_time);
  if (!boom_messages_ || !pipeline_->boom()->known()) return;
  for (std::size_t i = 0; i < boom_messages_->links().size(); ++i) {
    const std::string& link = boom_messages_->links()[i];
    if (sink_.wantsBoomWrench(link))
      sink_.boomWrench(link, boom_messages_->wrench(i, wrench_.header.stamp, output.wrench), record_time);
  }
}

bool LoadsFlow::wantsAny(const std::vector<std::string>& links) const {
  return std::any_of(links.begin(), links.end(), [this](const std::string& l) { return sink_.wantsBoomWrench(l); });
}

bool LoadsFlow::wantsBoom() const {
  return boom_messages_ && (sink_.wantsJointLoads() || sink_.wantsBoomVibration() || wantsAny(boom_messages_->links()));
}

void LoadsFlow::publishBoom(const ros::Time& record_time) {
  if (sink_.wantsJointLoads()) sink_.jointLoads(boom_messages_->jointLoads(), record_time);
  if (sink_.wantsBoomVibration()) sink_.boomVibration(boom_messages_->vibration(), record_time);
}

void LoadsFlow::publishHullLoads(const HullOutput& output, const ros::Time& record_time) {
  const HullDeviation deviation = pipeline_->deviation(output);
  const CrankAngle angle = output.crank.position.angle;
  hull_loads_.header.stamp = wrench_.header.stamp;
  hull_loads_.force_x_N = output.wrench.force_x;
  hull_loads_.force_z_N = output.wrench.force_z;
  hull_loads_.torque_y_Nm = output.wrench.torque_y;
  hull_loads_.force_x_deviation_N = deviation.wrench.force_x;
  hull_loads_.force_z_deviation_N = deviation.wrench.force_z;
  hull_loads_.torque_y_deviation_Nm = deviation.wrench.torque_y;
  hull_loads_.crank_angle_rad = crankAngle(angle);
  hull_loads_.crank_speed_rad_s = output.crank.speed;
  hull_loads_.crank_acceleration_rad_s2 = output.crank.acceleration;
  hull_loads_.crank_angle_deviation_rad = deviation.angle;
  hull_loads_.crank_speed_deviation_rad_s = deviation.speed;
  hull_loads_.crank_acceleration_deviation_rad_s2 = deviation.acceleration;
  hull_loads_.interval_s = output.interval;
  hull_loads_.flags = 0;
  if (output.interval > 0.0) hull_loads_.flags |= HullLoads::FLAG_MEAN;
  if (!pipeline_->hullPitch().known()) hull_loads_.flags |= HullLoads::FLAG_PITCH_UNKNOWN;
  const bool moves = pipeline_->settings().hull_motion != HullMotionSource::kFixed;
  if (moves && pipeline_->hullMotionKnown()) hull_loads_.flags |= HullLoads::FLAG_HULL_MOTION;
  const LinkMotion links = linkMotion(pipeline_->mechanism().linkage(), angle);
  if (transmissionAngle(links) < pipeline_->settings().near_blow) hull_loads_.flags |= HullLoads::FLAG_NEAR_BLOW;
  sink_.hullLoads(hull_loads_, record_time);
}

void LoadsFlow::publishMechanism(const Loads& loads, const ros::Time& record_time) {
  const LinkMotion links = linkMotion(pipeline_->mechanism().linkage(), loads.crank.position.angle);
  mechanism_.header.stamp = timeOf(loads.stamp);
  mechanism_.position = {crankAngle(loads.crank.position.angle), rodAngle(links), rockerAngle(links.rocker)};
  mechanism_.velocity = {loads.crank.speed, links.v * loads.crank.speed, links.rocker.u * loads.crank.speed};
  sink_.mechanism(mechanism_, record_time);
}

void LoadsFlow::publishPinForces(const Loads& loads, const ros::Time& record_time) {
  const Mechanism& mechanism = pipeline_->mechanism();
  const PipelineSettings& settings = pipeline_->settings();
  const CrankMotion crank{loads.crank.position.angle, loads.crank.speed, loads.crank.acceleration};
  const PinReactions pins =
      pinForces(mechanism, settings.level, crank, pipeline_->hullMotion(), NearBlow(settings.near_blow));
  pin_forces_.header.stamp = timeOf(loads.stamp);
  pin_forces_.crank_angle_rad = crankAngle(crank.angle);
  pin_forces_.crank_speed_rad_s = crank.speed;
  pin_forces_.crank_acceleration_rad_s2 = crank.acceleration;
  pin_forces_.force_a_x_N = pins.hull_on_crank.x;
  pin_forces_.force_a_z_N = pins.hull_on_crank.z;
  pin_forces_.force_b_x_N = pins.crank_on_rod.x;
  pin_forces_.force_b_z_N = pins.crank_on_rod.z;
  pin_forces_.force_c_x_N = pins.rod_on_rocker.x;
  pin_forces_.force_c_z_N = pins.rod_on_rocker.z;
  pin_forces_.force_d_x_N = pins.hull_on_rocker.x;
  pin_forces_.force_d_z_N = pins.hull_on_rocker.z;
  pin_forces_.drive_torque_Nm = pins.drive_torque;
  pin_forces_.transmission_angle_rad = transmissionAngle(linkMotion(mechanism.linkage(), crank.angle));
  pin_forces_.near_blow = pins.near_blow;
  sink_.pinForces(pin_forces_, record_time);
}

void LoadsFlow::publishTurnEnd(const TurnEnd& end, const ros::Time& record_time) {
  blow_.header.stamp = timeOf(end.stamp);
  blow_.turn = end.turn;
  blow_.rocker_speed_before_rad_s = end.blow.rocker_speed_before;
  blow_.rocker_speed_after_rad_s = end.blow.rocker_speed_after;
  blow_.restitution = end.blow.restitution;
  blow_.energy_J = end.blow.energy;
  blow_.tool_impulse_x_Ns = end.blow.tool_impulse_x;
  blow_.tool_impulse_z_Ns = end.blow.tool_impulse_z;
  blow_.support_impulse_x_Ns = end.blow.support_impulse_x;
  blow_.support_impulse_z_Ns = end.blow.support_impulse_z;
  blow_.mean_press_force_N = end.mean_press_force;
  sink_.blow(blow_, record_time);
  if (!end.pulse) return;
  pulse_.header.stamp = blow_.header.stamp;
  pulse_.turn = end.turn;
  pulse_.period_s = end.pulse->period;
  pulse_.amplitude_N = end.pulse->amplitude;
  pulse_.frequency_rad_s = end.pulse->frequency;
  pulse_.start_s = end.pulse->start;
  pulse_.impulse_Ns = end.pulse->impulse;
  pulse_.turn_impulse_x_Ns = end.pulse->turn_impulse_x;
  pulse_.turn_impulse_z_Ns = end.pulse->turn_impulse_z;
  pulse_.half_sine_rms_error = end.pulse->half_sine_rms_error;
  sink_.pulse(pulse_, record_time);
}

}  // namespace hammer_loads
