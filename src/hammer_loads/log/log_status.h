/// State and counters of the log and of its topics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hammer_loads {

/// State of a log: whether messages reach a file.
enum class LogState {
  kOff,        ///< not started, or stopped on request
  kRecording,  ///< messages are written
  kDiskFull,   ///< stopped by itself, or not started, for lack of space
  kFailed,     ///< stopped by itself: the disk or rosbag reported an error
};

/// State of the files on the disk, updated once a second and at every change of state or file.
struct LogStatus {
  LogState state{LogState::kOff};
  std::string reason;             ///< cause if the log stopped by itself or could not start; empty otherwise
  std::string file;               ///< current or last bag
  std::uint64_t file_size{};      ///< size of the file, without the open chunk [byte]
  std::uint64_t bytes_written{};  ///< size of all bags of this process, including deleted ones [byte]
  std::uint64_t files_closed{};   ///< complete bags under their final names
  std::uint64_t files_deleted{};  ///< oldest bags of this process, deleted for log_total_mb
};

/// Messages of one topic; every message offered while the log is recording is counted once.
struct LogTopicCounts {
  std::string topic;
  std::uint64_t written{};    ///< in a bag
  std::uint64_t dropped{};    ///< not in a bag: queue full, or still queued when the log stopped by itself
  std::uint64_t too_large{};  ///< dropped messages that can never fit into the queue: log_queue_mb is too small
};

/// State of the log with its counters.
struct LogHealth : LogStatus {
  double queue_fill{};                 ///< share of the queue in use [0..1]
  std::vector<LogTopicCounts> topics;  ///< in order of first appearance
  std::uint64_t messages_written{};    ///< sum over topics
  std::uint64_t messages_dropped{};    ///< sum over topics
};

}  // namespace hammer_loads
