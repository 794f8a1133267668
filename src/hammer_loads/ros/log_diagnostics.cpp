#include "hammer_loads/ros/log_diagnostics.h"

namespace hammer_loads {

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
