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

/// Warnings by the pipeline's state at the end of a run: wrong units, joints that never came.
/// joints_came: there were messages on their topic. run: its number.
void warnOfRun(const HammerBridge& bridge, bool joints_came, std::int64_t run, std::vector<BagWarning>& warnings);

/// Several nodes on one of these topics. Transforms come from several as a rule.
void warnOfPublishers(const BagInputs& inputs, const std::set<std::string>& topics, std::vector<BagWarning>& warnings);

/// Messages that the log of these bags could not keep.
void warnOfLostMessages(const BagInputs& inputs, std::vector<BagWarning>& warnings);

/// Messages of another version of this package: their definition differs.
void warnOfDefinitions(const BagInputs& inputs, std::vector<BagWarning>& warnings);

/// Topics that the runs want and that are not among those heard.
void warnOfMissing(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& heard,
                   std::vector<BagWarning>& warnings);

/// No wrench came out; or no whole turn did, and most samples contradict the parameters.
bool isUseless(const BagReport& report);

/// Warnings that the crank's readings are not those of such a machine, in one line.
std::string contradictionsOf(const std::vector<BagWarning>& warnings);

/// Reason why a run gave no wrench of use, in one line.
std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report);

}  // namespace hammer_loads
