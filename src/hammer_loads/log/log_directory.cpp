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
#include <filesystem>
#include <regex>
#include <tuple>

namespace hammer_loads {
namespace {

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

Checked<std::string> findLogDirectory(const std::string& given) {
  Checked<std::string> result;
  std::string path = given;
  if (given.rfind("~/", 0) == 0) {
    const std::string home = homeDirectory();
    path = home + given.substr(1);
    std::error_code error;
    if (isBelow(path, home)) std::filesystem::create_directories(path, error);  // what failed shows below
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

std::vector<FoundLog> findLogs(const std::string& directory, const std::string& prefix) {
  static const std::regex kPattern(R"(_(\d{4}(?:-\d{2}){5})_(\d{1,9})(?:-(\d{1,9}))?\.bag(\.active)?)");
  using Age = std::tuple<std::string, unsigned long, unsigned long>;
  std::vector<std::pair<Age, FoundLog>> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    std::smatch match;
    const std::string rest = name.rfind(prefix, 0) == 0 ? name.substr(prefix.size()) : "";
    struct stat status {};
    if (!std::regex_match(rest, match, kPattern) || lstat(entry.path().c_str(), &status) != 0) continue;
    if (!S_ISREG(status.st_mode) || status.st_size == 0 || isBeingWritten(entry.path().string())) continue;
    const auto number = [&match](std::size_t i) { return match[i].matched ? std::stoul(match[i].str()) : 0; };
    found.push_back({{match[1].str(), number(2), number(3)},
                     {entry.path().string(), static_cast<std::uint64_t>(status.st_size), match[4].matched}});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FoundLog> logs;
  for (auto& [age, log] : found) logs.push_back(std::move(log));
  return logs;
}

}  // namespace hammer_loads
