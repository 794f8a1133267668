#include "hammer_loads/ros/log_writer.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "hammer_loads/linkage/format.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kMostOrders = 1000;
constexpr std::uint32_t kChunkSize = 768 * 1024;           // rosbag's own
constexpr std::chrono::milliseconds kLookInterval{10};     // the producing thread need not wake this one
constexpr std::chrono::seconds kDiskCheckInterval{1};

}  // namespace

LogWriter::LogWriter(const LogSettings& settings, const LogDisk& disk, LogQueue& queue)
    : settings_(settings), disk_(disk), queue_(queue), thread_(&LogWriter::run, this) {}

LogWriter::~LogWriter() {
  LogOrder quit;
  quit.kind = LogOrder::Kind::kQuit;
  quit.position = queue_.end();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    orders_.push_back(std::move(quit));
  }
  woken_.notify_one();
  thread_.join();
}

bool LogWriter::post(LogOrder order) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (orders_.size() >= kMostOrders) return false;
    orders_.push_back(std::move(order));
  }
  woken_.notify_one();
  return true;
}

LogStatus LogWriter::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void LogWriter::run() {
  while (!quit_) {
    const std::uint64_t end = queue_.end();  // before the orders: none of a place ahead of it can be missed
    std::optional<LogOrder> order = nextOrder();
    drain(order ? order->position : end);
    if (order) {
      carryOut(*order);
      continue;
    }
    keepHouse(Clock::now());
    std::unique_lock<std::mutex> lock(mutex_);
    const auto has_order = [this] { return !orders_.empty(); };
    if (file_) {
      woken_.wait_for(lock, kLookInterval, has_order);
    } else {
      woken_.wait(lock, has_order);
    }
  }
}

std::optional<LogOrder> LogWriter::nextOrder() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (orders_.empty()) return {};
  std::optional<LogOrder> order = std::move(orders_.front());
  orders_.pop_front();
  return order;
}

void LogWriter::carryOut(LogOrder& order) {
  switch (order.kind) {
    case LogOrder::Kind::kStart:
      session_ = order.session;
      directory_ = order.directory;
      begin(std::move(*order.name));
      break;
    case LogOrder::Kind::kStop:
      if (file_) end();
      break;
    case LogOrder::Kind::kSplit:
      if (file_) split();
      break;
    case LogOrder::Kind::kLatched:
      latch(order);
      break;
    case LogOrder::Kind::kQuit:
      if (file_) end();
      quit_ = true;
      break;
  }
}

void LogWriter::drain(std::uint64_t position) {
  while (queue_.begin() < position) {
    LogQueue::Record* record = queue_.front();
    if (file_ && disk_.before_write) disk_.before_write();
    if (file_) write(*record);
    queue_.pop();
  }
}

void LogWriter::write(LogQueue::Record& record) {
  const Clock::time_point now = Clock::now();
  if (repeat_) repeatLatched(record.time);
  if (!file_) return;
  if (auto fault = file_->write(*record.topic, record.time, record.bytes(), record.size, now)) {
    record.topic->unsaved.fetch_add(1, std::memory_order_relaxed);
    return stopFor(*fault);
  }
  last_time_ = record.time;
  record.topic->written.fetch_add(1, std::memory_order_relaxed);
  keepHouse(now);
}

/// Chunk, size and disk, each in its time.
void LogWriter::keepHouse(Clock::time_point now) {
  if (!file_) return;
  if (repeat_ && now - opened_ > LogFile::kChunkPeriod) repeatLatched(last_time_);
  if (!file_) return;
  auto fault = file_->closeChunkInTime(now);
  if (!fault && now >= next_check_) {
    next_check_ = now + kDiskCheckInterval;
    fault = checkDisk();
    report(LogState::kRecording, "");
  }
  if (fault) return stopFor(*fault);
  if (file_->size() >= settings_.split_size) split();
}

std::optional<LogFault> LogWriter::checkDisk() {
  if (file_->isDeleted()) return LogFault{LogState::kFailed, "log file " + file_->path() + " was deleted"};
  const std::uint64_t free = disk_.free_space(directory_);
  if (free >= settings_.min_free_space) return {};
  constexpr double kMb = 1e6;
  return LogFault{LogState::kDiskFull, format("%.1f MB free in %s, log_min_free_mb is %.1f MB",
                                              static_cast<double>(free) / kMb, directory_.c_str(),
                                              static_cast<double>(settings_.min_free_space) / kMb)};
}

void LogWriter::begin(LogName name) {
  deleteOldest();
  const std::uint64_t chunk = std::min<std::uint64_t>(kChunkSize, settings_.split_size / 4);
  file_ = std::make_unique<LogFile>(std::move(name), static_cast<std::uint32_t>(chunk));
  opened_ = Clock::now();
  next_check_ = opened_ + kDiskCheckInterval;
  repeat_ = true;
  auto fault = file_->open();
  if (!fault) fault = checkDisk();
  if (fault) return stopFor(*fault);
  report(LogState::kRecording, "");
}

/// Closes the file; what is latched stands in it in any case.
void LogWriter::end() {
  if (repeat_) repeatLatched(last_time_);
  if (!file_) return;
  const auto fault = file_->close();
  if (fault) return stopFor(*fault);
  report(LogState::kOff, "");
  file_.reset();
}

void LogWriter::split() {
  end();
  if (faultySession() == session_) return;
  Checked<LogName> name = LogName::take(directory_, settings_.prefix, next_number_);
  if (!name.value) return stopFor({LogState::kFailed, name.problems.front()});
  begin(std::move(*name.value));
}

void LogWriter::latch(LogOrder& order) {
  auto place = std::find_if(latched_.begin(), latched_.end(), [&](const Latched& l) { return l.topic == order.topic; });
  if (place == latched_.end()) place = latched_.insert(place, {order.topic, {}, {}});
  place->time = order.time;
  place->bytes = std::move(order.bytes);
}

void LogWriter::repeatLatched(const ros::Time& time) {}

void LogWriter::deleteOldest() {
  if (settings_.total_size == 0) return;
  while (!closed_.empty() && closed_size_ + settings_.split_size > settings_.total_size) {
    unlink(closed_.front().path.c_str());
  }
}

}  // namespace hammer_loads
