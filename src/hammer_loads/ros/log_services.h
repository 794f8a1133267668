/// Start, stop and split of a node's log on request; restart after a full disk.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <functional>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// `~log/start`, `~log/stop`, `~log/split` (std_srvs/Trigger). A request is empty: directory and names of the log come
/// from the parameters. The answer states the action or the reason against it. A log that a full disk has stopped
/// restarts by itself once there is room.
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

}  // namespace hammer_loads
