#include "hammer_loads/log/log_writer.h"

#include <unistd.h>

#include <algorithm>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kMostOrders = 1000;
constexpr std::uint64_t kChunkSize = 786'432;           // rosbag's own [byte]
constexpr std::chrono::milliseconds kLookInterval{10};  // the producing thread need not wake this one
constexpr std::chrono::seconds kDiskCheckInterval{1};

}  // namespace

LogWriter::LogWriter(LogSettings settings, LogDisk disk, LogQueue& queue)
    : settings_(std::move(settings)), disk_(std::move(disk)), queue_(queue), thread_(&LogWriter::run, this) {}

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
    // At most one order to stop follows each one to start; one to forget holds no message.
    const bool is_free = order.kind == LogOrder::Kind::kStop || order.kind == LogOrder::Kind::kForget;
    if (orders_.size() >= kMostOrders && !is_free) return false;
    if (order.kind == LogOrder::Kind::kStart) {  // known at once, not only when the thread gets there
      status_session_ = order.session;
      status_.state = LogState::kRecording;
      status_.reason.clear();
      status_.file = order.name->active();
      status_.file_size = 0;
    }
    orders_.push_back(std::move(order));
  }
  woken_.notify_one();
  return true;
}

void LogWriter::refuse(std::uint64_t session, LogState state, const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_session_ = session;
  status_.state = state;
  status_.reason = reason;
}

LogStatus LogWriter::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void LogWriter::report(LogState state, const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.bytes_written = totals_.bytes_written + (file_ && !file_->isComplete() ? file_->size() : 0);
  status_.files_closed = totals_.files_closed;
  status_.files_deleted = totals_.files_deleted;
  if (session_ != status_session_) return;  // a newer recording has been ordered already
  status_.state = state;
  status_.reason = reason;
  status_.file = file_->path();
  status_.file_size = file_->size();
}

void LogWriter::run() {
  while (!quit_) {
    const std::uint64_t end = queue_.end();  // before looking for orders: none that belongs ahead of it is missed
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
      next_number_ = order.next_number;
      return begin(std::move(*order.name));
    case LogOrder::Kind::kStop:
      writeLast(order);
      return end();
    case LogOrder::Kind::kSplit:
      writeLast(order);
      return split();
    case LogOrder::Kind::kLatched:
      return latch(order);
    case LogOrder::Kind::kForget:
      return forget(order.topic);
    case LogOrder::Kind::kQuit:
      quit_ = true;
      return end();
  }
}

void LogWriter::drain(std::uint64_t position) {
  while (queue_.begin() < position) {
    LogQueue::Record* record = queue_.front();
    if (file_ && disk_.before_write) disk_.before_write();
    write(*record);
    queue_.pop();
  }
}

void LogWriter::write(LogQueue::Record& record) {
  const Clock::time_point now = Clock::now();
  if (repeat_) repeatLatched(&record.time);
  std::optional<LogFault> fault;
  if (file_) fault = file_->write(*record.topic, record.time, record.bytes(), record.size, now);
  (file_ && !fault ? record.topic->written : record.topic->unsaved).fetch_add(1, std::memory_order_relaxed);
  if (fault) return stopFor(std::move(*fault));
  keepHouse(now);
}

/// Checks age of the chunk, space on the disk and size of the file, each at its interval.
void LogWriter::keepHouse(Clock::time_point now) {
  if (repeat_ && now - opened_ > LogFile::kChunkPeriod) repeatLatched(nullptr);
  if (!file_) return;
  auto fault = file_->closeChunkInTime(now);
  if (!fault && (now >= next_check_ || file_->allocated() != checked_allocation_)) {
    next_check_ = now + kDiskCheckInterval;
    checked_allocation_ = file_->allocated();
    fault = checkDisk();
    if (!fault) report(LogState::kRecording, "");
  }
  if (fault) return stopFor(std::move(*fault));
  if (file_->size() >= settings_.split_size) split();
}

std::optional<LogFault> LogWriter::checkDisk() {
  if (file_->isDeleted()) return LogFault{LogState::kFailed, "log file " + file_->path() + " was deleted"};
  const std::uint64_t free = disk_.free_space(directory_);
  if (free >= settings_.min_free_space) return {};
  constexpr double kMb = 1e6;
  return LogFault{LogState::kDiskFull, format("%.1f MB free in %.300s, log_min_free_mb: %.1f MB must stay free",
                                              static_cast<double>(free) / kMb, directory_.c_str(),
                                              static_cast<double>(settings_.min_free_space) / kMb)};
}

