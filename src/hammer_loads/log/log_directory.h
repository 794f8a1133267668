/// Directory of a log's bags, and the bags that it contains.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// The log directory with ~/ resolved. A missing directory is created if it is given with ~/ and lies below the home
/// directory with links and .. resolved. Elsewhere a missing directory is a problem, as it may be a disk that is not
/// mounted.
Checked<std::string> findLogDirectory(const std::string& given);

/// Free bytes on the directory's disk for this user; 0 if they cannot be determined.
std::uint64_t freeSpace(const std::string& directory);

/// Paths of the bags PREFIX_..._N.bag.active that no process writes any more, as it was killed or its disk failed.
/// Links and empty files are excluded.
std::vector<std::string> unfinishedLogs(const std::string& directory, const std::string& prefix);

}  // namespace hammer_loads
