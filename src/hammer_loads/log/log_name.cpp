#include "hammer_loads/log/log_name.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
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

}  // namespace hammer_loads
