/// Functions that fill messages of the hammer and of the boom from the result of a sample. prepare...() sets frames,
/// names and array sizes once; nothing is allocated per sample.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/Alarms.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/BoomVibration.h>
#include <hammer_loads/HullLoads.h>
#include <hammer_loads/JointLoads.h>
#include <hammer_loads/JointReactions.h>
#include <hammer_loads/PinForces.h>
#include <hammer_loads/Pulse.h>
#include <hammer_loads/SectionLoads.h>
#include <sensor_msgs/JointState.h>

#include <string>
#include <vector>

#include "hammer_loads/boom/cylinder_drawing.h"
#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/limit_watch.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// Sets the names and array sizes of the mechanism's joints; called once.
void prepareMechanism(const std::string& crank_joint, sensor_msgs::JointState& message);

void fillWrench(StampNs stamp, const HullWrench& wrench, geometry_msgs::WrenchStamped& message);
void fillHullLoads(const SampleResult& result, const WrenchOutput& output, HullLoads& message);
void fillMechanism(const SampleResult& result, sensor_msgs::JointState& message);
void fillPinForces(const SampleResult& result, PinForces& message);
void fillBlow(const TurnEnd& end, Blow& message);
/// Requires end.pulse.
void fillPulse(const TurnEnd& end, Pulse& message);
/// end: the revolution judged last.
void fillAlarms(const TurnEnd& end, const LimitWatch& watch, Alarms& message);

void prepareJointLoads(const Boom& boom, JointLoads& message);
void prepareSections(const Boom& boom, SectionLoads& message);
void prepareReactions(const Boom& boom, JointReactions& message);
/// Joints of cylinders and their linkages (CylinderDrawing), which follow the mechanism's joints in one message.
class CylinderJoints {
 public:
  /// Adds the names and array elements of these joints to the message.
  CylinderJoints(const Boom& boom, sensor_msgs::JointState& message);
  /// Fills in positions [rad] or [m] and velocities per second for the boom's current pose.
  void fill(const Boom& boom, sensor_msgs::JointState& message) const;

 private:
  std::vector<CylinderDrawing> drawings_;
};

void prepareVibration(const Boom& boom, BoomVibration& message);

/// The follower's last sample must have no fault.
void fillJointLoads(const BoomState& state, JointLoads& message);
void fillSections(const BoomState& state, SectionLoads& message);
void fillReactions(const BoomState& state, JointReactions& message);
void fillVibration(const BoomFollower& follower, BoomVibration& message);
void fillWrench(StampNs stamp, const Wrench& wrench, geometry_msgs::WrenchStamped& message);

}  // namespace hammer_loads
