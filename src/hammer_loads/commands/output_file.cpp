#include "hammer_loads/commands/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "hammer_loads/util/rename_to_new.h"

namespace hammer_loads {
namespace {

constexpr int kExitInterrupted = 130;
constexpr std::size_t kMostFiles = 8;

/// Names of unfinished files, for the signal handler.
std::array<std::atomic<const char*>, kMostFiles> unfinished{};

void removeUnfinished(int) {
  for (const auto& name : unfinished) {
    if (const char* part = name.load()) unlink(part);
  }
  constexpr char kText[] = "interrupted: nothing is written\n";
  if (write(STDERR_FILENO, kText, sizeof kText - 1) < 0) {  // the code says it as well
  }
  _exit(kExitInterrupted);
}

const char* kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

bool isSameFile(const std::string& one, const std::string& other) {
  struct stat a {
  }, b{};
  return stat(one.c_str(), &a) == 0 && stat(other.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

std::string problemOf(const OutputRequest& request, const struct stat& found) {
  if (!S_ISREG(found.st_mode)) return std::string("is ") + kindOf(found.st_mode) + ", must be a new file";
  if (!request.force) return "exists already, must be a new file; --force replaces one that this command wrote";
  const std::string reason = request.keep(request.name);
  return reason.empty() ? reason : "--force does not replace it: " + reason;
}

}  // namespace

Checked<OutputFile> OutputFile::make(const OutputRequest& request) {
  Checked<OutputFile> result;
  const auto refuse = [&](const std::string& reason) {
    result.problems.push_back((request.name.empty() ? "output" : request.name) + ": " + reason);
    return std::move(result);
  };
  if (request.name.empty()) return refuse("an empty name, must be that of a new file");
  for (const std::string& input : request.inputs) {
    if (isSameFile(input, request.name)) return refuse("is the input " + input + ", must be another file");
  }
  OutputFile file;
  file.name_ = request.name;
  struct stat found {};
  if (lstat(request.name.c_str(), &found) == 0) {
    const std::string problem = problemOf(request, found);
    if (!problem.empty()) return refuse(problem);
    file.replaces_ = true;
    file.device_ = found.st_dev;
    file.inode_ = found.st_ino;
  }
  const std::string problem = file.take();
  if (!problem.empty()) return refuse(problem);
  result.value.emplace(std::move(file));
  return result;
}

/// A file of our own: what stood there under its name, of an earlier process, is left alone.
std::string OutputFile::take() {
  constexpr int kMostTries = 100;
  const std::string stem = name_ + ".part." + std::to_string(getpid());
  for (int i = 0; i < kMostTries; ++i) {
    part_ = std::make_unique<const std::string>(i == 0 ? stem : stem + "-" + std::to_string(i));
    setRemoval(part_->c_str());
    descriptor_ = open(part_->c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ >= 0) return {};
    const int error = errno;
    setRemoval(nullptr);
    if (error != EEXIST) return std::string("cannot be written: ") + std::strerror(error);
  }
  return "cannot be written: " + stem + " and the like exist";
}

/// Null: there is nothing to remove any more.
void OutputFile::setRemoval(const char* part) const noexcept {
  for (auto& name : unfinished) {
    const char* expected = part != nullptr ? nullptr : part_->c_str();
    if (name.compare_exchange_strong(expected, part)) return;
  }
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : name_(std::move(other.name_)),
      part_(std::move(other.part_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      replaces_(other.replaces_),
      published_(other.published_),
      exchanged_(other.exchanged_),
      device_(other.device_),
      inode_(other.inode_) {}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!part_ || (published_ && !exchanged_)) return;
  unlink(part_->c_str());
  setRemoval(nullptr);
}

std::string OutputFile::path() const {
  const std::string by_descriptor = "/proc/self/fd/" + std::to_string(descriptor_);
  return access(by_descriptor.c_str(), W_OK) == 0 ? by_descriptor : *part_;
}

std::string OutputFile::publish() {
  struct stat found {};
  const bool is_there = lstat(name_.c_str(), &found) == 0;
  if (is_there && !(replaces_ && found.st_dev == device_ && found.st_ino == inode_))
    return name_ + ": has appeared meanwhile, is not replaced";
  int error = is_there
                  ? (renameat2(AT_FDCWD, part_->c_str(), AT_FDCWD, name_.c_str(), RENAME_EXCHANGE) == 0 ? 0 : errno)
                  : renameToNew(AT_FDCWD, *part_, name_);
  exchanged_ = is_there && error == 0;  // the old file is there until the end, under the other name
  if (is_there && (error == EINVAL || error == ENOSYS))
    error = std::rename(part_->c_str(), name_.c_str()) == 0 ? 0 : errno;
  if (error != 0) return name_ + ": the file cannot be given this name: " + std::strerror(error);
  setRemoval(nullptr);
  published_ = true;
  return {};
}

void OutputFile::withdraw() {
  if (!published_) return;
  published_ = false;
  struct stat here {
  }, there{};
  const bool ours = fstat(descriptor_, &here) == 0 && lstat(name_.c_str(), &there) == 0 &&
                    here.st_dev == there.st_dev && here.st_ino == there.st_ino;
  if (!ours) return;
  if (exchanged_) renameat2(AT_FDCWD, part_->c_str(), AT_FDCWD, name_.c_str(), RENAME_EXCHANGE);
  if (!exchanged_) unlink(name_.c_str());
}

void endCleanlyOnSignals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    // A signal that the caller ignores (nohup) stays ignored.
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = removeUnfinished;
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace hammer_loads