void LogWriter::begin(LogName name) {
  makeRoom();
  const std::uint64_t chunk_size = std::min(kChunkSize, settings_.split_size / 4);
  file_ = std::make_unique<LogFile>(std::move(name), static_cast<std::uint32_t>(chunk_size), settings_.compression);
  opened_ = Clock::now();
  next_check_ = opened_ + kDiskCheckInterval;
  auto fault = file_->open();
  if (!fault) fault = checkDisk();
  if (fault) return stopFor(std::move(*fault));
  repeat_ = true;
  report(LogState::kRecording, "");
}

/// Stops on request. A latched message is written to the file in any case.
void LogWriter::end() {
  if (repeat_) repeatLatched(nullptr);
  if (!file_) return;
  if (auto fault = file_->close()) return stopFor(std::move(*fault));
  settle();
  report(LogState::kOff, "");
  file_.reset();
}

void LogWriter::split() {
  if (!file_) return;
  if (repeat_) repeatLatched(nullptr);
  if (!file_) return;
  if (auto fault = file_->close()) return stopFor(std::move(*fault));
  settle();
  Checked<LogName> name = LogName::take(directory_, filePrefix(settings_), next_number_);
  if (!name.value) return stopFor({LogState::kFailed, name.problems.front()});
  begin(std::move(*name.value));
}

void LogWriter::writeLast(LogOrder& order) {
  if (order.topic == nullptr || !file_) return;
  if (repeat_) repeatLatched(&order.time);
  if (file_) write(*order.topic, order.time, order.bytes);
}

/// Returns false after a fault, which has stopped the recording.
bool LogWriter::write(const LogTopic& topic, const ros::Time& time, const std::vector<std::uint8_t>& bytes) {
  auto fault = file_->write(topic, time, bytes.data(), static_cast<std::uint32_t>(bytes.size()), Clock::now());
  if (fault) stopFor(std::move(*fault));
  return !fault;
}

/// Stops after a fault: the file is closed properly if possible, and the node continues without a log.
void LogWriter::stopFor(LogFault fault) {
  repeat_ = false;
  if (file_->isOpen()) {
    if (const auto second = file_->close()) fault.reason += "; " + second->reason;
    settle();
  }
  faulty_session_.store(session_, std::memory_order_release);
  report(fault.state, fault.reason);
  file_.reset();
}

/// Enters a file that has just been closed.
void LogWriter::settle() {
  if (!file_->isComplete()) return;
  closed_.emplace_back(file_->path(), file_->size());
  closed_size_ += file_->size();
  totals_.bytes_written += file_->size();
  ++totals_.files_closed;
}

/// Deletes the oldest files of this process until another one fits within log_total_mb. Files of earlier runs are kept.
void LogWriter::makeRoom() {
  if (settings_.total_size == 0) return;
  while (!closed_.empty() && closed_size_ + settings_.split_size > settings_.total_size) {
    if (unlink(closed_.front().first.c_str()) == 0) ++totals_.files_deleted;
    closed_size_ -= closed_.front().second;
    closed_.pop_front();
  }
}

void LogWriter::latch(LogOrder& order) {
  const auto same = [&order](const Latched& latched) { return latched.topic == order.topic; };
  auto place = std::find_if(latched_.begin(), latched_.end(), same);
  if (place == latched_.end()) place = latched_.insert(place, Latched{order.topic, {}, {}});
  place->time = order.time;
  place->bytes = std::move(order.bytes);
  if (!file_) return;
  order.topic->written.fetch_add(1, std::memory_order_relaxed);
  if (!repeat_) write(*order.topic, order.time, place->bytes);  // else it comes with the others
}

void LogWriter::forget(const LogTopic* topic) {
  const auto same = [topic](const Latched& latched) { return latched.topic == topic; };
  latched_.erase(std::remove_if(latched_.begin(), latched_.end(), same), latched_.end());
}

/// time: of the file's first message, so that the file does not begin with a gap; null: there is none yet.
void LogWriter::repeatLatched(const ros::Time* time) {
  repeat_ = false;
  for (const Latched& latched : latched_)
    if (!write(*latched.topic, time != nullptr ? *time : latched.time, latched.bytes)) return;
}

}  // namespace hammer_loads
