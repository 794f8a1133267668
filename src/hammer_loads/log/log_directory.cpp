#include "hammer_loads/log/log_directory.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <regex>
#include <utility>

#include "hammer_loads/util/rename_to_new.h"

namespace hammer_loads {
namespace {

constexpr unsigned kMostTries = 10000;

std::string localTime() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d-%H-%M-%S", &parts);
  return text;
}

std::string homeDirectory() {
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') return home;
  const passwd* user = getpwuid(getuid());
  return user != nullptr ? user->pw_dir : "";
}

/// With links and .. resolved as far as the path exists.
bool isBelow(const std::filesystem::path& path, const std::filesystem::path& home) {
  std::error_code error;
  const auto real_home = std::filesystem::canonical(home, error);
  if (error) return false;
  const auto real_path = std::filesystem::weakly_canonical(path, error);
  if (error) return false;
  const auto [end_of_home, rest] =
      std::mismatch(real_home.begin(), real_home.end(), real_path.begin(), real_path.end());
  return end_of_home == real_home.end() && rest != real_path.end();
}

/// Some process holds the lock of this file (LogName::take).
bool isBeingWritten(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return true;  // not ours to judge
  const bool is_locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  close(descriptor);
  return is_locked;
}

}  // namespace

Checked<LogName> LogName::take(const std::string& directory, const std::string& prefix, unsigned& number) {
  Checked<LogName> result;
  const std::string stem = directory + '/' + prefix + '_' + localTime() + '_';
  LogName name;
  int error = EEXIST;
  for (unsigned tries = 0; error == EEXIST && tries < kMostTries; ++tries) {
    name.final_ = stem + std::to_string(number++) + ".bag";
    name.active_ = name.final_ + ".active";
    if (faccessat(AT_FDCWD, name.final_.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) continue;
    name.descriptor_ = open(name.active_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (name.descriptor_ >= 0) {
      flock(name.descriptor_, LOCK_EX | LOCK_NB);  // a sign to others; without it nothing else changes
      result.value.emplace(std::move(name));
      return result;
    }
    error = errno;
  }
  result.problems.push_back(
      "log_directory: '" + directory + "', must " +
      (error == EEXIST ? "have a free name " + stem + "N.bag" : std::string("be writable: ") + std::strerror(error)));
  return result;
}

LogName::LogName(LogName&& other) noexcept
    : active_(std::move(other.active_)),
      final_(std::move(other.final_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

LogName::~LogName() {
  if (descriptor_ < 0) return;
  struct stat found {};
  if (fstat(descriptor_, &found) == 0 && found.st_size == 0) unlink(active_.c_str());
  ::close(descriptor_);
}

bool LogName::isDeleted() const noexcept {
  struct stat found {};
  return fstat(descriptor_, &found) == 0 && found.st_nlink == 0;
}

std::string LogName::publish() {
  const std::string stem = final_.substr(0, final_.size() - std::strlen(".bag"));
  int error = renameToNew(active_, final_);
  for (unsigned i = 1; error == EEXIST && i < kMostTries; ++i) {
    final_ = stem + '-' + std::to_string(i) + ".bag";
    error = renameToNew(active_, final_);
  }
  if (error == 0) return {};
  return "log file " + active_ + " is complete, but cannot be renamed to " + final_ + ": " + std::strerror(error);
}

Checked<std::string> findLogDirectory(const std::string& given) {
  Checked<std::string> result;
  std::string path = given;
  if (given.rfind("~/", 0) == 0) {
    const std::string home = homeDirectory();
    path = home + given.substr(1);
    std::error_code error;
    if (isBelow(path, home)) std::filesystem::create_directories(path, error);  // a failure shows below
  }
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) {
    result.problems.push_back("log_directory: '" + path + "', must exist: " + std::strerror(errno));
  } else if (!S_ISDIR(found.st_mode)) {
    result.problems.push_back("log_directory: '" + path + "', must be a directory");
  } else {
    result.value = path;
  }
  return result;
}

std::uint64_t freeSpace(const std::string& directory) {
  struct statvfs found {};
  if (statvfs(directory.c_str(), &found) != 0) return 0;
  return static_cast<std::uint64_t>(found.f_bavail) * found.f_frsize;
}

std::vector<std::string> unfinishedLogs(const std::string& directory, const std::string& prefix) {
  static const std::regex kPattern(R"(_\d{4}(-\d{2}){5}_\d+\.bag\.active)");
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string path = entry.path().string(), name = entry.path().filename().string();
    struct stat status {};
    if (name.rfind(prefix, 0) != 0 || !std::regex_match(name.substr(prefix.size()), kPattern)) continue;
    if (lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) continue;
    if (!isBeingWritten(path)) paths.push_back(path);
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace hammer_loads
