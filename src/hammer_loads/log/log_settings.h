/// Settings of a node's log: the content of config/log.yaml.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace hammer_loads {

/// Value of log_outputs: the outputs of a node in its log. For a single output, the lowest value that logs it.
enum class LoggedOutputs { kNone, kPerTurn, kWrench, kAll };

enum class LogCompression { kNone, kLz4 };

/// Sizes are in bytes here and in MB = 1e6 bytes in the file.
struct LogSettings {
  bool enabled{};
  bool inputs{true};                           ///< the node's inputs are logged
  LoggedOutputs outputs{LoggedOutputs::kAll};  ///< run_info is logged with any value
  LogCompression compression{LogCompression::kLz4};
  std::string directory;       ///< directory as given; a leading ~/ means the home directory of the node's user
  std::string prefix;          ///< beginning of file names, without /; empty: name of the node
  std::string node;            ///< resolved name of the node that logs, not from a file, e.g. /left/hammer_loads
  std::uint64_t split_size{};  ///< size above which a bag is closed and a new one begins [byte], > 0
  std::uint64_t total_size{};  ///< size of all bags of this process; above it the oldest is deleted [byte]; 0: no limit
  std::uint64_t min_free_space{};  ///< free disk space below which logging stops [byte]
  /// Size of the queue for the disk; beyond it, messages are dropped and counted [byte], > 0.
  std::uint64_t queue_size{};
};

/// Returns the beginning of file names: the prefix, or the node's name with _ for /, which is unique to the node.
inline std::string filePrefix(const LogSettings& settings) {
  if (!settings.prefix.empty()) return settings.prefix;
  std::string name = settings.node.substr(std::min(settings.node.find_first_not_of('/'), settings.node.size()));
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace hammer_loads
