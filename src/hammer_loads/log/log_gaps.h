/// Report of a bag on the messages that its log lost.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace hammer_loads {

/// Topic of reports on lost messages. A bag with such a report lacks some messages; results computed from it may differ
/// from those published live. Type: diagnostic_msgs/DiagnosticStatus, one value for each topic with the number of its
/// messages lost since the last report.
inline constexpr char kGapTopic[] = "/log/gaps";  // below the node's name

inline bool isGapTopic(const std::string& topic) {
  const std::string end = kGapTopic;
  return topic.size() >= end.size() && topic.compare(topic.size() - end.size(), end.size(), end) == 0;
}

/// Returns the number of lost messages on all topics.
inline std::uint64_t lostMessages(const diagnostic_msgs::DiagnosticStatus& gap) {
  std::uint64_t sum = 0;
  for (const diagnostic_msgs::KeyValue& topic : gap.values) sum += std::strtoull(topic.value.c_str(), nullptr, 10);
  return sum;
}

}  // namespace hammer_loads
