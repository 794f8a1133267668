/// The thread that writes messages from the queue to the disk.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hammer_loads/log/log_file.h"
#include "hammer_loads/log/log_queue.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"

namespace hammer_loads {

/// A task of the writing thread, at its place among the messages.
struct LogOrder {
  enum class Kind { kStart, kStop, kSplit, kLatched, kForget, kQuit };
  Kind kind{};
  std::uint64_t position{};         ///< in the queue: carried out behind what was queued before
  std::uint64_t session{};          ///< kStart: number of this recording, from 1
  std::string directory;            ///< kStart
  std::optional<LogName> name;      ///< kStart: first file
  unsigned next_number{};           ///< kStart: in the name of the second file
  LogTopic* topic{};                ///< kLatched, kForget; kStop, kSplit: of a last message for the bag, if not null
  ros::Time time;                   ///< record time of the message
  std::vector<std::uint8_t> bytes;  ///< serialised message
};

/// Thread that writes a log. Other threads use only the constructor, the destructor, post(), status() and
/// faultySession().
class LogWriter {
 public:
  LogWriter(LogSettings settings, LogDisk disk, LogQueue& queue);
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  /// Carries out all orders, writes all messages, closes the file.
  ~LogWriter();

  /// Queues an order. Returns false if too many orders wait; orders to stop and to forget always succeed.
  bool post(LogOrder order);
  /// A recording that cannot begin. session: a number of its own.
  void refuse(std::uint64_t session, LogState state, const std::string& reason);
  LogStatus status() const;
  /// The recording that stopped by itself last; 0: none.
  std::uint64_t faultySession() const noexcept { return faulty_session_.load(std::memory_order_acquire); }

 private:
  using Clock = LogFile::Clock;
  struct Latched {
    LogTopic* topic;
    ros::Time time;
    std::vector<std::uint8_t> bytes;
  };

  void run();
  std::optional<LogOrder> nextOrder();
  void carryOut(LogOrder& order);
  void drain(std::uint64_t position);
  void write(LogQueue::Record& record);
  void keepHouse(Clock::time_point now);
  std::optional<LogFault> checkDisk();

  void begin(LogName name);
  void end();
  void split();
  void writeLast(LogOrder& order);
  void stopFor(LogFault fault);
  void settle();
  void makeRoom();
  void latch(LogOrder& order);
  void forget(const LogTopic* topic);
  void repeatLatched(const ros::Time* time);
  void report(LogState state, const std::string& reason);

  const LogSettings settings_;
  const LogDisk disk_;
  LogQueue& queue_;

  // The writing thread's own.
  std::unique_ptr<LogFile> file_;
  std::uint64_t session_{};
  std::string directory_;
  unsigned next_number_{};
  bool quit_{};
  bool repeat_{};  // latched messages still to be repeated in this file
  Clock::time_point opened_{}, next_check_{};
  std::uint64_t checked_allocation_{};  // of the file when the disk was looked at last [byte]
  std::vector<Latched> latched_;
  std::deque<std::pair<std::string, std::uint64_t>> closed_;  // files of this process, oldest first, with their sizes
  std::uint64_t closed_size_{};                               // of them together [byte]
  LogStatus totals_;                                          // only its sums

  std::atomic<std::uint64_t> faulty_session_{};
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<LogOrder> orders_;     // guarded by mutex_
  LogStatus status_;                // guarded by mutex_
  std::uint64_t status_session_{};  // guarded by mutex_
  std::thread thread_;              // last: starts when all else is there
};

}  // namespace hammer_loads
