#include "hammer_loads/commands/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "hammer_loads/util/rename_to_new.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

constexpr int kExitInterrupted = 130;

/// Names of unfinished files, for the signal handler; a command has at most two.
std::array<std::atomic<const char*>, 4> unfinished{};

void replaceUnfinished(const char* before, const char* after) {
  for (auto& name : unfinished) {
    const char* expected = before;
    if (name.compare_exchange_strong(expected, after)) return;
  }
}

void removeUnfinished(int) {
  for (const auto& name : unfinished) {
    if (const char* part = name.load()) unlink(part);
  }
  constexpr char kText[] = "interrupted: nothing is written\n";
  if (write(STDERR_FILENO, kText, sizeof kText - 1) < 0) {  // the code says it as well
  }
  _exit(kExitInterrupted);
}

const char* kindOf(fs::file_type type) {
  if (type == fs::file_type::directory) return "a directory";
  if (type == fs::file_type::symlink) return "a symbolic link";
  if (type == fs::file_type::fifo) return "a FIFO";
  return type == fs::file_type::socket ? "a socket" : "a device";
}

/// Reason why the name cannot be that of the output; empty: it can.
std::string problemOf(const OutputRequest& request, fs::file_type type) {
  std::error_code error;
  if (request.name.empty()) return "an empty name, must be that of a new file";
  for (const std::string& input : request.inputs)
    if (fs::equivalent(input, request.name, error)) return "is the input " + input + ", must be another file";
  if (type == fs::file_type::not_found || type == fs::file_type::none) return {};
  if (type != fs::file_type::regular) return std::string("is ") + kindOf(type) + ", must be a new file";
  if (!request.force) return "exists already, must be a new file; --force replaces one that this command wrote";
  const std::string reason = request.keep(request.name);
  return reason.empty() ? reason : "--force does not replace it: " + reason;
}

}  // namespace

std::function<std::string(const std::string&)> keepUnlessItBegins(std::vector<std::string> beginnings,
                                                                  std::string reason) {
  return [=](const std::string& name) -> std::string {
    std::string line;
    std::getline(std::ifstream(name), line);
    for (const std::string& beginning : beginnings)
      if (line.rfind(beginning, 0) == 0) return {};
    return reason;
  };
}

OutputFile::OutputFile(std::string name, bool replaces)
    : name_(std::move(name)),
      replaces_(replaces),
      part_(std::make_unique<const std::string>(name_ + ".part." + std::to_string(getpid()))) {
  replaceUnfinished(nullptr, part_->c_str());
}

OutputFile::~OutputFile() {
  if (part_) unlink(part_->c_str());
  release();
}

void OutputFile::release() {
  if (part_) replaceUnfinished(part_->c_str(), nullptr);
  part_.reset();
}

Checked<OutputFile> OutputFile::make(const OutputRequest& request) {
  const auto refusal = [&](const std::string& why) {
    return Checked<OutputFile>{{}, {(request.name.empty() ? "output" : request.name) + ": " + why}, {}};
  };
  std::error_code error;
  const fs::file_type type = fs::symlink_status(request.name, error).type();
  if (const std::string problem = problemOf(request, type); !problem.empty()) return refusal(problem);
  OutputFile file(request.name, type == fs::file_type::regular);
  const int descriptor = open(file.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const int why = errno;
    const std::string place = why == EEXIST ? file.path() + ": " : "";
    file.release();  // the file there belongs to another program
    return refusal("cannot be written: " + place + std::strerror(why));
  }
  close(descriptor);
  return {std::move(file), {}, {}};
}

std::string OutputFile::fill(const std::string& text) const {
  std::ofstream stream(path(), std::ios::binary);
  return (stream << text) && stream.flush() ? "" : name_ + ": cannot be written";
}

std::string OutputFile::sync() const {
  const int file = open(part_->c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && fsync(file) == 0;
  const int error = errno;
  if (file >= 0) close(file);
  return synced ? "" : name_ + ": cannot be written: " + std::strerror(error);
}

std::string OutputFile::publish() {
  if (std::string problem = sync(); !problem.empty()) return problem;
  int error = 0;
  if (!replaces_)
    error = renameToNew(*part_, name_);
  else if (std::rename(part_->c_str(), name_.c_str()) != 0)
    error = errno;
  if (error == EEXIST) return name_ + ": has appeared meanwhile, is not replaced";
  if (error != 0) return name_ + ": the file cannot be given this name: " + std::strerror(error);
  release();
  return {};
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
