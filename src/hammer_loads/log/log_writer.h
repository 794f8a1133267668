/// The thread that writes messages from the queue to the disk, and the bag that it writes: readable after every chunk,
/// closed properly on a full disk, and without errors that end the process.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/log/log_directory.h"
#include "hammer_loads/log/log_queue.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"

namespace hammer_loads {

/// Cause of a log that stopped by itself.
struct LogFault {
  LogState state{LogState::kFailed};  ///< kDiskFull or kFailed
  std::string reason;                 ///< one line
};

/// Interface to the disk; a test replaces it by a slow or a full one.
struct LogDisk {
  std::function<void()> before_write;  ///< called by the writing thread ahead of every message, if set
  std::function<std::uint64_t(const std::string& directory)> free_space{freeSpace};  ///< [byte]
};

/// For use by one thread. After a fault the file is either open and can be closed properly, or given up.
class LogFile {
 public:
  using Clock = std::chrono::steady_clock;
  /// Age of a chunk's first message at which the chunk is closed; a kill loses this and the queue [s].
  static constexpr std::chrono::milliseconds kChunkPeriod{500};

  /// Disk space is taken in steps of this size ahead of the data [byte].
  static constexpr std::uint64_t kAllocationStep = 4'000'000;
  /// The disk has room for the first step. free: counts where the file system cannot take space ahead [byte].
  static bool hasRoomFor(const LogName& name, std::uint64_t free) noexcept;

  /// chunk_size: a chunk is closed at the latest with this many bytes before compression.
  LogFile(LogName name, std::uint32_t chunk_size, LogCompression compression);
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  ~LogFile();

  std::optional<LogFault> open();
  std::optional<LogFault> write(const LogTopic& topic, const ros::Time& time, const std::uint8_t* bytes,
                                std::uint32_t size, Clock::time_point now);
  /// Closes the open chunk if its time has come.
  std::optional<LogFault> closeChunkInTime(Clock::time_point now);
  /// Index, final name.
  std::optional<LogFault> close();

  std::uint64_t size() const noexcept {
    return bag_ ? bag_->size() : size_;
  }                                                                ///< on disk without the open chunk [byte]
  std::uint64_t allocated() const noexcept { return allocated_; }  ///< taken on the disk, ahead of the data too [byte]
  /// Current path of the file.
  const std::string& path() const noexcept { return is_complete_ ? name_.final() : name_.active(); }
  bool isOpen() const noexcept { return bag_.has_value(); }
  bool isComplete() const noexcept { return is_complete_; }  ///< closed with its index, under its final name
  bool isDeleted() const noexcept { return name_.isDeleted(); }

 private:
  template <typename Action>
  std::optional<LogFault> guarded(Action action) noexcept;
  std::optional<LogFault> reserve(std::uint64_t more) noexcept;
  std::uint32_t connection(const LogTopic& topic);

  LogName name_;
  std::uint32_t chunk_size_;
  LogCompression compression_;
  std::optional<BagWriter> bag_;                           // while it is open
  std::vector<std::optional<std::uint32_t>> connections_;  // by LogTopic::index
  bool is_complete_{};
  std::uint64_t size_{};       // after close() [byte]
  std::uint64_t allocated_{};  // of the file on the disk [byte]
  std::optional<Clock::time_point> chunk_due_;
};

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
  bool write(const LogTopic& topic, const ros::Time& time, const std::vector<std::uint8_t>& bytes);
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
