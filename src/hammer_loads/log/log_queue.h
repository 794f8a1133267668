/// Bounded queue of serialised messages from one thread to one other, without locks, allocations or system calls.
#pragma once

#include <ros/time.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

namespace hammer_loads {

struct LogTopic;

/// Ring buffer of bytes. Positions count all bytes ever queued; they only grow and thus order events among records.
///
/// The producing thread calls reserve(), fills in the bytes and calls commit(). The consuming thread calls front() and
/// pop(). A record is contiguous: if it would cross the end of the buffer, the rest of the buffer is skipped.
class LogQueue {
 public:
  /// Message as stored in the buffer.
  struct Record {
    LogTopic* topic;     ///< null: skip to the start of the buffer
    ros::Time time;      ///< record time
    std::uint64_t step;  ///< bytes to the next record
    std::uint32_t size;  ///< size of the message [bytes]

    std::uint8_t* bytes() noexcept { return reinterpret_cast<std::uint8_t*>(this) + sizeof(Record); }
  };

  /// Prepares a queue of `bytes`, rounded down to whole units, at least 8. It has no memory before take().
  explicit LogQueue(std::size_t bytes) : unit_count_(std::max<std::size_t>(bytes / sizeof(Unit), 8)) {}

  /// Allocates and touches all memory; throws std::bad_alloc. The producing thread calls it before reserve().
  void take() {
    if (!units_) units_ = std::make_unique<Unit[]>(unit_count_);
  }

  /// Returns false for a message larger than half the buffer, which never fits.
  bool canEverHold(std::uint32_t size) const noexcept { return roundUp(sizeof(Record) + size) <= capacity() / 2; }

  /// Returns room for a message of `size` bytes, or null if there is none now.
  std::uint8_t* reserve(std::uint32_t size) noexcept {
    if (!canEverHold(size)) return nullptr;
    const std::uint64_t step = roundUp(sizeof(Record) + size);
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    const std::uint64_t to_edge = capacity() - end % capacity();
    const std::uint64_t skip = step > to_edge ? to_edge : 0;
    if (end + skip + step - begin_.load(std::memory_order_acquire) > capacity()) return nullptr;
    if (skip > 0) put(end, Record{nullptr, {}, skip, 0});
    reserved_ = end + skip;
    return put(reserved_, Record{nullptr, {}, step, size})->bytes();
  }

  /// Hands the record reserved last over to the consuming thread.
  void commit(LogTopic& topic, const ros::Time& time) noexcept {
    Record* record = at(reserved_);
    record->topic = &topic;
    record->time = time;
    end_.store(reserved_ + record->step, std::memory_order_release);
  }

  /// Returns the oldest record, or null. It is valid until pop().
  Record* front() noexcept {
    const std::uint64_t end = end_.load(std::memory_order_acquire);
    std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end) return nullptr;
    if (at(begin)->topic == nullptr) {  // a skip is never the last record: it is handed over with the record after it
      begin += at(begin)->step;
      begin_.store(begin, std::memory_order_release);
    }
    return at(begin);
  }

  /// Frees the record that front() returned.
  void pop() noexcept {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    begin_.store(begin + at(begin)->step, std::memory_order_release);
  }

  std::uint64_t begin() const noexcept { return begin_.load(std::memory_order_acquire); }  ///< start of oldest record
  std::uint64_t end() const noexcept { return end_.load(std::memory_order_acquire); }      ///< end of newest record
  std::uint64_t capacity() const noexcept { return unit_count_ * sizeof(Unit); }           ///< [bytes]

  /// Returns the share in use [0..1]. It may be called from any thread.
  double fill() const noexcept {
    const std::uint64_t begin = this->begin();  // read first, so that end() never lies before it
    return std::min(1.0, static_cast<double>(end() - begin) / static_cast<double>(capacity()));
  }

 private:
  struct alignas(32) Unit {
    std::uint8_t bytes[32];
  };
  static_assert(sizeof(Record) <= sizeof(Unit) && alignof(Record) <= alignof(Unit), "a skip must fit into any rest");

  static std::uint64_t roundUp(std::uint64_t size) noexcept {
    return (size + sizeof(Unit) - 1) / sizeof(Unit) * sizeof(Unit);
  }
  Record* at(std::uint64_t position) noexcept {
    return std::launder(reinterpret_cast<Record*>(&units_[(position % capacity()) / sizeof(Unit)]));
  }
  Record* put(std::uint64_t position, const Record& record) noexcept {
    return new (&units_[(position % capacity()) / sizeof(Unit)]) Record(record);
  }

  const std::size_t unit_count_;
  std::unique_ptr<Unit[]> units_;
  std::uint64_t reserved_{};  // used by the producing thread only
  alignas(64) std::atomic<std::uint64_t> begin_{};
  alignas(64) std::atomic<std::uint64_t> end_{};
};

}  // namespace hammer_loads
