#include "hammer_loads/log/bag_log.h"

#include <new>
#include <utility>

#include "hammer_loads/log/log_gaps.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

constexpr double kMb = 1e6;
constexpr std::uint64_t kLeastSplit = 64'000;        // [byte]
constexpr std::uint64_t kMostQueue = 4'000'000'000;  // [byte]

double mb(std::uint64_t bytes) { return static_cast<double>(bytes) / kMb; }

bool isFileNamePart(const std::string& text) {
  return !text.empty() && text.size() <= 200 && text.front() != '.' && text.find('/') == std::string::npos &&
         text == onOneLine(text);
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
  return problems;
}

std::vector<std::string> BagLog::start() {
  if (isRecording()) return {"log: already recording to " + writer_.status().file};
  session_ = 0;
  is_wanted_ = true;
  std::vector<std::string> problems = settingProblems();
  if (!problems.empty()) return problems;
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  if (!directory.value) return directory.problems;
  const std::uint64_t session = ++last_session_;
  try {
    beginIn(*directory.value, session);
  } catch (const LogFault& fault) {
    writer_.announce(session, fault.state, fault.what());
    return {fault.what()};
  }
  session_ = session;
  gap_.clear();
  return {};
}

/// Begins a bag in the directory. Throws LogFault if disk or memory prevent this although the settings are valid.
void BagLog::beginIn(const std::string& directory, std::uint64_t session) {
  const std::uint64_t free = disk_.free_space(directory);
  if (free < settings_.min_free_space) {
    throw LogFault(LogState::kDiskFull,
                   format("log_min_free_mb: %.9g MB, must be <= the free space of log_directory %.300s = %.9g MB",
                          mb(settings_.min_free_space), directory.c_str(), mb(free)));
  }
  try {
    queue_.take();
  } catch (const std::bad_alloc&) {
    throw LogFault(LogState::kFailed,
                   format("log_queue_mb: %.9g MB, must be <= the free memory", mb(settings_.queue_size)));
  }
  const std::shared_ptr<LogFile> file = LogFile::create(settings_, directory);
  if (!file->hasRoom(free)) {
    throw LogFault(LogState::kDiskFull, format("log_directory: '%.300s', must have at least %.9g MB free",
                                               directory.c_str(), mb(LogFile::kAllocationStep)));
  }
  if (!writer_.start(session, file)) throw LogFault(LogState::kFailed, "log: too many orders wait for the disk");
}

bool BagLog::hasRoomAgain() const {
  // Required additional free space. Without it, a disk at its limit would begin a bag every second.
  constexpr std::uint64_t kMoreRoom = 16'000'000;  // [byte]
  if (!is_wanted_ || isRecording() || writer_.status().state != LogState::kDiskFull) return false;
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  return directory.value && disk_.free_space(*directory.value) >= settings_.min_free_space + kMoreRoom;
}

void BagLog::stop() {
  is_wanted_ = false;
  if (session_ == 0) return;
  reportGap(gap_time_, true);
  writer_.stop();
  session_ = 0;
}

bool BagLog::split() { return isRecording() && reportGap(gap_time_, false) && writer_.split(); }

LogTopic& BagLog::addTopic(const std::string& key, BagWriter::Connection connection) {
  const std::lock_guard<std::mutex> lock(topics_mutex_);
  return *(by_key_[key] = &topics_.emplace_back(topics_.size(), std::move(connection)));
}

void BagLog::forgetLatched(const std::string& topic, const std::string& caller) {
  if (const auto known = by_key_.find(latchedKey(topic, caller)); known != by_key_.end())
    writer_.forget(*known->second);
}

void BagLog::lose(LogTopic& topic, const ros::Time& time) {
  topic.refused.fetch_add(1, std::memory_order_relaxed);
  if (isRecording()) ++gap_[topic.connection.topic];
  gap_time_ = time;
}

/// Writes the losses since the last report, if there are any, after the messages queued so far. Returns false if too
/// many orders wait.
bool BagLog::reportGap(const ros::Time& time, bool always) {
  using Gap = diagnostic_msgs::DiagnosticStatus;
  if (gap_.empty()) return true;
  Gap gap;
  gap.level = Gap::WARN;
  gap.name = settings_.node + ": log";
  gap.message = "messages were lost: a bag processed again may differ from what was published (log_queue_mb)";
  for (const auto& [topic, lost] : gap_) {
    gap.values.emplace_back();
    gap.values.back().key = topic;
    gap.values.back().value = std::to_string(lost);
  }
  if (!writer_.write({&topicOf(gap_name_, gap_name_, gap), time, bytesOf(gap)}, always)) return false;
  gap_.clear();
  return true;
}

std::vector<std::string> BagLog::unfinishedBags() const {
  std::vector<std::string> lines;
  const Checked<std::string> directory = findLogDirectory(settings_.directory);
  if (!directory.value) return lines;
  for (const std::string& path : unfinishedLogs(*directory.value, filePrefix(settings_))) {
    const std::string bag = path.substr(0, path.rfind(".active"));
    lines.push_back(path + " was not closed; to recover it: mv '" + path + "' '" + bag + "' && rosbag reindex '" + bag +
                    "'");
  }
  return lines;
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
    if (topic.connection.topic == gap_name_) continue;  // topic of the log itself
    health.topics.push_back(
        {topic.connection.topic, written, dropped, topic.too_large.load(std::memory_order_relaxed)});
    health.messages_written += written;
    health.messages_dropped += dropped;
  }
  return health;
}

}  // namespace hammer_loads
