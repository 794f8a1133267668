/// Missing or suspicious parts of a recording. Each function adds its lines to `warnings`, none twice.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_report.h"
#include "hammer_loads/ros/bag_runs.h"

namespace hammer_loads {

class HammerBridge;

/// Warnings by the pipeline's state at the end of a run: wrong units, joints without a message.
/// joints_came: there were messages on their topic. run: number of the run.
void warnOfRun(const HammerBridge& bridge, bool joints_came, std::int64_t run, std::vector<BagWarning>& warnings);

/// Warns of several publishers on one of these topics. Transforms are excepted, since they usually have several.
void warnOfPublishers(const BagInputs& inputs, const std::set<std::string>& topics, std::vector<BagWarning>& warnings);

/// Warns of messages that the log of these bags has lost.
void warnOfLostMessages(const BagInputs& inputs, std::vector<BagWarning>& warnings);

/// Warns of messages of another version of this package, whose definition differs.
void warnOfDefinitions(const BagInputs& inputs, std::vector<BagWarning>& warnings);

/// Warns of topics that the runs need and that have no message.
void warnOfMissing(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& heard,
                   std::vector<BagWarning>& warnings);

/// Warns if there is no wrench, or if there is no whole turn and most samples contradict the parameters.
bool isUseless(const BagReport& report);

/// Warnings that the crank's readings are not those of such a machine, in one line.
std::string contradictionsOf(const std::vector<BagWarning>& warnings);

/// Reason why a run gave no wrench of use, in one line.
std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report);

}  // namespace hammer_loads
