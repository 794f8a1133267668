/// Directory of a log's bags, the bags that it contains, and their names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Name of one bag, PREFIX_YYYY-MM-DD-HH-MM-SS_N.bag (local time), reserved by a new empty file
/// PREFIX_..._N.bag.active. No existing file is overwritten. The file is locked (flock) during the life of this object,
/// so that others see that it is being written.
class LogName {
 public:
  /// number: N of the first try; afterwards behind the one taken.
  static Checked<LogName> take(const std::string& directory, const std::string& prefix, unsigned& number);

  LogName(LogName&& other) noexcept;
  LogName& operator=(LogName&&) = delete;
  /// Removes the file if nothing was written to it.
  ~LogName();

  const std::string& active() const noexcept { return active_; }  ///< path while it is written
  const std::string& final() const noexcept { return final_; }    ///< path afterwards
  int descriptor() const noexcept { return descriptor_; }         ///< descriptor of the active file
  bool isDeleted() const noexcept;

  /// Renames active to final; if the final name was taken meanwhile, to another one. Empty or what went wrong.
  std::string publish();

 private:
  LogName() = default;

  std::string active_, final_;
  int descriptor_{-1};
};

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
