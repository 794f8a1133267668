/// One topic of the log: its message type and what became of its messages.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace hammer_loads {

/// What a bag must know about a message type, from ros::message_traits.
struct LogType {
  std::string datatype;    ///< e.g. geometry_msgs/WrenchStamped
  std::string md5sum;      ///< 32 hexadecimal digits
  std::string definition;  ///< full text with the definitions of all parts
};

/// Registered once, lives as long as the log. Counters are written by one thread each and read by any.
struct LogTopic {
  std::size_t index{};  ///< order of registration
  std::string name;     ///< resolved topic name
  LogType type;
  bool latched{};                         ///< last message repeated at the start of every file
  std::string caller;                     ///< node that published it; empty if of no interest
  std::atomic<std::uint64_t> written{};   ///< messages handed to the bag, repeats not counted
  std::atomic<std::uint64_t> full{};      ///< messages lost because the queue was full
  std::atomic<std::uint64_t> unsaved{};   ///< messages lost because the log stopped before their turn came
};

}  // namespace hammer_loads
