#include "hammer_loads/log/bag_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <new>
#include <utility>

#include "hammer_loads/log/log_gaps.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kMb = 1e6;
constexpr std::uint64_t kLeastSplit = 64'000;        // [byte]
constexpr std::uint64_t kMostQueue = 4'000'000'000;  // [byte]

double mb(std::uint64_t bytes) { return static_cast<double>(bytes) / kMb; }

bool isFileNamePart(const std::string& text) {
  const auto is_bad = [](unsigned char c) { return c == '/' || c < 0x20 || c == 0x7f; };
  return !text.empty() && text.size() <= 200 && text.front() != '.' && std::none_of(text.begin(), text.end(), is_bad);
}

}  // namespace

BagLog::BagLog(const LogSettings& settings, const LogDisk& disk)
    : settings_(settings),
      gap_name_(settings.node + kGapTopic),
      disk_(disk),
      queue_(settings.queue_size <= kMostQueue ? settings.queue_size : 0),
      writer_(settings, disk, queue_) {}

std::vector<std::string> BagLog::settingProblems() const {
  std::vector<std::string> problems;
  if (const std::string prefix = filePrefix(settings_); !isFileNamePart(prefix)) {
    problems.push_back("log_prefix: '" + prefix.substr(0, 250) +
                       "', must be a file name's beginning: 1 to 200 characters, no /, not . first");
  }
  if (settings_.split_size < kLeastSplit) {
    problems.push_back(format("log_split_mb: %.9g MB, must be >= %.9g MB", mb(settings_.split_size), mb(kLeastSplit)));
  }
  if (settings_.total_size != 0 && settings_.total_size / 2 < settings_.split_size) {
    problems.push_back(format("log_total_mb: %.9g MB, must be 0 (no limit) or >= 2 x log_split_mb = %.9g MB",
                              mb(settings_.total_size), 2.0 * mb(settings_.split_size)));
  }
  if (settings_.queue_size > kMostQueue) {
    problems.push_back(format("log_queue_mb: %.9g MB, must be <= %.9g MB", mb(settings_.queue_size), mb(kMostQueue)));
  }
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  problems.insert(problems.end(), directory.problems.begin(), directory.problems.end());
  if (directory.value && faccessat(AT_FDCWD, directory.value->c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    problems.push_back("log_directory: '" + *directory.value + "', must be writable: " + std::strerror(errno));
  return problems;
}

LogOrder BagLog::orderNow(LogOrder::Kind kind) const {
  LogOrder order;
  order.kind = kind;
  order.position = queue_.end();
  return order;
}

/// Reasons why a log with valid settings cannot begin now: disk or memory.
std::vector<std::string> BagLog::refuse(LogState state, std::string problem) {
  writer_.refuse(++last_session_, state, problem);
  return {std::move(problem)};
}

std::vector<std::string> BagLog::start() {
  if (isRecording()) return {"log: already recording to " + writer_.status().file};
  session_ = 0;
  is_wanted_ = true;
  std::vector<std::string> problems = settingProblems();
  if (!problems.empty()) return problems;
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  if (!directory.value) return directory.problems;

  const std::uint64_t free = disk_.free_space(*directory.value);
  if (free < settings_.min_free_space) {
    return refuse(LogState::kDiskFull,
                  format("log_min_free_mb: %.9g MB, must be <= the free space of log_directory %.300s = %.9g MB",
                         mb(settings_.min_free_space), directory.value->c_str(), mb(free)));
  }
  try {
    queue_.take();
  } catch (const std::bad_alloc&) {
    return refuse(LogState::kFailed,
                  format("log_queue_mb: %.9g MB, must be <= the free memory", mb(settings_.queue_size)));
  }
  LogOrder order = orderNow(LogOrder::Kind::kStart);
  Checked<LogName> name = LogName::take(*directory.value, filePrefix(settings_), order.next_number);
  if (!name.value) return refuse(LogState::kFailed, name.problems.front());
  if (!LogFile::hasRoomFor(*name.value, free)) {
    return refuse(LogState::kDiskFull, format("log_directory: '%.300s', must have at least %.9g MB free",
                                              directory.value->c_str(), mb(LogFile::kAllocationStep)));
  }

  order.session = last_session_ + 1;
  order.directory = *directory.value;
  order.name.emplace(std::move(*name.value));
  if (!writer_.post(std::move(order))) return refuse(LogState::kFailed, "log: too many orders wait for the disk");
  session_ = ++last_session_;
  gapNoted();
  return {};
}

bool BagLog::hasRoomAgain() const {
  // Minimum of new room, so that a disk at its limit does not begin a bag every second.
  constexpr std::uint64_t kMoreRoom = 16'000'000;  // [byte]
  if (!is_wanted_ || isRecording() || writer_.status().state != LogState::kDiskFull) return false;
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  return directory.value && disk_.free_space(*directory.value) >= settings_.min_free_space + kMoreRoom;
}

void BagLog::stop() {
  is_wanted_ = false;
  if (session_ == 0) return;
  LogOrder order = orderNow(LogOrder::Kind::kStop);
  noteGapIn(order);
  writer_.post(std::move(order));
  gapNoted();
  session_ = 0;
}

bool BagLog::split() {
  if (!isRecording()) return false;
  LogOrder order = orderNow(LogOrder::Kind::kSplit);
  noteGapIn(order);
  if (!writer_.post(std::move(order))) return false;
  gapNoted();
  return true;
}

LogTopic& BagLog::addTopic(Names& names, const std::string& key, const std::string& topic, const LogType& type,
                           bool latched, const std::string& caller) {
  if (const auto known = names.find(key); known != names.end()) return *known->second;
  const std::lock_guard<std::mutex> lock(topics_mutex_);
  LogTopic& entry = topics_.emplace_back(topics_.size(), topic, type, latched, caller);
  names.emplace(key, &entry);
  return entry;
}

void BagLog::latch(LogTopic& topic, const ros::Time& time, std::vector<std::uint8_t> bytes) {
  LogOrder order = orderNow(LogOrder::Kind::kLatched);
  order.topic = &topic;
  order.time = time;
  order.bytes = std::move(bytes);
  if (writer_.post(std::move(order))) return;
  lose(topic, time);
  forget(topic);  // earlier latched messages hold no longer
}

void BagLog::forgetLatched(const std::string& topic, const std::string& caller) {
  if (const auto known = latched_.find(latchedKey(topic, caller)); known != latched_.end()) forget(*known->second);
}

void BagLog::forget(LogTopic& topic) {
  LogOrder order = orderNow(LogOrder::Kind::kForget);
  order.topic = &topic;
  writer_.post(std::move(order));
}

void BagLog::lose(LogTopic& topic, const ros::Time& time) {
  topic.refused.fetch_add(1, std::memory_order_relaxed);
  has_gap_ |= isRecording();
  gap_time_ = time;
}

/// Serialised message of the losses since the last one.
std::vector<std::uint8_t> BagLog::describeGap() {
  using Gap = diagnostic_msgs::DiagnosticStatus;
  if (gap_topic_ == nullptr) {
    gap_topic_ = &addTopic(plain_, gap_name_, gap_name_, typeOf(Gap()), false, {});
  }
  Gap gap;
  gap.level = Gap::WARN;
  gap.name = settings_.node + ": log";
  gap.message = "messages were lost: a bag processed again may differ from what was published (log_queue_mb)";
  for (LogTopic& topic : topics_) {
    const std::uint64_t refused = topic.refused.load(std::memory_order_relaxed);
    if (refused == topic.noted) continue;
    gap.values.emplace_back();
    gap.values.back().key = topic.name;
    gap.values.back().value = std::to_string(refused - topic.noted);
  }
  return bytesOf(gap);
}

/// Writes the gap ahead of the next message of the log, as soon as the queue has room again.
void BagLog::noteGap(const ros::Time& time) {
  constexpr double kMuchRoom = 0.5;  // else the next message would be lost as well
  if (queue_.fill() > kMuchRoom) return;
  const std::vector<std::uint8_t> bytes = describeGap();
  std::uint8_t* place = queue_.reserve(static_cast<std::uint32_t>(bytes.size()));
  if (place == nullptr) return;
  std::copy(bytes.begin(), bytes.end(), place);
  queue_.commit(*gap_topic_, time);
  gapNoted();
}

void BagLog::gapNoted() {
  has_gap_ = false;
  for (LogTopic& topic : topics_) topic.noted = topic.refused.load(std::memory_order_relaxed);
}

/// Gap at the end of a bag, if the queue had no room until then.
void BagLog::noteGapIn(LogOrder& order) {
  if (!has_gap_) return;
  order.bytes = describeGap();
  order.topic = gap_topic_;
  order.time = gap_time_;
}

std::vector<std::string> BagLog::unfinishedBags() const {
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  return directory.value ? unfinishedLogs(*directory.value, filePrefix(settings_)) : std::vector<std::string>{};
}

std::string BagLog::recoveryHint(const std::string& path) {
  const std::string bag = path.substr(0, path.rfind(".active"));
  return path + " was not closed; to recover it: mv '" + path + "' '" + bag + "' && rosbag reindex '" + bag + "'";
}

LogHealth BagLog::health() const {
  LogHealth health;
  static_cast<LogStatus&>(health) = writer_.status();
  health.queue_fill = queue_.fill();
  const std::lock_guard<std::mutex> lock(topics_mutex_);
  for (const LogTopic& topic : topics_) {
    const std::uint64_t written = topic.written.load(std::memory_order_relaxed);
    const std::uint64_t dropped =
        topic.refused.load(std::memory_order_relaxed) + topic.unsaved.load(std::memory_order_relaxed);
    if (topic.name == gap_name_) continue;  // the log's own
    health.topics.push_back({topic.name, written, dropped, topic.too_large.load(std::memory_order_relaxed)});
    health.messages_written += written;
    health.messages_dropped += dropped;
  }
  return health;
}

ros::Time BagLog::nextRecordTime(const ros::Time& arrival, const ros::Time& last) noexcept {
  constexpr std::uint64_t kGiga = 1'000'000'000;
  constexpr std::uint64_t kEnd = std::numeric_limits<std::uint32_t>::max() * kGiga + (kGiga - 1);  // year 2106
  const auto nanoseconds = [](const ros::Time& time) { return time.sec * kGiga + time.nsec; };
  const std::uint64_t next = std::min(std::max(nanoseconds(arrival), nanoseconds(last) + 1), kEnd);
  ros::Time time;
  time.sec = static_cast<std::uint32_t>(next / kGiga);
  time.nsec = static_cast<std::uint32_t>(next % kGiga);
  return time;
}

}  // namespace hammer_loads
