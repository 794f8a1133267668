#include "hammer_loads/ros/node_log.h"

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

using diagnostic_msgs::DiagnosticStatus;

void describeLog(const BagLog& log, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const LogHealth health = log.health();
  switch (health.state) {
    case LogState::kOff:
      status.summary(DiagnosticStatus::OK, "off");
      break;
    case LogState::kRecording:
      status.summary(DiagnosticStatus::OK, "recording");
      break;
    case LogState::kDiskFull:
      status.summary(DiagnosticStatus::ERROR, "stopped: " + health.reason);
      break;
    case LogState::kFailed:
      status.summary(DiagnosticStatus::ERROR, "failed: " + health.reason);
      break;
  }
  if (health.messages_dropped > 0) status.mergeSummary(DiagnosticStatus::WARN, "messages were dropped");
  status.add("file", health.file);
  status.add("file size [byte]", health.file_size);
  status.add("written [byte]", health.bytes_written);
  status.add("files closed", health.files_closed);
  status.add("files deleted", health.files_deleted);
  status.add("messages written", health.messages_written);
  status.add("messages dropped", health.messages_dropped);
  for (const LogTopicCounts& topic : health.topics) {
    if (topic.dropped > 0) status.add("dropped: " + topic.topic, topic.dropped);
    if (topic.too_large > 0) status.add("too large for log_queue_mb: " + topic.topic, topic.too_large);
  }
  status.add("queue fill", health.queue_fill);
}

}  // namespace hammer_loads
