#include "hammer_loads/commands/replace_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

std::string lastError() { return std::strerror(errno); }

bool writeAll(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  return true;
}

mode_t permissions(const std::string& path) {
  struct stat present {};
  if (stat(path.c_str(), &present) == 0) return present.st_mode & 07777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

/// Syncs that a rename needs to outlast a power cut.
void syncDirectory(const fs::path& directory) {
  const int file = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);
  close(file);
}

}  // namespace

std::optional<std::string> readToReplace(const std::string& path, std::string& problem) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return std::string{};
  if (status.type() != fs::file_type::regular) {
    problem = path + ": " + (error ? error.message() : "is no regular file");
    return std::nullopt;
  }
  std::ostringstream text;
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.is_open() && !stream.bad() && errno == 0) return text.str();
  problem = path + ": cannot be read: " + lastError();
  return std::nullopt;
}

std::optional<std::string> replaceFile(const std::string& path, const std::string& text) {
  std::error_code error;
  fs::path target = fs::weakly_canonical(path, error);  // the file that a link names, not the link
  if (error) target = path;
  const std::string pattern = target.string() + ".XXXXXX";
  std::vector<char> part(pattern.c_str(), pattern.c_str() + pattern.size() + 1);
  const int file = mkstemp(part.data());
  if (file < 0) return path + ": cannot be replaced: " + lastError();
  const bool written = writeAll(file, text) && fchmod(file, permissions(target)) == 0 && fsync(file) == 0;
  std::string reason = written ? "" : lastError();
  close(file);
  if (written && std::rename(part.data(), target.c_str()) != 0) reason = lastError();
  if (reason.empty()) {
    syncDirectory(target.parent_path());
    return std::nullopt;
  }
  unlink(part.data());
  return path + ": cannot be replaced: " + reason;
}

ReplaceLock::ReplaceLock(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path directory = (error ? fs::path(path) : target).parent_path();
  directory_ = open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  int result = -1;
  if (directory_ >= 0) do
      result = flock(directory_, LOCK_EX);
    while (result != 0 && errno == EINTR);
  if (result != 0) problem_ = path + ": its directory cannot be locked: " + lastError();
}

ReplaceLock::~ReplaceLock() {
  if (directory_ >= 0) close(directory_);
}

}  // namespace hammer_loads
