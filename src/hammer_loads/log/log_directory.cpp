#include "hammer_loads/log/log_directory.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <regex>

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

std::string homeDirectory() {
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') return home;
  const passwd* user = getpwuid(getuid());
  return user != nullptr ? user->pw_dir : "";
}

/// Returns true if the path lies below `home`. Links and .. are resolved as far as the path exists.
bool isBelow(const fs::path& path, const fs::path& home) {
  std::error_code error;
  if (!fs::exists(home, error)) return false;
  const fs::path inside = fs::relative(path, home, error);
  return !error && inside != "." && *inside.begin() != "..";
}

/// Returns true if a process holds the lock of this file (LogFile::create) or if the file cannot be opened.
bool isBeingWritten(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return true;  // cannot be determined: left alone
  const bool is_locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  close(descriptor);
  return is_locked;
}

}  // namespace

Checked<std::string> findLogDirectory(const std::string& given) {
  Checked<std::string> result;
  std::string path = given;
  if (given.rfind("~/", 0) == 0) {
    const std::string home = homeDirectory();
    path = home + given.substr(1);
    std::error_code error;
    if (isBelow(path, home)) fs::create_directories(path, error);  // a failure is reported below
  }
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) {
    result.problems.push_back("log_directory: '" + path + "', must exist: " + std::strerror(errno));
  } else if (!S_ISDIR(found.st_mode)) {
    result.problems.push_back("log_directory: '" + path + "', must be a directory");
  } else if (faccessat(AT_FDCWD, path.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    result.problems.push_back("log_directory: '" + path + "', must be writable: " + std::strerror(errno));
  } else {
    result.value = path;
  }
  return result;
}

std::uint64_t freeSpace(const std::string& directory) {
  std::error_code error;
  const fs::space_info space = fs::space(directory, error);
  return error ? 0 : space.available;
}

std::vector<std::string> unfinishedLogs(const std::string& directory, const std::string& prefix) {
  static const std::regex kPattern(R"(_\d{4}(-\d{2}){5}_\d+\.bag\.active)");
  std::vector<std::string> paths;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    const std::string path = entry.path().string(), name = entry.path().filename().string();
    if (name.rfind(prefix, 0) != 0 || !std::regex_match(name.substr(prefix.size()), kPattern)) continue;
    if (entry.symlink_status(error).type() != fs::file_type::regular || entry.file_size(error) == 0) continue;
    if (!isBeingWritten(path)) paths.push_back(path);
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace hammer_loads
