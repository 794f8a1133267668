#include <algorithm>
#include <iterator>

#include "hammer_loads/ros/fill_messages.h"
#include "hammer_loads/ros/stamp.h"

namespace hammer_loads {

void prepareMechanism(const std::string& crank_joint, sensor_msgs::JointState& message) {
  message.name = {crank_joint, "hammer_rod_joint", "hammer_rocker_joint"};
  message.position.resize(message.name.size());
  message.velocity.resize(message.name.size());
}

void fillWrench(StampNs stamp, const HullWrench& wrench, geometry_msgs::WrenchStamped& message) {
  message.header.stamp = timeOf(stamp);
  message.wrench.force.x = wrench.force_x;
  message.wrench.force.z = wrench.force_z;
  message.wrench.torque.y = wrench.torque_y;
}

void fillHullLoads(const SampleResult& result, const WrenchOutput& output, HullLoads& message) {
  const HullDeviation& deviation = output.deviation;
  const HullWrench std = deviation.wrench(), systematic = deviation.common();
  message.header.stamp = timeOf(output.stamp);
  message.sample_stamp = timeOf(result.sample_stamp);
  message.force_x = output.wrench.force_x;
  message.force_z = output.wrench.force_z;
  message.torque_y = output.wrench.torque_y;
  message.drive_reaction_y = output.drive_reaction_y;
  message.force_x_std = std.force_x;
  message.force_z_std = std.force_z;
  message.torque_y_std = std.torque_y;
  message.crank_angle = crankAngle(output.crank.position.angle);
  message.crank_speed = output.crank.speed;
  message.crank_acceleration = output.crank.acceleration;
  message.crank_angle_std = deviation.angle;
  message.crank_speed_std = deviation.speed;
  message.crank_acceleration_std = deviation.acceleration;
  message.force_x_systematic_std = systematic.force_x;
  message.force_z_systematic_std = systematic.force_z;
  message.torque_y_systematic_std = systematic.torque_y;
  message.crank_angle_systematic_std = deviation.common_angle;
  message.crank_speed_systematic_std = deviation.common_speed;
  message.crank_acceleration_systematic_std = deviation.common_acceleration;
  Eigen::Map<Eigen::Vector3d>(message.correlation.data()) = deviation.correlation();
  Eigen::Map<Eigen::Vector3d>(message.systematic_correlation.data()) = deviation.commonCorrelation();
  message.interval = output.interval;
  message.level = nameOf(result.level);  // short enough to need no allocation
  message.consistency = result.consistency;
  message.flags = 0;
  if (output.interval > 0.0) message.flags |= HullLoads::FLAG_MEAN;
  if (!result.pitch_known) message.flags |= HullLoads::FLAG_PITCH_UNKNOWN;
  if (result.hull.moves) message.flags |= HullLoads::FLAG_HULL_MOTION;
  if (output.near_blow) message.flags |= HullLoads::FLAG_NEAR_BLOW;
  if (result.inconsistent) message.flags |= HullLoads::FLAG_INCONSISTENT;
}

void fillMechanism(const SampleResult& result, sensor_msgs::JointState& message) {
  const LinkState links = result.linkState();
  message.header.stamp = timeOf(result.stamp);
  const double angles[]{links.crank_angle, links.rod_angle, links.rocker_angle};
  const double speeds[]{links.crank_speed, links.rod_speed, links.rocker_speed};
  std::copy(std::begin(angles), std::end(angles), message.position.begin());
  std::copy(std::begin(speeds), std::end(speeds), message.velocity.begin());
}

void fillPinForces(const SampleResult& result, PinForces& message) {
  const PinReactions& pins = result.pins;
  message.header.stamp = timeOf(result.stamp);
  message.crank_angle = crankAngle(result.crank.position.angle);
  message.crank_speed = result.crank.speed;
  message.crank_acceleration = result.crank.acceleration;
  message.force_a_x = pins.hull_on_crank.x;
  message.force_a_z = pins.hull_on_crank.z;
  message.force_b_x = pins.crank_on_rod.x;
  message.force_b_z = pins.crank_on_rod.z;
  message.force_c_x = pins.rod_on_rocker.x;
  message.force_c_z = pins.rod_on_rocker.z;
  message.force_d_x = pins.hull_on_rocker.x;
  message.force_d_z = pins.hull_on_rocker.z;
  message.drive_torque = pins.drive_torque;
  message.transmission_angle = transmissionAngle(result.links);
  message.near_blow = pins.near_blow;
}

void fillBlow(const TurnEnd& end, Blow& message) {
  const RockerBlow& blow = end.blow;
  const BlowErrors& errors = end.blow_errors;
  message.header.stamp = timeOf(end.stamp);
  message.turn = end.turn;
  message.crank_speed_before = blow.crank_speed_before;
  message.crank_speed_after = blow.crank_speed_after;
  message.rocker_speed_before = blow.rocker_speed_before;
  message.rocker_speed_after = blow.rocker_speed_after;
  message.restitution = blow.restitution;
  message.restitution_std = blow.restitution_std;
  message.energy = blow.energy;
  message.restitution_systematic_std = errors.restitution.common();
  message.energy_std = blow.energy_std;
  message.energy_systematic_std = errors.energy.common();
  message.tool_impulse_x = blow.tool_impulse_x;
  message.tool_impulse_z = blow.tool_impulse_z;
  message.tool_impulse_z_std = errors.tool_impulse_z.deviation();
  message.tool_impulse_z_systematic_std = errors.tool_impulse_z.common();
  message.support_impulse_x = blow.support_impulse_x;
  message.support_impulse_z = blow.support_impulse_z;
  message.support_impulse_z_std = errors.support_impulse_z.deviation();
  message.support_impulse_z_systematic_std = errors.support_impulse_z.common();
  message.support_impulse_y = blow.support_impulse_y;
  message.drive_impulse_y = blow.drive_impulse_y;
  message.mean_hold_down_force = end.mean_hold_down_force;
  message.struck = static_cast<std::uint8_t>(end.struck);
  message.flags = 0;
  if (blow.impossible) message.flags |= Blow::FLAG_IMPOSSIBLE;
}

void fillPulse(const TurnEnd& end, Pulse& message) {
  const HalfSinePulse& pulse = *end.pulse;
  const PulseErrors& errors = end.pulse_errors;
  message.header.stamp = timeOf(end.stamp);
  message.turn = end.turn;
  message.period = pulse.period;
  message.amplitude = pulse.amplitude;
  message.angular_frequency = pulse.frequency;
  message.start = pulse.start;
  message.impulse = pulse.impulse;
  message.turn_impulse_x = pulse.turn_impulse_x;
  message.turn_impulse_z = pulse.turn_impulse_z;
  message.half_sine_rms_error = pulse.half_sine_rms_error;
  message.amplitude_std = errors.amplitude.deviation();
  message.amplitude_systematic_std = errors.amplitude.common();
  message.impulse_std = errors.impulse.deviation();
  message.impulse_systematic_std = errors.impulse.common();
  message.turn_impulse_x_std = errors.turn_impulse_x.deviation();
  message.turn_impulse_x_systematic_std = errors.turn_impulse_x.common();
  message.turn_impulse_z_std = errors.turn_impulse_z.deviation();
  message.turn_impulse_z_systematic_std = errors.turn_impulse_z.common();
}

void fillAlarms(const TurnEnd& end, const LimitWatch& watch, Alarms& message) {
  message.header.stamp = timeOf(end.stamp);
  message.turn = end.turn;
  message.alarm.clear();
  for (std::size_t i = 0; i < watch.limits().size(); ++i) {
    const LimitState& state = watch.states()[i];
    if (state.level == AlarmLevel::kOk) continue;
    Alarm& alarm = message.alarm.emplace_back();
    alarm.name = watch.limits()[i].name;
    alarm.level = static_cast<std::uint8_t>(state.level);
    alarm.unit = watch.limits()[i].unit;
    alarm.value = state.value;
    alarm.value_std = state.std;
    alarm.limit = state.limit;
    alarm.since = timeOf(state.since);
  }
}

}  // namespace hammer_loads
