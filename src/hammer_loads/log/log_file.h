/// One bag on disk: whole after every chunk, closed properly on a full disk, never the end of the process.
#pragma once

#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/log/log_directory.h"
#include "hammer_loads/log/log_name.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"
#include "hammer_loads/log/log_topic.h"

namespace hammer_loads {

/// Why a log stopped by itself.
struct LogFault {
  LogState state{LogState::kFailed};  ///< kDiskFull or kFailed
  std::string reason;                 ///< one line
};

/// The disk as the log sees it; a test puts a slow or a full one in its place.
struct LogDisk {
  std::function<void()> before_write;  ///< called by the writing thread ahead of every message, if set
  std::function<std::uint64_t(const std::string& directory)> free_space{freeSpace};  ///< [byte]
};

/// Belongs to one thread. After a fault the file is either still open, then it can be closed in order, or given up.
class LogFile {
 public:
  using Clock = std::chrono::steady_clock;
  /// A chunk is closed when its first message is this old: a kill loses no more, plus what waits in the queue [s].
  static constexpr std::chrono::milliseconds kChunkPeriod{500};

  /// Once before the first file, in the thread that sets up the process: keeps rosbag's plugin loaded,
  /// since loading and unloading it beside other threads that do so ends in crashes. Empty or what is wrong.
  static std::string prepare();
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
  std::optional<LogFault> write(const LogTopic& topic, const ros::Time& time, std::uint8_t* bytes, std::uint32_t size,
                                Clock::time_point now);
  /// Closes the open chunk if its time has come.
  std::optional<LogFault> closeChunkInTime(Clock::time_point now);
  /// Index, final name.
  std::optional<LogFault> close();

  std::uint64_t size() const noexcept { return size_; }            ///< on disk without the open chunk [byte]
  std::uint64_t allocated() const noexcept { return allocated_; }  ///< taken on the disk, ahead of the data too [byte]
  /// As it is called now.
  const std::string& path() const noexcept { return is_complete_ ? name_.final() : name_.active(); }
  bool isOpen() const noexcept { return is_open_; }
  bool isComplete() const noexcept { return is_complete_; }  ///< closed with its index, under its final name
  bool isDeleted() const noexcept { return name_.isDeleted(); }

 private:
  struct Connection {
    topic_tools::ShapeShifter message;
    boost::shared_ptr<ros::M_string> header;  // null for a topic that is not latched
  };

  template <typename Action>
  std::optional<LogFault> guarded(Action action) noexcept;
  std::optional<LogFault> reserve(std::uint64_t more) noexcept;
  Connection& connection(const LogTopic& topic);
  void closeChunk();
  void abandon() noexcept;

  LogName name_;
  std::uint32_t chunk_size_;
  LogCompression compression_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::vector<std::unique_ptr<Connection>> connections_;  // by LogTopic::index
  bool is_open_{};
  bool is_complete_{};
  std::uint64_t size_{};
  std::uint64_t size_bound_{};   // size can be no more once all is flushed [byte]
  std::uint64_t index_bound_{};  // the index written by close() can be no more [byte]
  std::uint64_t raw_{};          // since chunks were last closed by time [byte]
  std::uint64_t allocated_{};    // of the file on the disk [byte]
  std::uint64_t held_{};         // kept by rosbag in memory, at most [byte]
  std::optional<Clock::time_point> chunk_due_;
};

}  // namespace hammer_loads
