#include "hammer_loads/log/bag_log.h"

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

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
      disk_(disk),
      queue_(settings.queue_size <= kMostQueue ? settings.queue_size : 0),
      writer_(settings, disk, queue_) {}

std::vector<std::string> BagLog::settingProblems() const {
  std::vector<std::string> problems;
  if (!isFileNamePart(settings_.prefix)) {
    problems.push_back("log_prefix: '" + settings_.prefix.substr(0, 250) +
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
  return problems;
}

std::vector<std::string> BagLog::start() {
  if (isRecording()) return {"log: already recording to " + writer_.status().file};
  std::vector<std::string> problems = settingProblems();
  Checked<std::string> directory = findLogDirectory(settings_.directory);
  problems.insert(problems.end(), directory.problems.begin(), directory.problems.end());
  if (!problems.empty()) return problems;
  if (std::string problem = LogFile::prepare(); !problem.empty()) return {problem};

  const std::uint64_t free = disk_.free_space(*directory.value);
  if (free < settings_.min_free_space) {
    return {format("log_min_free_mb: %.9g MB, must be <= the free space of log_directory %.300s = %.9g MB",
                   mb(settings_.min_free_space), directory.value->c_str(), mb(free))};
  }
  try {
    queue_.take();
  } catch (const std::bad_alloc&) {
    return {format("log_queue_mb: %.9g MB, must be <= the free memory", mb(settings_.queue_size))};
  }
  LogOrder order;
  Checked<LogName> name = LogName::take(*directory.value, settings_.prefix, order.next_number);
  if (!name.value) return name.problems;

  order.kind = LogOrder::Kind::kStart;
  order.position = queue_.end();
  order.session = last_session_ + 1;
  order.directory = *directory.value;
  order.name.emplace(std::move(*name.value));
  if (!writer_.post(std::move(order))) return {"log: too many orders wait for the disk"};
  session_ = ++last_session_;
  return {};
}

void BagLog::stop() {
  if (session_ == 0) return;
  LogOrder order;
  order.kind = LogOrder::Kind::kStop;
  order.position = queue_.end();
  if (writer_.post(std::move(order))) session_ = 0;
}

bool BagLog::split() {
  if (!isRecording()) return false;
  LogOrder order;
  order.kind = LogOrder::Kind::kSplit;
  order.position = queue_.end();
  return writer_.post(std::move(order));
}

LogTopic& BagLog::addTopic(Names& names, const std::string& key, const std::string& topic, const LogType& type,
                           bool latched, const std::string& caller) {
  const std::lock_guard<std::mutex> lock(topics_mutex_);
  LogTopic& entry = topics_.emplace_back(topics_.size(), topic, type, latched, caller);
  names.emplace(key, &entry);
  return entry;
}

void BagLog::latch(LogTopic& topic, const ros::Time& time, std::vector<std::uint8_t> bytes) {
  LogOrder order;
  order.kind = LogOrder::Kind::kLatched;
  order.position = queue_.end();
  order.topic = &topic;
  order.time = time;
  order.bytes = std::move(bytes);
  if (!writer_.post(std::move(order))) topic.refused.fetch_add(1, std::memory_order_relaxed);
}

void BagLog::forgetLatched(const std::string& topic, const std::string& caller) {
  const auto known = latched_.find(latchedKey(topic, caller));
  if (known == latched_.end()) return;
  LogOrder order;
  order.kind = LogOrder::Kind::kForget;
  order.position = queue_.end();
  order.topic = known->second;
  writer_.post(std::move(order));
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
    health.topics.push_back({topic.name, written, dropped});
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
