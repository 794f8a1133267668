/// Output file of a command: it appears under its name only once it is complete.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

struct OutputRequest {
  std::string name;
  std::vector<std::string> inputs;  ///< files that are never replaced, by whatever name or link
  bool force{};                     ///< an existing regular file may be replaced, if `keep` allows it
  /// Reason why an existing file must stay, one line without its name; empty: it may be replaced.
  std::function<std::string(const std::string& name)> keep;
};

/// Rule for OutputRequest::keep: the file must stay, for this reason, unless its first line begins with one of these.
std::function<std::string(const std::string&)> keepUnlessItBegins(std::vector<std::string> beginnings,
                                                                  std::string reason);

/// Written as NAME.part.PID beside NAME, which is removed unless publish() succeeds.
class OutputFile {
 public:
  /// The name must be free; with `force` it may be a regular file that `keep` does not protect. Directories, devices,
  /// FIFOs, sockets and symbolic links are never replaced.
  static Checked<OutputFile> make(const OutputRequest& request);
  OutputFile(OutputFile&&) noexcept = default;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  const std::string& name() const { return name_; }
  /// To open for writing.
  const std::string& path() const { return *part_; }
  /// Writes all of its content. Returns the reason of a failure, one line; else empty.
  std::string fill(const std::string& text) const;
  /// Writes the file to the disk. Returns the reason of a failure, one line; else empty.
  std::string sync() const;
  /// Completes the file and gives it its name.
  std::string publish();

 private:
  OutputFile(std::string name, bool replaces);
  void release();

  std::string name_;
  bool replaces_;
  std::unique_ptr<const std::string> part_;  ///< null: moved away or released; the signal handler reads the text
};

/// For a command with output files: SIGINT, SIGTERM and SIGHUP remove the unfinished ones and end with code 130. A full
/// quota and a closed pipe become errors of the write that met them.
void endCleanlyOnSignals();

}  // namespace hammer_loads
