/// Start, stop and split of a node's log on request; restart after a full disk.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <functional>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// `~log/start`, `~log/stop`, `~log/split` (std_srvs/Trigger). A request carries nothing: where to and under which
/// names the log is written comes from the parameters alone. The answer states what was done or why not. A log that a
/// full disk has stopped restarts by itself when there is room again.
class LogServices {
 public:
  /// finish: called before a log begins, goes on in a new file or ends: what ends a run belongs into the file that
  /// holds it. begin: called when a log begins or goes on in a new file, so that the file holds a run from its
  /// beginning. switched: called when the log has been started or stopped. The log must outlive this.
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

}  // namespace hammer_loads
