/// One bag on disk: readable after every chunk, closed properly on a full disk, and without errors that end the
/// process.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/log/log_directory.h"
#include "hammer_loads/log/log_name.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"
#include "hammer_loads/log/log_topic.h"

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

}  // namespace hammer_loads
