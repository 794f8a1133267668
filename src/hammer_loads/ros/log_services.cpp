#include "hammer_loads/ros/log_services.h"

#include <ros/console.h>

#include <utility>

namespace hammer_loads {

LogServices::LogServices(ros::NodeHandle private_node, BagLog& log, std::function<void()> finish,
                         std::function<void()> begin, std::function<void()> switched)
    : log_(log), finish_(std::move(finish)), begin_(std::move(begin)), switched_(std::move(switched)) {
  const auto serve = [&](const char* name, void (LogServices::*act)(Response&)) {
    return private_node.advertiseService<std_srvs::Trigger::Request, Response>(
        name, [this, act](std_srvs::Trigger::Request&, Response& response) {
          (this->*act)(response);
          return true;
        });
  };
  start_ = serve("log/start", &LogServices::start);
  stop_ = serve("log/stop", &LogServices::stop);
  split_ = serve("log/split", &LogServices::split);
  timer_ = private_node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { lookForRoom(); });
}

void LogServices::start(Response& response) {
  if (log_.isRecording()) {
    response.message = "is recording already";
    return;
  }
  finish_();
  const std::vector<std::string> problems = log_.start();
  response.success = problems.empty();
  response.message = problems.empty() ? "recording" : problems.front();
  if (!response.success) return;
  begin_();
  switched_();
}

void LogServices::lookForRoom() {
  if (!log_.hasRoomAgain()) return;
  Response response;
  start(response);
  ROS_WARN("log: there is room on the disk again, %s", response.message.c_str());
}

void LogServices::stop(Response& response) {
  response.success = log_.isRecording();
  response.message = response.success ? "stopped" : "was not recording";
  if (response.success) finish_();
  log_.stop();
  if (response.success) switched_();
}

void LogServices::split(Response& response) {
  if (log_.isRecording()) finish_();
  response.success = log_.split();
  response.message = response.success ? "recording in a new file" : "was not recording";
  if (response.success) begin_();
}

}  // namespace hammer_loads
