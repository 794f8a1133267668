/// Messages of the boom from what a sample gave. Names and room are filled once: nothing is allocated per sample.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/BoomVibration.h>
#include <hammer_loads/JointLoads.h>
#include <hammer_loads/JointReactions.h>
#include <hammer_loads/SectionLoads.h>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/pipeline/boom_follower.h"

namespace hammer_loads {

void prepareJointLoads(const Boom& boom, JointLoads& message);
void prepareSections(const Boom& boom, SectionLoads& message);
void prepareReactions(const Boom& boom, JointReactions& message);
void prepareVibration(const Boom& boom, BoomVibration& message);

/// The follower's last sample must have no fault.
void fillJointLoads(const BoomState& state, JointLoads& message);
void fillSections(const BoomState& state, SectionLoads& message);
void fillReactions(const BoomState& state, JointReactions& message);
void fillVibration(const BoomFollower& follower, BoomVibration& message);
void fillWrench(StampNs stamp, const Wrench& wrench, geometry_msgs::WrenchStamped& message);

}  // namespace hammer_loads
