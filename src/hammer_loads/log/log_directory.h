/// Where the bags of a log lie, and which are there already.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// The log directory with ~/ resolved, once it is known to be a directory. Where ~/ stands and the path stays below
/// the home directory, links and .. resolved, it is made if missing; anywhere else a missing directory is a problem:
/// it may be a disk that is not mounted.
Checked<std::string> findLogDirectory(const std::string& given);

/// Bytes on the directory's disk that this user may still take; 0 if that cannot be found out.
std::uint64_t freeSpace(const std::string& directory);

/// One bag of an earlier recording.
struct FoundLog {
  std::string path;
  std::uint64_t size{};  ///< [byte]
  bool is_unfinished{};  ///< PREFIX_..._N.bag.active: its process was killed, or its disk failed
};

/// Bags that a log with this prefix has written, oldest first. Left out are those that some process still writes, links
/// and empty files.
std::vector<FoundLog> findLogs(const std::string& directory, const std::string& prefix);

}  // namespace hammer_loads
