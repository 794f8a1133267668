/// Directory of a log's bags, and the bags that it contains.
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

/// Paths of the bags PREFIX_..._N.bag.active that no process writes any more: theirs was killed, or its disk failed.
/// Left out are links and empty files.
std::vector<std::string> unfinishedLogs(const std::string& directory, const std::string& prefix);

}  // namespace hammer_loads
