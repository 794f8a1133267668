/// Log of a node: its start, its services and its part of the diagnostics.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Makes the log of a node. Returns null, with one line per problem, if the settings can never work. If the disk cannot
/// take a bag now, this is reported and the node runs without a log. node: resolved name.
inline std::unique_ptr<BagLog> makeNodeLog(const LogSettings& settings, const std::string& node,
                                           std::vector<std::string>& problems) {
  LogSettings of_node = settings;
  of_node.node = node;
  auto log = std::make_unique<BagLog>(of_node);
  if (!settings.enabled) return log;
  problems = log->settingProblems();
  if (!problems.empty()) return nullptr;
  for (const std::string& line : log->unfinishedBags()) ROS_WARN("%s", line.c_str());
  for (const std::string& reason : log->start()) ROS_ERROR("%s; the node runs without a log", reason.c_str());
  return log;
}

/// Services `~log/start`, `~log/stop`, `~log/split` (std_srvs/Trigger). A request is empty: directory and names of the
/// log come from the parameters. The answer states the action or the reason against it. A log that a full disk has
/// stopped restarts by itself once there is room.
class LogServices {
 public:
  /// finish: called before a log begins, is split or ends, so that the last messages of a run are in its file. begin:
  /// called after a log has begun or was split, so that the file contains a run from its beginning. switched: called
  /// after the log was started or stopped. The log must outlive this object.
  LogServices(ros::NodeHandle private_node, BagLog& log, std::function<void()> finish, std::function<void()> begin,
              std::function<void()> switched);

 private:
  using Response = std_srvs::Trigger::Response;

  void start(Response& response);
  void stop(Response& response);
  void split(Response& response);
  void lookForRoom();

  BagLog& log_;
  std::function<void()> finish_, begin_, switched_;
  ros::ServiceServer start_, stop_, split_;
  ros::WallTimer timer_;
};

void describeLog(const BagLog& log, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace hammer_loads
