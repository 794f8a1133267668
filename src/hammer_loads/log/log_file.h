/// Bag file of the log: readable after every chunk, closed properly on a full disk, with a unique name.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"

namespace hammer_loads {

/// Fault for which the log stops by itself; what() is one line.
struct LogFault : std::runtime_error {
  LogFault(LogState state_, const std::string& reason) : std::runtime_error(reason), state(state_) {}
  LogState state;  ///< kDiskFull or kFailed
};

/// Topic of the log. It lives as long as the log. Each counter is written by one thread and read by any.
struct LogTopic {
  LogTopic(std::size_t index_, BagWriter::Connection connection_) : index(index_), connection(std::move(connection_)) {}

  const std::size_t index;  ///< order of first appearance
  /// Connection of the topic. If it is latched, its last message is repeated at the start of every file.
  const BagWriter::Connection connection;
  std::atomic<std::uint64_t> written{};    ///< messages handed to a bag; repeats are not counted
  std::atomic<std::uint64_t> refused{};    ///< messages lost because the queue was full or the type differed
  std::atomic<std::uint64_t> too_large{};  ///< refused ones that can never fit into the queue
  std::atomic<std::uint64_t> unsaved{};    ///< messages lost in the queue after a fault of the log
};

/// Bag file for use by one thread. Every function throws LogFault if the disk fails. The bag is then either open and
/// can be closed properly, or given up.
class LogFile {
 public:
  using Clock = std::chrono::steady_clock;
  /// Age of a chunk's first message at which the chunk is closed [ms]. A kill loses this period and the queue.
  static constexpr std::chrono::milliseconds kChunkPeriod{500};
  /// Step in which disk space is allocated ahead of the data [byte].
  static constexpr std::uint64_t kAllocationStep = 4'000'000;

  /// Reserves the name PREFIX_YYYY-MM-DD-HH-MM-SS_N.bag (local time) with a new empty file PREFIX_..._N.bag.active. No
  /// existing file is overwritten. The file is locked (flock) during the life of the result, so that other processes
  /// see that it is in use. The settings must outlive the result. number: N of the first try.
  static std::shared_ptr<LogFile> create(const LogSettings& settings, const std::string& directory,
                                         unsigned number = 0);
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  /// Removes the file if nothing was written to it. A bag that was not closed stays as it is.
  ~LogFile();
  /// Reserves the name of the next bag.
  std::shared_ptr<LogFile> next() const { return create(settings_, directory_, number_ + 1); }

  /// Returns true if the disk has room for the first step. free: used if the file system cannot allocate ahead [byte].
  bool hasRoom(std::uint64_t free) const noexcept;
  void open();
  void write(const LogTopic& topic, const ros::Time& time, const std::uint8_t* bytes, std::uint32_t size,
             Clock::time_point now);
  /// Closes the open chunk if its first message is older than kChunkPeriod.
  void closeChunkInTime(Clock::time_point now);
  /// Writes the index and gives the file its final name, or a variant of it if that name is taken by now.
  void close();

  std::uint64_t size() const noexcept { return bag_ ? bag_->size() : size_; }  ///< without the open chunk [byte]
  std::uint64_t allocated() const noexcept { return allocated_; }  ///< on disk, with space ahead of the data [byte]
  const std::string& directory() const noexcept { return directory_; }
  /// Returns the current path of the file.
  const std::string& path() const noexcept { return is_complete_ ? final_ : active_; }
  bool isOpen() const noexcept { return bag_.has_value(); }
  bool isComplete() const noexcept { return is_complete_; }  ///< closed with its index, under its final name
  bool isDeleted() const noexcept;

 private:
  LogFile(const LogSettings& settings, const std::string& directory) : settings_(settings), directory_(directory) {}

  template <typename Action>
  void guarded(const Action& action);
  void reserve(std::uint64_t more);
  std::uint32_t connectionOf(const LogTopic& topic);

  const LogSettings& settings_;
  const std::string directory_;
  unsigned number_{};                                      // N of the name
  std::string active_, final_;                             // paths while it is written, and afterwards
  int descriptor_{-1};                                     // of the active file
  std::optional<BagWriter> bag_;                           // present while the bag is open
  std::vector<std::optional<std::uint32_t>> connections_;  // connection numbers by LogTopic::index
  bool is_complete_{};
  std::uint64_t size_{};       // size after close() [byte]
  std::uint64_t allocated_{};  // allocated on the disk for the file [byte]
  std::optional<Clock::time_point> chunk_due_;
};

}  // namespace hammer_loads
