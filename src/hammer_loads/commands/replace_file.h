/// A small file that a command reads, goes on with and replaces.
#pragma once

#include <optional>
#include <string>

namespace hammer_loads {

/// Text of a regular file; an empty one for a file that does not exist. Nothing when it cannot be read or is no regular
/// file: one line in `problem` says so.
std::optional<std::string> readToReplace(const std::string& path, std::string& problem);

/// Replaces the file, or makes it, so that it holds either the old text or the whole new one at any instant, a power
/// cut included. The file's permissions stay. Nothing when it is done, else one line.
std::optional<std::string> replaceFile(const std::string& path, const std::string& text);

/// Others that replace files of the same directory wait while this lives: what one reads no other replaces. On the
/// directory itself, so that no file is left beside it; links lead to the same lock.
class ReplaceLock {
 public:
  explicit ReplaceLock(const std::string& path);
  ~ReplaceLock();
  ReplaceLock(const ReplaceLock&) = delete;
  ReplaceLock& operator=(const ReplaceLock&) = delete;
  /// One line if it could not be taken, else empty.
  const std::string& problem() const { return problem_; }

 private:
  int directory_;
  std::string problem_;
};

}  // namespace hammer_loads
