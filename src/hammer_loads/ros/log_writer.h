/// The thread that takes messages from the queue to the disk.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hammer_loads/parameters/log_settings.h"
#include "hammer_loads/ros/log_file.h"
#include "hammer_loads/ros/log_queue.h"

namespace hammer_loads {

/// What the writing thread is told, at its place among the messages. Never lost, unlike a message.
struct LogOrder {
  enum class Kind { kStart, kStop, kSplit, kLatched, kQuit };
  Kind kind{};
  std::uint64_t position{};       ///< in the queue: carried out before what was queued later
  std::uint64_t session{};        ///< kStart: number of this recording
  std::unique_ptr<LogName> name;  ///< kStart: first file
  std::string directory;          ///< kStart
  const LogTopic* topic{};        ///< kLatched
  ros::Time time;                 ///< kLatched: record time
  std::vector<std::uint8_t> bytes;  ///< kLatched: serialised message
};

/// What the writing thread has done so far.
struct LogStatus {
  LogState state{LogState::kOff};
  std::string reason;             ///< why the log stopped by itself; empty otherwise
  std::string file;               ///< current or last bag
  std::uint64_t file_size{};      ///< of it, without the open chunk [byte]
  std::uint64_t bytes_written{};  ///< all bags of this process together [byte]
  std::uint64_t files_closed{};   ///< complete bags under their final names
  std::uint64_t files_deleted{};  ///< oldest bags deleted for log_total_mb
};

/// Only the constructor, the destructor, post() and the const methods are for other threads.
class LogWriter {
 public:
  LogWriter(const LogSettings& settings, const LogDisk& disk, LogQueue& queue);
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  /// Carries out all orders, writes all messages, closes the file.
  ~LogWriter();

  /// False if too many orders wait already.
  bool post(LogOrder order);
  LogStatus status() const;
  /// Session that stopped by itself last.
  std::uint64_t faultySession() const noexcept { return faulty_session_.load(std::memory_order_acquire); }

 private:
  using Clock = LogFile::Clock;
  struct Latched {
    const LogTopic* topic;
    ros::Time time;
    std::vector<std::uint8_t> bytes;
  };
  struct ClosedFile {
    std::string path;
    std::uint64_t size;
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
  void latch(LogOrder& order);
  void repeatLatched(const ros::Time& time);
  void deleteOldest();
  void stopFor(const LogFault& fault);
  void report(LogState state, const std::string& reason);

  const LogSettings settings_;
  const LogDisk disk_;
  LogQueue& queue_;

  // The writing thread's own.
  std::unique_ptr<LogFile> file_;
  std::string directory_;
  std::uint64_t session_{};
  unsigned next_number_{};
  bool quit_{};
  bool repeat_{};  // latched messages still to be repeated in this file
  Clock::time_point opened_{};
  Clock::time_point next_check_{};
  ros::Time last_time_{ros::TIME_MIN};
  std::vector<Latched> latched_;
  std::deque<ClosedFile> closed_;
  std::uint64_t closed_size_{};

  std::atomic<std::uint64_t> faulty_session_{};
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<LogOrder> orders_;  // guarded by mutex_
  LogStatus status_;             // guarded by mutex_
  std::thread thread_;           // last: starts when all else is there
};

}  // namespace hammer_loads
