#include "hammer_loads/life/ledger_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <utility>

namespace hammer_loads::life {
namespace {

namespace fs = std::filesystem;

constexpr char kBusy[] = "another run is writing it; waiting for that to end";

/// Files locked by this process. To open and close one of them again would release the locks of SQLite on it.
std::mutex held_mutex;
std::set<std::pair<dev_t, ino_t>> held;

/// First name in order of the file in its directory; empty where it has further names elsewhere.
std::string onlyName(const std::string& path, const struct stat& status) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return {};
  if (status.st_nlink < 2) return target.string();
  std::string first;
  nlink_t names = 0;
  for (fs::directory_iterator it(target.parent_path(), error), end; !error && it != end; it.increment(error)) {
    struct stat found {};
    const std::string name = it->path().string();
    if (lstat(name.c_str(), &found) != 0 || found.st_dev != status.st_dev || found.st_ino != status.st_ino) continue;
    ++names;
    if (first.empty() || name < first) first = name;
  }
  return names == status.st_nlink ? first : std::string{};
}

/// On a byte that SQLite never touches. Bound to the open file, not to the process as SQLite's own locks are.
bool lockFile(int file) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = off_t{1} << 60;
  lock.l_len = 1;
  return fcntl(file, F_OFD_SETLK, &lock) == 0;
}

}  // namespace

LedgerLock::LedgerLock(int file, std::string name, bool made, dev_t device, ino_t inode)
    : file_(file), name_(std::move(name)), made_(made), device_(device), inode_(inode) {
  held.insert({device, inode});
}

LedgerLock::~LedgerLock() {
  const std::lock_guard<std::mutex> guard(held_mutex);
  struct stat status {};
  if (made_ && fstat(file_, &status) == 0 && status.st_size == 0 && isAt(name_)) unlink(name_.c_str());
  close(file_);
  held.erase({device_, inode_});
}

bool LedgerLock::isAt(const std::string& path) const {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && status.st_dev == device_ && status.st_ino == inode_;
}

std::unique_ptr<LedgerLock> LedgerLock::take(const std::string& path, std::string& problem, bool& busy) {
  const std::lock_guard<std::mutex> guard(held_mutex);
  const auto refuse = [&](const std::string& why) {
    problem = why;
    return nullptr;
  };
  busy = false;
  struct stat status {};
  const bool there = stat(path.c_str(), &status) == 0;
  if (there && !S_ISREG(status.st_mode)) return refuse("is no regular file");
  if (there && held.count({status.st_dev, status.st_ino}) > 0) {
    busy = true;
    return refuse(kBusy);
  }
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (file < 0) return refuse(std::string("cannot be opened: ") + std::strerror(errno));
  const bool locked = lockFile(file);
  const int error = errno;
  std::string name;
  struct stat now {};
  // Not where it leads any more: another run has removed or replaced it between opening and locking.
  const bool same = fstat(file, &status) == 0 && stat(path.c_str(), &now) == 0 && now.st_dev == status.st_dev &&
                    now.st_ino == status.st_ino;
  busy = !locked ? error == EAGAIN || error == EACCES : !same;
  if (!locked || !same) {
    problem = busy ? kBusy : std::string("cannot be locked: ") + std::strerror(error);
  } else if (name = onlyName(path, status); name.empty()) {
    problem = "has other names (hard links) in other directories: what a broken commit leaves would not be found";
  }
  if (problem.empty())
    return std::unique_ptr<LedgerLock>(new LedgerLock(file, name, !there, status.st_dev, status.st_ino));
  close(file);
  return nullptr;
}

}  // namespace hammer_loads::life
