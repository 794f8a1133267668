/// Where and how a node logs: what config/log.yaml sets.
#pragma once

#include <cstdint>
#include <string>

namespace hammer_loads {

/// Sizes are in bytes here and in MB = 1e6 bytes in the file.
struct LogSettings {
  bool enabled{};
  std::string directory;           ///< as given; a leading ~/ means the home directory of the node's user
  std::string prefix;              ///< file names begin with it; without /
  std::uint64_t split_size{};      ///< a bag larger than this is closed and a new one begun [byte], > 0
  std::uint64_t total_size{};      ///< of this run's bags together; beyond it the oldest is deleted [byte], 0: no limit
  std::uint64_t min_free_space{};  ///< on the disk; below it nothing more is logged [byte]
  std::uint64_t queue_size{};  ///< messages waiting for the disk; beyond it they are dropped and counted [byte], > 0
};

}  // namespace hammer_loads
