/// Where bags lie and what they are called.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// The log directory with ~/ resolved, once it is known to exist. Below ~/ it is made if missing; anywhere else a
/// missing directory is a problem: it may be a disk that is not mounted.
Checked<std::string> findLogDirectory(const std::string& given);

/// Bytes on the directory's disk that this user may still take; 0 if that cannot be found out.
std::uint64_t freeSpace(const std::string& directory);

/// Name of one bag, PREFIX_YYYY-MM-DD-HH-MM-SS_N.bag (local time), held by an empty file PREFIX_..._N.bag.active that
/// did not exist before. Neither that file nor one under the final name is ever overwritten.
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
  int descriptor() const noexcept { return descriptor_; }         ///< of the active file

  /// Renames active to final; if somebody took the final name meanwhile, to another one. Empty or what went wrong.
  std::string publish();

 private:
  LogName() = default;

  std::string active_, final_;
  int descriptor_{-1};
};

}  // namespace hammer_loads
