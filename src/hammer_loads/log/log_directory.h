/// Directory of a log's bags, and the bags that it contains.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Returns the log directory with ~/ resolved. A missing directory is created if it is given with ~/ and lies below the
/// home directory after links and .. are resolved. Elsewhere a missing directory is a problem, because its disk may not
/// be mounted.
Checked<std::string> findLogDirectory(const std::string& given);

/// Returns the free bytes on the directory's disk for this user; 0 if they cannot be determined.
std::uint64_t freeSpace(const std::string& directory);

/// Returns the paths of bags PREFIX_..._N.bag.active that no process writes any longer, after a kill or a disk fault.
/// Links and empty files are excluded.
std::vector<std::string> unfinishedLogs(const std::string& directory, const std::string& prefix);

}  // namespace hammer_loads
