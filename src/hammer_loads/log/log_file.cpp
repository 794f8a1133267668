#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "hammer_loads/log/log_writer.h"

namespace hammer_loads {
namespace {

constexpr std::uint64_t kMessageOverhead = 160;  // headers and index entry of one message, incompressible

bool isFull(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

}  // namespace

LogFile::LogFile(LogName name, std::uint32_t chunk_size, LogCompression compression)
    : name_(std::move(name)), chunk_size_(chunk_size), compression_(compression) {}

LogFile::~LogFile() {
  if (bag_) close();
}

template <typename Action>
std::optional<LogFault> LogFile::guarded(Action action) noexcept {
  const auto fault = [this](LogState state, const char* reason) {
    bag_.reset();
    return LogFault{state, "log file " + name_.active() + ": " + reason + "; rosbag reindex recovers what it holds"};
  };
  try {
    action();
    return {};
  } catch (const std::system_error& error) {
    return fault(isFull(error.code().value()) ? LogState::kDiskFull : LogState::kFailed, error.what());
  } catch (const std::exception& exception) {
    return fault(LogState::kFailed, exception.what());
  }
}

std::optional<LogFault> LogFile::open() {
  return guarded([this] { bag_.emplace(name_.active(), chunk_size_, compression_); });
}

std::uint32_t LogFile::connection(const LogTopic& topic) {
  if (connections_.size() <= topic.index) connections_.resize(topic.index + 1);
  std::optional<std::uint32_t>& connection = connections_[topic.index];
  if (!connection) {
    const LogType& type = topic.type;
    connection = bag_->addConnection({topic.name, type.datatype, type.md5sum, type.definition, topic.latched,
                                      topic.latched ? topic.caller : std::string()});
  }
  return *connection;
}

bool LogFile::hasRoomFor(const LogName& name, std::uint64_t free) noexcept {
  if (fallocate(name.descriptor(), FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(kAllocationStep)) == 0) return true;
  return errno != ENOSPC && errno != EDQUOT && free >= kAllocationStep;
}

/// Allocates disk space ahead of the data, so that close() can write the index even if others fill the disk.
std::optional<LogFault> LogFile::reserve(std::uint64_t more) noexcept {
  const std::uint64_t needed = bag_->sizeBound() + more;
  if (needed <= allocated_) return {};
  const std::uint64_t wanted = needed + kAllocationStep;
  if (fallocate(name_.descriptor(), FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(wanted)) == 0) {
    allocated_ = wanted;
  } else if (isFull(errno)) {
    return LogFault{LogState::kDiskFull, "no space for log file " + name_.active() + ": " + std::strerror(errno)};
  } else {
    allocated_ = std::numeric_limits<std::uint64_t>::max();  // not offered by this file system: do without
  }
  return {};
}

std::optional<LogFault> LogFile::write(const LogTopic& topic, const ros::Time& time, const std::uint8_t* bytes,
                                       std::uint32_t size, Clock::time_point now) {
  std::optional<LogFault> full;
  auto fault = guarded([&] {
    const std::uint32_t target = connection(topic);
    full = reserve(size + kMessageOverhead);
    if (full) return;
    bag_->write(target, std::max(time, ros::TIME_MIN), bytes, size);
    if (!chunk_due_) chunk_due_ = now + kChunkPeriod;
  });
  return full ? full : fault;
}

std::optional<LogFault> LogFile::closeChunkInTime(Clock::time_point now) {
  if (!chunk_due_ || now < *chunk_due_) return {};
  chunk_due_.reset();
  return guarded([this] { bag_->closeChunk(); });
}

std::optional<LogFault> LogFile::close() {
  auto fault = guarded([this] { bag_->close(); });
  if (fault) return fault;
  size_ = bag_->size();
  bag_.reset();
  // Space taken ahead is given back.
  if (ftruncate(name_.descriptor(), static_cast<off_t>(size_)) != 0) allocated_ = 0;
  const std::string problem = name_.publish();
  if (!problem.empty()) return LogFault{LogState::kFailed, problem};
  is_complete_ = true;
  return {};
}

}  // namespace hammer_loads
