/// Messages of the hammer and of the boom from the result of a sample. Headers' frames, names and array sizes are set
/// once by prepare...(); nothing is allocated per sample.
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

/// Once: names and room of the mechanism's joints.
void prepareMechanism(const std::string& crank_joint, sensor_msgs::JointState& message);

void fillWrench(StampNs stamp, const HullWrench& wrench, geometry_msgs::WrenchStamped& message);
void fillHullLoads(const SampleResult& result, const WrenchOutput& output, HullLoads& message);
void fillMechanism(const SampleResult& result, sensor_msgs::JointState& message);
void fillPinForces(const SampleResult& result, PinForces& message);
void fillBlow(const TurnEnd& end, Blow& message);
/// end.pulse is required.
void fillPulse(const TurnEnd& end, Pulse& message);
/// end: the turn that was just judged.
void fillAlarms(const TurnEnd& end, const LimitWatch& watch, Alarms& message);

void prepareJointLoads(const Boom& boom, JointLoads& message);
void prepareSections(const Boom& boom, SectionLoads& message);
void prepareReactions(const Boom& boom, JointReactions& message);
/// Joints of cylinders and their linkages, the last ones of a message with the mechanism's (CylinderDrawing).
class CylinderJoints {
 public:
  /// Adds their names and room to the message.
  CylinderJoints(const Boom& boom, sensor_msgs::JointState& message);
  /// Positions and velocities of the boom's present pose [rad], [m] and per second.
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
