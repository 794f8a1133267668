#include "hammer_loads/log/log_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <limits>
#include <system_error>

#include "hammer_loads/util/rename_to_new.h"

namespace hammer_loads {
namespace {

constexpr std::uint64_t kMessageOverhead = 160;  // headers and index entry of one message, incompressible [byte]
constexpr unsigned kMostTries = 10000;

bool isFull(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

std::string localTime() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d-%H-%M-%S", &parts);
  return text;
}

}  // namespace

std::shared_ptr<LogFile> LogFile::create(const LogSettings& settings, const std::string& directory, unsigned number) {
  const std::string stem = directory + '/' + filePrefix(settings) + '_' + localTime() + '_';
  const std::shared_ptr<LogFile> file(new LogFile(settings, directory));
  int error = EEXIST;
  for (unsigned tries = 0; error == EEXIST && tries < kMostTries; ++tries, ++number) {
    file->number_ = number;
    file->final_ = stem + std::to_string(number) + ".bag";
    file->active_ = file->final_ + ".active";
    if (faccessat(AT_FDCWD, file->final_.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) continue;
    file->descriptor_ = ::open(file->active_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file->descriptor_ >= 0) {
      flock(file->descriptor_, LOCK_EX | LOCK_NB);  // tells others that the file is in use; failure is harmless
      return file;
    }
    error = errno;
  }
  throw LogFault(LogState::kFailed, "log_directory: '" + directory + "', must " +
                                        (error == EEXIST ? "have a free name " + stem + "N.bag"
                                                         : std::string("be writable: ") + std::strerror(error)));
}

LogFile::~LogFile() {
  if (descriptor_ < 0) return;
  struct stat found {};
  if (fstat(descriptor_, &found) == 0 && found.st_size == 0) unlink(active_.c_str());
  ::close(descriptor_);
}

bool LogFile::isDeleted() const noexcept {
  struct stat found {};
  return fstat(descriptor_, &found) == 0 && found.st_nlink == 0;
}

/// Carries out an action. After an error, gives the bag up and throws LogFault.
template <typename Action>
void LogFile::guarded(const Action& action) {
  const auto give_up = [this](LogState state, const char* reason) {
    bag_.reset();
    throw LogFault(state, "log file " + active_ + ": " + reason + "; rosbag reindex recovers what it holds");
  };
  try {
    action();
  } catch (const std::system_error& error) {
    give_up(isFull(error.code().value()) ? LogState::kDiskFull : LogState::kFailed, error.what());
  } catch (const std::exception& exception) {
    give_up(LogState::kFailed, exception.what());
  }
}

void LogFile::open() {
  const std::size_t chunk_size = std::min<std::size_t>(BagWriter::kChunk, settings_.split_size / 4);
  guarded([&] { bag_.emplace(active_, chunk_size, settings_.compression); });
}

std::uint32_t LogFile::connectionOf(const LogTopic& topic) {
  if (connections_.size() <= topic.index) connections_.resize(topic.index + 1);
  std::optional<std::uint32_t>& number = connections_[topic.index];
  if (!number) number = bag_->addConnection(topic.connection);
  return *number;
}

bool LogFile::hasRoom(std::uint64_t free) const noexcept {
  if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(kAllocationStep)) == 0) return true;
  return errno != ENOSPC && errno != EDQUOT && free >= kAllocationStep;
}

/// Allocates disk space ahead of the data, so that close() can write the index even if others fill the disk.
void LogFile::reserve(std::uint64_t more) {
  const std::uint64_t needed = bag_->sizeBound() + more;
  if (needed <= allocated_) return;
  const std::uint64_t wanted = needed + kAllocationStep;
  if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(wanted)) == 0) {
    allocated_ = wanted;
  } else if (isFull(errno)) {
    throw LogFault(LogState::kDiskFull, "no space for log file " + active_ + ": " + std::strerror(errno));
  } else {
    allocated_ = std::numeric_limits<std::uint64_t>::max();  // not supported by this file system: continue without it
  }
}

void LogFile::write(const LogTopic& topic, const ros::Time& time, const std::uint8_t* bytes, std::uint32_t size,
                    Clock::time_point now) {
  const std::uint32_t connection = connectionOf(topic);
  reserve(size + kMessageOverhead);
  guarded([&] { bag_->write(connection, std::max(time, ros::TIME_MIN), bytes, size); });
  if (!chunk_due_) chunk_due_ = now + kChunkPeriod;
}

void LogFile::closeChunkInTime(Clock::time_point now) {
  if (!chunk_due_ || now < *chunk_due_) return;
  chunk_due_.reset();
  guarded([this] { bag_->closeChunk(); });
}

void LogFile::close() {
  guarded([this] { bag_->close(); });
  size_ = bag_->size();
  bag_.reset();
  // Releases the disk space allocated ahead of the data.
  if (ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) allocated_ = 0;
  const std::string stem = final_.substr(0, final_.size() - std::strlen(".bag"));
  int error = renameToNew(active_, final_);
  for (unsigned i = 1; error == EEXIST && i < kMostTries; ++i) {
    final_ = stem + '-' + std::to_string(i) + ".bag";
    error = renameToNew(active_, final_);
  }
  if (error != 0)
    throw LogFault(LogState::kFailed, "log file " + active_ + " is complete, but cannot be renamed to " + final_ +
                                          ": " + std::strerror(error));
  is_complete_ = true;
}

}  // namespace hammer_loads
