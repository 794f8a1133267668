/// The log of a node at its start.
#pragma once

#include <ros/console.h>

#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Null where the settings can never work: one line per problem. A disk that cannot take a bag now is reported and
/// costs the log, not the node. node: resolved name.
inline std::unique_ptr<BagLog> makeNodeLog(const LogSettings& settings, const std::string& node,
                                           std::vector<std::string>& problems) {
  auto log = std::make_unique<BagLog>(forNode(settings, node));
  if (!settings.enabled) return log;
  problems = log->settingProblems();
  if (!problems.empty()) return nullptr;
  for (const std::string& bag : log->unfinishedBags()) ROS_WARN("%s", BagLog::recoveryHint(bag).c_str());
  for (const std::string& reason : log->start()) ROS_ERROR("%s; the node runs without a log", reason.c_str());
  return log;
}

}  // namespace hammer_loads
