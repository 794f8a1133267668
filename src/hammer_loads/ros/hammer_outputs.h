/// All output topics of the hammer's loads.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/Alarms.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/BoomVibration.h>
#include <hammer_loads/HullLoads.h>
#include <hammer_loads/JointLoads.h>
#include <hammer_loads/JointReactions.h>
#include <hammer_loads/LoadCycles.h>
#include <hammer_loads/PinForces.h>
#include <hammer_loads/Pulse.h>
#include <hammer_loads/RunInfo.h>
#include <hammer_loads/SectionLoads.h>
#include <hammer_loads/TurnLoads.h>
#include <sensor_msgs/JointState.h>

#include <deque>

#include "hammer_loads/ros/output.h"

namespace hammer_loads {

struct HammerOutputs {
  Output<RunInfo> run_info{"run_info", LoggedOutputs::kNone, Delivery::kLatched};
  Output<geometry_msgs::WrenchStamped> hull_wrench{"hull_wrench", LoggedOutputs::kWrench};
  Output<HullLoads> hull_loads{"hull_loads", LoggedOutputs::kWrench};
  std::deque<Output<geometry_msgs::WrenchStamped>> boom_wrench;  ///< one per boom_wrench link, in their order
  Output<JointLoads> joint_loads{"joint_loads"};
  Output<SectionLoads> section_loads{"section_loads"};
  Output<JointReactions> joint_reactions{"joint_reactions"};
  Output<BoomVibration> boom_vibration{"boom_vibration"};
  Output<sensor_msgs::JointState> mechanism{"mechanism"};
  Output<PinForces> pin_forces{"pin_forces", LoggedOutputs::kAll, Delivery::kOnRequest};
  Output<Blow> blow{"blow", LoggedOutputs::kPerTurn};
  Output<Pulse> pulse{"pulse", LoggedOutputs::kPerTurn};
  Output<TurnLoads> turn_loads{"turn_loads", LoggedOutputs::kPerTurn};
  Output<Alarms> alarms{"alarms", LoggedOutputs::kPerTurn, Delivery::kLast};
  Output<LoadCycles> load_cycles{"load_cycles", LoggedOutputs::kPerTurn, Delivery::kLast};

  template <typename Visit>
  void forEach(const Visit& visit) {
    visit(run_info), visit(hull_wrench), visit(hull_loads);
    for (auto& wrench : boom_wrench) visit(wrench);
    visit(joint_loads), visit(section_loads), visit(joint_reactions), visit(boom_vibration), visit(mechanism),
        visit(pin_forces), visit(blow), visit(pulse);
    visit(turn_loads), visit(alarms), visit(load_cycles);
  }
};

}  // namespace hammer_loads
