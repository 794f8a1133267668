/// Thread that writes messages from the queue to the disk. Its errors do not end the process.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hammer_loads/log/log_directory.h"
#include "hammer_loads/log/log_file.h"
#include "hammer_loads/log/log_queue.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"

namespace hammer_loads {

/// Interface to the disk. A test replaces it by a slow or a full disk.
struct LogDisk {
  std::function<void()> before_write;  ///< called by the writing thread ahead of every message, if set
  std::function<std::uint64_t(const std::string& directory)> free_space{freeSpace};  ///< [byte]
};

/// Serialised message.
struct LogMessage {
  LogTopic* topic{};
  ros::Time time;  ///< record time
  std::vector<std::uint8_t> bytes;
};

/// Thread that writes a log. Other threads use the public functions only. start() to forget() are orders to this
/// thread, given by the thread that fills the queue. They return at once and are carried out after all messages queued
/// before. They return false if too many orders wait; orders to stop and to forget always succeed.
class LogWriter {
 public:
  LogWriter(LogSettings settings, LogDisk disk, LogQueue& queue);
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  /// Carries out all orders, writes all messages and closes the file.
  ~LogWriter();

  /// session: number of this recording, from 1.
  bool start(std::uint64_t session, std::shared_ptr<LogFile> file);
  void stop();
  bool split();
  /// Writes a message if a bag is open. always: accepted even if too many orders wait.
  bool write(LogMessage message, bool always);
  /// Writes a message and keeps it for the beginning of later files.
  bool latch(LogMessage message);
  void forget(const LogTopic& topic);

  /// Reports a recording that begins or, for the reason, cannot. session: number of its own. file: empty for none.
  void announce(std::uint64_t session, LogState state, const std::string& reason, const std::string& file = {});
  LogStatus status() const;
  /// Returns the number of the last recording that stopped by itself; 0: none.
  std::uint64_t faultySession() const noexcept { return faulty_session_.load(std::memory_order_acquire); }

 private:
  using Clock = LogFile::Clock;
  struct Order {
    std::uint64_t position{};  // position in the queue behind which it is carried out
    std::function<void()> action;
  };

  bool post(bool always, std::function<void()> action);
  void run();
  std::optional<Order> nextOrder();
  template <typename Action>
  void attempt(const Action& action);
  void drain(std::uint64_t position);
  void write(LogQueue::Record& record, Clock::time_point now);
  void write(const LogMessage& message, const ros::Time& time);
  void keepHouse(Clock::time_point now);
  void checkDisk() const;

  void begin(std::shared_ptr<LogFile> file);
  void closeFile();
  void end();
  void beginNext();
  void stopFor(const LogFault& fault);
  void makeRoom();
  void repeatLatched(const ros::Time* time);
  void report(LogState state, const std::string& reason);

  const LogSettings settings_;
  const LogDisk disk_;
  LogQueue& queue_;

  // Members for the writing thread only.
  std::shared_ptr<LogFile> file_;
  std::uint64_t session_{};
  bool quit_{};
  bool repeat_{};  // latched messages are still to be repeated in this file
  Clock::time_point opened_{}, next_check_{};
  std::uint64_t checked_allocation_{};                        // of the file at the last check of the disk [byte]
  std::map<std::size_t, LogMessage> latched_;                 // last messages by LogTopic::index
  std::deque<std::pair<std::string, std::uint64_t>> closed_;  // files of this process, oldest first, with their sizes
  std::uint64_t closed_size_{};                               // total size of these files [byte]
  LogStatus totals_;                                          // only its counters are used

  std::atomic<std::uint64_t> faulty_session_{};
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<Order> orders_;        // guarded by mutex_
  LogStatus status_;                // guarded by mutex_
  std::uint64_t status_session_{};  // guarded by mutex_
  std::thread thread_;              // declared last: starts when all other members exist
};

}  // namespace hammer_loads
