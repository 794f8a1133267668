/// Messages of the hammer's own loads from the result of a sample. Headers' frames and names are set by prepare...().
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/Alarms.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/HullLoads.h>
#include <hammer_loads/PinForces.h>
#include <hammer_loads/Pulse.h>
#include <sensor_msgs/JointState.h>

#include <string>

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

}  // namespace hammer_loads
