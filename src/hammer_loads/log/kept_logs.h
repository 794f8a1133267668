/// The closed bags of a log directory, and which of them go where log_total_mb is reached.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "hammer_loads/log/log_settings.h"

namespace hammer_loads {

class KeptLogs {
 public:
  /// Bags of this prefix that are not being written. As shipped the unclosed ones only count: power cut after power cut
  /// would fill the disk. With log_prune_earlier_runs all count and may go, the oldest first.
  void findEarlierRuns(const std::string& directory, const LogSettings& settings);
  /// A bag that has just been closed. size: [byte]
  void add(const std::string& path, std::uint64_t size);
  /// Deletes the oldest until one more file has its place within log_total_mb; how many. Without log_prune_earlier_runs
  /// only files of this process go: others may still be wanted.
  std::uint64_t makeRoom(const LogSettings& settings);

 private:
  struct ClosedFile {
    std::string path;
    std::uint64_t size;
  };
  std::deque<ClosedFile> closed_;  // oldest first
  std::uint64_t closed_size_{};    // of them together [byte]
  std::uint64_t unclosed_size_{};  // of bags that earlier runs left unclosed and that must stay [byte]
};

}  // namespace hammer_loads
