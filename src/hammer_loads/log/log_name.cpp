#include "hammer_loads/log/log_name.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
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

std::string baseName(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

Checked<LogName> LogName::take(const std::string& directory, const std::string& prefix, unsigned& number) {
  Checked<LogName> result;
  const std::string stem = directory + '/' + prefix + '_' + localTime() + '_';
  LogName name;
  name.directory_ = open(directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  int error = name.directory_ < 0 ? errno : EEXIST;
  for (unsigned tries = 0; error == EEXIST && tries < kMostTries; ++tries) {
    name.final_ = stem + std::to_string(number++) + ".bag";
    name.active_ = name.final_ + ".active";
    if (faccessat(name.directory_, baseName(name.final_).c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) continue;
    name.descriptor_ =
        openat(name.directory_, baseName(name.active_).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
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
      directory_(std::exchange(other.directory_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

LogName::~LogName() {
  struct stat found {};
  if (descriptor_ >= 0 && fstat(descriptor_, &found) == 0 && found.st_size == 0 &&
      isOurs(directory_, baseName(active_)))
    unlinkat(directory_, baseName(active_).c_str(), 0);
  if (descriptor_ >= 0) ::close(descriptor_);
  if (directory_ >= 0) ::close(directory_);
}

std::string LogName::openPath() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

bool LogName::isOurs(int directory, const std::string& path) const noexcept {
  struct stat own {
  }, found{};
  return fstat(descriptor_, &own) == 0 && fstatat(directory, path.c_str(), &found, AT_SYMLINK_NOFOLLOW) == 0 &&
         own.st_dev == found.st_dev && own.st_ino == found.st_ino;
}

bool LogName::isInPlace() const noexcept { return isOurs(AT_FDCWD, active_); }

std::string LogName::publish() {
  const std::string stem = final_.substr(0, final_.size() - std::strlen(".bag"));
  const std::string from = baseName(active_);
  if (!isOurs(directory_, from)) return "log file " + active_ + " was deleted, moved or replaced";
  int error = renameToNew(directory_, from, baseName(final_));
  for (unsigned i = 1; error == EEXIST && i < kMostTries; ++i) {
    final_ = stem + '-' + std::to_string(i) + ".bag";
    error = renameToNew(directory_, from, baseName(final_));
  }
  if (error != 0)
    return "log file " + active_ + " is complete, but cannot be renamed to " + final_ + ": " + std::strerror(error);
  if (!isOurs(AT_FDCWD, final_)) {  // the directory was moved: say where to
    std::error_code unknown;
    final_ = std::filesystem::read_symlink(openPath(), unknown).string();
  }
  return {};
}

}  // namespace hammer_loads
