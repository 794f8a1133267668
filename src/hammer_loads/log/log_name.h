/// Names of bags.
#pragma once

#include <string>

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

}  // namespace hammer_loads
