#include "hammer_loads/log/log_writer.h"

#include <unistd.h>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kMostOrders = 1000;
constexpr std::chrono::milliseconds kLookInterval{10};  // the producing thread need not wake this one
constexpr std::chrono::seconds kDiskCheckInterval{1};

}  // namespace

LogWriter::LogWriter(LogSettings settings, LogDisk disk, LogQueue& queue)
    : settings_(std::move(settings)), disk_(std::move(disk)), queue_(queue), thread_(&LogWriter::run, this) {}

LogWriter::~LogWriter() {
  post(true, [this] {
    quit_ = true;
    end();
  });
  thread_.join();
}

bool LogWriter::start(std::uint64_t session, std::shared_ptr<LogFile> file) {
  announce(session, LogState::kRecording, "", file->path());  // reported at once, before the thread begins
  return post(false, [this, session, file = std::move(file)] {
    session_ = session;
    begin(file);
  });
}

void LogWriter::stop() {
  post(true, [this] { end(); });
}

bool LogWriter::split() {
  return post(false, [this] { beginNext(); });
}

bool LogWriter::write(LogMessage message, bool always) {
  return post(always, [this, message = std::move(message)] {
    if (!file_) return;
    if (repeat_) repeatLatched(&message.time);
    write(message, message.time);
  });
}

bool LogWriter::latch(LogMessage message) {
  return post(false, [this, message = std::move(message)] {
    latched_[message.topic->index] = message;
    if (!file_) return;
    message.topic->written.fetch_add(1, std::memory_order_relaxed);
    if (!repeat_) write(message, message.time);  // else repeatLatched() writes it
  });
}

void LogWriter::forget(const LogTopic& topic) {
  post(true, [this, index = topic.index] { latched_.erase(index); });
}

bool LogWriter::post(bool always, std::function<void()> action) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (orders_.size() >= kMostOrders && !always) return false;
    orders_.push_back({queue_.end(), std::move(action)});
  }
  woken_.notify_one();
  return true;
}

void LogWriter::announce(std::uint64_t session, LogState state, const std::string& reason, const std::string& file) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_session_ = session;
  status_.state = state;
  status_.reason = reason;
  if (file.empty()) return;
  status_.file = file;
  status_.file_size = 0;
}

LogStatus LogWriter::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void LogWriter::report(LogState state, const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.bytes_written = totals_.bytes_written + (file_->isComplete() ? 0 : file_->size());
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
    const std::uint64_t end = queue_.end();  // read before the orders, so that no order ahead of it is missed
    const std::optional<Order> order = nextOrder();
    drain(order ? order->position : end);
    if (order) {
      attempt(order->action);
      continue;
    }
    attempt([this] { keepHouse(Clock::now()); });
    std::unique_lock<std::mutex> lock(mutex_);
    const auto has_order = [this] { return !orders_.empty(); };
    if (file_) {
      woken_.wait_for(lock, kLookInterval, has_order);
    } else {
      woken_.wait(lock, has_order);
    }
  }
}

std::optional<LogWriter::Order> LogWriter::nextOrder() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (orders_.empty()) return {};
  std::optional<Order> order = std::move(orders_.front());
  orders_.pop_front();
  return order;
}

/// Carries out an action. A fault ends the recording, and the node continues without a log.
template <typename Action>
void LogWriter::attempt(const Action& action) {
  try {
    action();
  } catch (const LogFault& fault) {
    stopFor(fault);
  }
}

void LogWriter::drain(std::uint64_t position) {
  while (queue_.begin() < position) {
    LogQueue::Record* record = queue_.front();
    if (file_ && disk_.before_write) disk_.before_write();
    attempt([&] {
      const Clock::time_point now = Clock::now();
      write(*record, now);
      keepHouse(now);
    });
    queue_.pop();
  }
}

void LogWriter::write(LogQueue::Record& record, Clock::time_point now) {
  LogTopic& topic = *record.topic;
  const auto count = [](std::atomic<std::uint64_t>& messages) { messages.fetch_add(1, std::memory_order_relaxed); };
  if (!file_) return count(topic.unsaved);
  try {
    if (repeat_) repeatLatched(&record.time);
    file_->write(topic, record.time, record.bytes(), record.size, now);
  } catch (const LogFault&) {
    count(topic.unsaved);  // before the state reports the fault
    throw;
  }
  count(topic.written);
}

void LogWriter::write(const LogMessage& message, const ros::Time& time) {
  file_->write(*message.topic, time, message.bytes.data(), static_cast<std::uint32_t>(message.bytes.size()),
               Clock::now());
}

/// Checks the age of the chunk, the space on the disk and the size of the file, each at its interval.
void LogWriter::keepHouse(Clock::time_point now) {
  if (!file_) return;
  if (repeat_ && now - opened_ > LogFile::kChunkPeriod) repeatLatched(nullptr);
  file_->closeChunkInTime(now);
  if (now >= next_check_ || file_->allocated() != checked_allocation_) {
    next_check_ = now + kDiskCheckInterval;
    checked_allocation_ = file_->allocated();
    checkDisk();
    report(LogState::kRecording, "");
  }
  if (file_->size() >= settings_.split_size) beginNext();
}

void LogWriter::checkDisk() const {
  if (file_->isDeleted()) throw LogFault(LogState::kFailed, "log file " + file_->path() + " was deleted");
  const std::uint64_t free = disk_.free_space(file_->directory());
  if (free >= settings_.min_free_space) return;
  constexpr double kMb = 1e6;
  throw LogFault(LogState::kDiskFull, format("%.1f MB free in %.300s, log_min_free_mb: %.1f MB must stay free",
                                             static_cast<double>(free) / kMb, file_->directory().c_str(),
                                             static_cast<double>(settings_.min_free_space) / kMb));
}

void LogWriter::begin(std::shared_ptr<LogFile> file) {
  makeRoom();
  file_ = std::move(file);
  opened_ = Clock::now();
  next_check_ = opened_ + kDiskCheckInterval;
  file_->open();
  checkDisk();
  repeat_ = true;
  report(LogState::kRecording, "");
}

/// Closes the file. Latched messages that it still lacks are written first.
void LogWriter::closeFile() {
  if (repeat_) repeatLatched(nullptr);
  file_->close();
  closed_.emplace_back(file_->path(), file_->size());
  closed_size_ += file_->size();
  totals_.bytes_written += file_->size();
  ++totals_.files_closed;
}

/// Ends the recording on request.
void LogWriter::end() {
  if (!file_) return;
  closeFile();
  report(LogState::kOff, "");
  file_.reset();
}

void LogWriter::beginNext() {
  if (!file_) return;
  closeFile();
  begin(file_->next());
}

/// Ends the recording after a fault. The file is closed properly if possible.
void LogWriter::stopFor(const LogFault& fault) {
  std::string reason = fault.what();
  repeat_ = false;
  try {
    if (file_->isOpen()) closeFile();
  } catch (const LogFault& second) {
    reason += std::string("; ") + second.what();
  }
  faulty_session_.store(session_, std::memory_order_release);
  report(fault.state, reason);
  file_.reset();
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

/// Writes the latched messages. time: that of the file's first message, to avoid a gap after them; null: their own.
void LogWriter::repeatLatched(const ros::Time* time) {
  repeat_ = false;
  for (const auto& [index, message] : latched_) write(message, time != nullptr ? *time : message.time);
}

}  // namespace hammer_loads
