#include "hammer_loads/log/log_name.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

namespace hammer_loads {
namespace {

constexpr unsigned kMostTries = 10000;

std::string homeDirectory() {
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') return home;
  const passwd* user = getpwuid(getuid());
  return user != nullptr ? user->pw_dir : "";
}

/// Every missing directory on the way, the last one included.
void makeDirectories(const std::string& path) {
  for (std::size_t end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1))
    mkdir(path.substr(0, end).c_str(), 0755);
  mkdir(path.c_str(), 0755);
}

std::string localTime() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d-%H-%M-%S", &parts);
  return text;
}

/// 0 or errno. The target is not replaced if it exists (EEXIST).
int renameToNew(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // A file system that cannot do it in one step: look first.
  if (access(to.c_str(), F_OK) == 0) return EEXIST;
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

Checked<std::string> findLogDirectory(const std::string& given) {
  Checked<std::string> result;
  std::string path = given;
  if (given.rfind("~/", 0) == 0) {
    path = homeDirectory() + given.substr(1);
    makeDirectories(path);
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

Checked<LogName> LogName::take(const std::string& directory, const std::string& prefix, unsigned& number) {
  Checked<LogName> result;
  const std::string stem = directory + '/' + prefix + '_' + localTime() + '_';
  for (unsigned tries = 0; tries < kMostTries; ++tries) {
    LogName name;
    name.final_ = stem + std::to_string(number++) + ".bag";
    name.active_ = name.final_ + ".active";
    if (access(name.final_.c_str(), F_OK) == 0) continue;
    name.descriptor_ = open(name.active_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (name.descriptor_ >= 0) {
      result.value.emplace(std::move(name));
      return result;
    }
    if (errno == EEXIST) continue;
    result.problems.push_back("log_directory: '" + directory + "', must be writable: " + std::strerror(errno));
    return result;
  }
  result.problems.push_back("log_directory: '" + directory + "', must have a free name " + stem + "N.bag");
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

}  // namespace hammer_loads
