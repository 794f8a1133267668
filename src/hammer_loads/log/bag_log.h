/// Log of a node in bags, and the record times of the node's inputs. The log takes messages without waiting for the
/// disk and recovers from disk faults.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "hammer_loads/log/log_queue.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/log/log_status.h"
#include "hammer_loads/log/log_writer.h"

namespace hammer_loads {

/// Log of a node in bags; doc/log.md states the guarantees. health() may be called from any thread. All other functions
/// must be called from one thread at a time.
class BagLog {
 public:
  /// Prepares a log. The caller must check LogSettings::enabled.
  explicit BagLog(const LogSettings& settings, const LogDisk& disk = {});
  /// Writes the queued messages and closes the bag; waits for the disk.
  ~BagLog() { stop(); }

  /// Returns the reasons why these settings can never work, one line each (key, value, rule). The node must not start
  /// with them. Creates a missing directory under the conditions of findLogDirectory().
  std::vector<std::string> settingProblems() const;
  /// Begins a bag. Returns one line per reason against it: faulty settings, or the state of disk and memory. health()
  /// also reports the latter. The result is empty on success. The node may start in any case.
  std::vector<std::string> start();
  /// Closes the bag after the last message. It returns at once; health() reports when the bag is closed and whether
  /// that succeeded.
  void stop();
  /// Continues in a new bag; returns false if there is none to split.
  bool split();

  /// Queues a copy for the disk if the log is recording. A message without room in the queue is dropped and counted.
  /// topic: resolved name. time: record time of RecordClock; an output gets the time of the input that caused it.
  template <typename Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message);

  /// Writes a message like write() and repeats it at the start of every later bag, even if the log is not recording
  /// now. caller: publishing node, if several nodes latch on one topic (/tf_static); one message of each node is kept.
  template <typename Message>
  void writeLatched(const std::string& topic, const ros::Time& time, const Message& message,
                    const std::string& caller = {});
  /// Forgets the message latched on that topic by that caller; later bags begin without it.
  void forgetLatched(const std::string& topic, const std::string& caller = {});

  /// Returns true if a full disk stopped the log, or prevented its start, and it may start() again. This needs 16 MB of
  /// free space beyond log_min_free_mb. Returns false after stop().
  bool hasRoomAgain() const;

  /// Returns one line for each unclosed bag of earlier runs with this prefix, with the command that recovers it.
  std::vector<std::string> unfinishedBags() const;

  /// Returns true if the settings include this class of outputs, or the inputs, in the log. The caller must check this.
  bool logs(LoggedOutputs outputs) const noexcept { return outputs <= settings_.outputs; }
  bool logsInputs() const noexcept { return settings_.inputs; }

  bool isRecording() const noexcept { return session_ != 0 && writer_.faultySession() != session_; }
  LogHealth health() const;

 private:
  void beginIn(const std::string& directory, std::uint64_t session);
  static std::string latchedKey(const std::string& topic, const std::string& caller) { return topic + '\n' + caller; }
  LogTopic& addTopic(const std::string& key, BagWriter::Connection connection);
  void lose(LogTopic& topic, const ros::Time& time);
  bool reportGap(const ros::Time& time, bool always);

  template <typename Message>
  LogTopic& topicOf(const std::string& key, const std::string& topic, const Message& message, bool latched = false,
                    const std::string& caller = {}) {
    const auto known = by_key_.find(key);
    return known != by_key_.end() ? *known->second
                                  : addTopic(key, BagWriter::connectionOf(topic, message, latched, caller));
  }
  template <typename Message>
  static std::vector<std::uint8_t> bytesOf(const Message& message) {
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    return bytes;
  }

  const LogSettings settings_;
  const std::string gap_name_;
  const LogDisk disk_;
  std::uint64_t session_{};  // number of the current recording; 0: none was started
  std::uint64_t last_session_{};
  bool is_wanted_{};                 // true after start(), false after stop()
  mutable std::mutex topics_mutex_;  // guards additions, and reads by other threads
  std::deque<LogTopic> topics_;
  std::unordered_map<std::string, LogTopic*> by_key_;  // topics by name, or by latchedKey()
  std::map<std::string, std::uint64_t> gap_;           // lost messages that no bag reports yet, by topic
  ros::Time gap_time_;                                 // record time of the last lost message
  LogQueue queue_;
  LogWriter writer_;  // declared last: its thread uses the other members
};

template <typename Message>
void BagLog::write(const std::string& topic, const ros::Time& time, const Message& message) {
  constexpr double kMuchRoom = 0.5;  // largest fill for a report; above it, the next message would be lost as well
  if (!isRecording()) return;
  if (!gap_.empty() && queue_.fill() <= kMuchRoom) reportGap(time, false);
  LogTopic& entry = topicOf(topic, topic, message);
  const std::uint32_t size = ros::serialization::serializationLength(message);
  const bool is_of_its_type = entry.connection.md5sum == ros::message_traits::md5sum(message);
  std::uint8_t* bytes = is_of_its_type ? queue_.reserve(size) : nullptr;
  if (bytes == nullptr) {
    if (!queue_.canEverHold(size)) entry.too_large.fetch_add(1, std::memory_order_relaxed);
    return lose(entry, time);
  }
  ros::serialization::OStream stream(bytes, size);
  ros::serialization::serialize(stream, message);
  queue_.commit(entry, time);
}

template <typename Message>
void BagLog::writeLatched(const std::string& topic, const ros::Time& time, const Message& message,
                          const std::string& caller) {
  LogTopic& entry = topicOf(latchedKey(topic, caller), topic, message, true, caller);
  if (writer_.latch({&entry, time, bytesOf(message)})) return;
  lose(entry, time);
  writer_.forget(entry);  // earlier latched messages are no longer valid
}

/// Clock of record times. They are arrival times made strictly increasing, so that a log in time order is in the order
/// of arrival. If simulated time runs back (a looped bag, a restarted simulation), the clock restarts. A wall clock
/// that is set back has no effect, because computations use only header stamps.
class RecordClock {
 public:
  struct Tick {
    ros::Time time;   ///< record time of the input: its arrival, but at least 1 ns after the previous input
    bool ran_back{};  ///< simulated time ran back: all state that depends on time must be discarded
  };

  Tick next(const ros::Time& arrival) {
    const bool ran_back = arrival < last_arrival_ && ros::Time::isSimTime();
    const std::uint64_t earliest = ran_back ? ros::TIME_MIN.toNSec() : last_.toNSec() + 1;
    last_arrival_ = arrival;
    last_.fromNSec(std::min(std::max(arrival.toNSec(), earliest), ros::TIME_MAX.toNSec()));
    return {last_, ran_back};
  }
  /// Returns the record time of the last input.
  const ros::Time& last() const { return last_; }

 private:
  ros::Time last_arrival_, last_;
};

}  // namespace hammer_loads
