/// One topic of the log: its message type and the counters of its messages.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace hammer_loads {

/// The properties of a message type that a bag needs: from ros::message_traits, which keeps the texts for ever.
struct LogType {
  const char* datatype;    ///< e.g. geometry_msgs/WrenchStamped
  const char* md5sum;      ///< 32 hexadecimal digits
  const char* definition;  ///< full text with the definitions of all parts
};

/// Lives as long as the log. Each counter is written by one thread and read by any.
struct LogTopic {
  LogTopic(std::size_t index_, std::string name_, const LogType& type_, bool latched_, std::string caller_)
      : index(index_), name(std::move(name_)), type(type_), latched(latched_), caller(std::move(caller_)) {}

  const std::size_t index;  ///< order of first appearance
  const std::string name;
  const LogType type;
  const bool latched;                      ///< last message repeated at the start of every file
  const std::string caller;                ///< node that published it; empty: of no interest
  std::atomic<std::uint64_t> written{};    ///< messages handed to a bag; repeats are not counted
  std::atomic<std::uint64_t> refused{};    ///< messages lost because the queue was full or the type was another
  std::atomic<std::uint64_t> too_large{};  ///< part of them that never fits into the queue
  std::atomic<std::uint64_t> unsaved{};    ///< messages lost in the queue because the log stopped for a fault
  std::uint64_t noted{};                   ///< part of `refused` that a bag already reports; producing thread only
};

}  // namespace hammer_loads
