/// A file that a command writes: complete under its name, or not there at all.
#pragma once

#include <sys/types.h>

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
  /// Of an existing file: why it must stay, one line without its name; empty: it may be replaced.
  std::function<std::string(const std::string& name)> keep;
};

/// Written as NAME.part.PID beside NAME, which is removed unless publish() was called.
class OutputFile {
 public:
  /// The name must be free; with `force` it may be a regular file that `keep` gives away. Directories, devices, FIFOs,
  /// sockets and symbolic links are never replaced.
  static Checked<OutputFile> make(const OutputRequest& request);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// To open for writing: leads to this very file even if others change names in the directory meanwhile.
  std::string path() const;
  /// Gives the file its name. Why that could not be, one line; empty if it was done.
  std::string publish();
  /// Takes the name back, for what belongs to it could not be written: what was there before is there again.
  void withdraw();

 private:
  OutputFile() = default;
  std::string take();
  void setRemoval(const char* part) const noexcept;

  std::string name_;
  std::unique_ptr<const std::string>
      part_;  ///< at the same place however often this moves: the signal handler reads it
  int descriptor_{-1};
  bool replaces_{}, published_{}, exchanged_{};
  dev_t device_{};  ///< of what may be replaced
  ino_t inode_{};
};

/// For a command with output files: SIGINT, SIGTERM and SIGHUP remove the unfinished ones and end with code 130. A full
/// quota and a closed pipe become errors of the write that met them.
void endCleanlyOnSignals();

}  // namespace hammer_loads
