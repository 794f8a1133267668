#include "hammer_loads/log/log_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <utility>

namespace hammer_loads {
namespace {

constexpr std::uint64_t kMostHeld = 4'000'000;
constexpr std::uint64_t kSlack = 64'000;             // file header, buffers of stdio
constexpr std::uint64_t kMessageOverhead = 160;      // headers and index entry of one message, incompressible
constexpr std::uint64_t kConnectionOverhead = 1024;  // of a connection record beside its texts
constexpr std::uint64_t kChunkOverhead = 256;        // of a chunk and its entry in the index, beside its connections

bool isFull(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

/// Makes every other descriptor of this file write into nothing.
void silenceOthers(int descriptor) noexcept {
  struct stat own {};
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  DIR* directory = opendir("/proc/self/fd");
  while (null >= 0 && directory != nullptr && fstat(descriptor, &own) == 0) {
    const dirent* entry = readdir(directory);
    if (entry == nullptr) break;
    const int other = std::atoi(entry->d_name);  // 0 for . and .., then no regular file of ours
    struct stat found {};
    if (other != descriptor && fstat(other, &found) == 0 && found.st_dev == own.st_dev && found.st_ino == own.st_ino)
      dup2(null, other);
  }
  if (directory != nullptr) closedir(directory);
  if (null >= 0) ::close(null);
}

/// Bags that are never destroyed.
class KeptBags {
 public:
  static void add(std::unique_ptr<rosbag::Bag> bag) { list().push_back(bag.release()); }
  static bool isEmpty() { return list().empty(); }

 private:
  static std::vector<rosbag::Bag*>& list() {
    static auto* bags = new std::vector<rosbag::Bag*>;
    return *bags;
  }
};

/// Every bag loads a plugin when it is made and unloads it when it is destroyed; two threads at it at once crash.
std::mutex& pluginMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

std::string LogFile::prepare() {
  const std::lock_guard<std::mutex> lock(pluginMutex());
  try {
    if (KeptBags::isEmpty()) KeptBags::add(std::make_unique<rosbag::Bag>());
  } catch (const std::exception& exception) {
    return std::string("log: rosbag cannot be used: ") + exception.what();
  }
  return {};
}

LogFile::LogFile(LogName name, std::uint32_t chunk_size, LogCompression compression)
    : name_(std::move(name)), chunk_size_(chunk_size), compression_(compression) {}

LogFile::~LogFile() {
  if (is_open_) close();
}

template <typename Action>
std::optional<LogFault> LogFile::guarded(Action action) noexcept {
  errno = 0;
  try {
    action();
    return {};
  } catch (const std::exception& exception) {
    const int error = errno;
    abandon();
    LogFault fault{isFull(error) ? LogState::kDiskFull : LogState::kFailed,
                   "log file " + name_.active() + ": " + exception.what()};
    if (error != 0) fault.reason += std::string(": ") + std::strerror(error);
    fault.reason += "; what it holds can be had with rosbag reindex";
    return fault;
  }
}

/// rosbag's destructor closes the file, throws if that fails, and so ends the process; a second close after a failed
/// one frees the stream twice. Therefore a bag with a fault is kept for ever (a few MB), and its stream, which the end
/// of the process would flush, leads into nothing.
void LogFile::abandon() noexcept {
  is_open_ = false;
  silenceOthers(name_.descriptor());
  const std::lock_guard<std::mutex> lock(pluginMutex());
  if (bag_) KeptBags::add(std::move(bag_));
}

std::optional<LogFault> LogFile::open() {
  return guarded([this] {
    {
      const std::lock_guard<std::mutex> lock(pluginMutex());
      bag_ = std::make_unique<rosbag::Bag>();
    }
    bag_->open(name_.active(), rosbag::bagmode::Write);
    bag_->setCompression(compression_ == LogCompression::kLz4 ? rosbag::compression::LZ4
                                                              : rosbag::compression::Uncompressed);
    bag_->setChunkThreshold(chunk_size_);
    is_open_ = true;
  });
}

LogFile::Connection& LogFile::connection(const LogTopic& topic) {
  if (connections_.size() <= topic.index) connections_.resize(topic.index + 1);
  auto& connection = connections_[topic.index];
  if (!connection) {
    connection = std::make_unique<Connection>();
    const LogType& type = topic.type;
    connection->message.morph(type.md5sum, type.datatype, type.definition, topic.latched ? "1" : "0");
    if (topic.latched) {
      connection->header = boost::make_shared<ros::M_string>(ros::M_string{{"topic", topic.name},
                                                                           {"type", type.datatype},
                                                                           {"md5sum", type.md5sum},
                                                                           {"message_definition", type.definition},
                                                                           {"callerid", topic.caller},
                                                                           {"latching", "1"}});
    }
    const std::uint64_t texts = std::strlen(type.definition) + 2 * topic.name.size() + topic.caller.size();
    size_bound_ += texts + kConnectionOverhead;
    index_bound_ += texts + kConnectionOverhead;
  }
  return *connection;
}

bool LogFile::hasRoomFor(const LogName& name, std::uint64_t free) noexcept {
  if (fallocate(name.descriptor(), FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(kAllocationStep)) == 0) return true;
  return errno != ENOSPC && errno != EDQUOT && free >= kAllocationStep;
}

/// Takes disk space ahead of the data: close() can always write its index, even if others fill the disk meanwhile.
std::optional<LogFault> LogFile::reserve(std::uint64_t more) noexcept {
  size_bound_ += more;
  raw_ += more;
  const std::uint64_t needed = size_bound_ + index_bound_ + kSlack;
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

std::optional<LogFault> LogFile::write(const LogTopic& topic, const ros::Time& time, std::uint8_t* bytes,
                                       std::uint32_t size, Clock::time_point now) {
  std::optional<LogFault> full;
  auto fault = guarded([&] {
    Connection& target = connection(topic);
    full = reserve(size + kMessageOverhead);
    if (full) return;
    ros::serialization::IStream stream(bytes, size);
    target.message.read(stream);
    // rosbag keeps what passes and forgets it only where size ends a chunk, not where setChunkThreshold does.
    const bool forget = held_ > kMostHeld;
    if (forget) bag_->setChunkThreshold(0);
    bag_->write(topic.name, std::max(time, ros::TIME_MIN), target.message, target.header);
    if (forget) bag_->setChunkThreshold(chunk_size_);
    held_ = forget ? 0 : held_ + size + kMessageOverhead;
    size_ = bag_->getSize();
    if (!chunk_due_) chunk_due_ = now + kChunkPeriod;
  });
  return full ? full : fault;
}

std::optional<LogFault> LogFile::closeChunkInTime(Clock::time_point now) {
  if (!chunk_due_ || now < *chunk_due_) return {};
  return guarded([this] { closeChunk(); });
}

/// Setting the threshold closes the open chunk, if there is one, and hands it to the operating system.
void LogFile::closeChunk() {
  bag_->setChunkThreshold(chunk_size_);
  chunk_due_.reset();
  index_bound_ += (2 + 2 * raw_ / chunk_size_) * (kChunkOverhead + 8 * connections_.size());
  raw_ = 0;
  struct stat found {};
  if (fstat(name_.descriptor(), &found) == 0) {
    size_ = static_cast<std::uint64_t>(found.st_size);
    size_bound_ = size_ + kSlack;
  }
}

std::optional<LogFault> LogFile::close() {
  auto fault = guarded([this] { bag_->close(); });
  if (fault) return fault;
  {
    const std::lock_guard<std::mutex> lock(pluginMutex());
    bag_.reset();
  }
  is_open_ = false;
  struct stat found {};
  if (fstat(name_.descriptor(), &found) == 0) {
    size_ = static_cast<std::uint64_t>(found.st_size);
    // Space taken ahead is given back.
    if (ftruncate(name_.descriptor(), found.st_size) != 0) allocated_ = 0;
  }
  const std::string problem = name_.publish();
  if (!problem.empty()) return LogFault{LogState::kFailed, problem};
  is_complete_ = true;
  return {};
}

}  // namespace hammer_loads
