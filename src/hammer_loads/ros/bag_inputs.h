/// Recorded bags as one input: the splits of a recording, in record order.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/ros/bag_messages.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// A topic of the bags.
struct BagTopic {
  std::set<std::string> types;        ///< types such as `sensor_msgs/JointState`
  std::set<std::string> definitions;  ///< MD5 sums of the types
  std::set<std::string> publishers;   ///< names of the nodes; empty where the bag does not state it
};

/// Name of a message's type.
template <typename Message>
std::string typeOf() {
  return ros::message_traits::datatype<Message>();
}

class BagInputs {
 public:
  /// Opens every bag. Returns one line for each that cannot be opened.
  static Checked<BagInputs> open(const std::vector<std::string>& files);

  const std::map<std::string, BagTopic>& topics() const { return topics_; }
  bool has(const std::string& topic) const { return topics_.count(topic) != 0; }
  /// Names and types of the topics, in one line.
  std::string topicList() const;
  /// Names of the topics of this type, in one line; "none" if there are none.
  std::string topicsOfType(const std::string& type) const;
  /// Record times of the first and last message of the chunks with the topic, or of all chunks for an empty name; zero
  /// if there is none. Messages that were recorded before the first message of /clock have times near 0 and do not
  /// count.
  std::pair<ros::Time, ros::Time> span(const std::string& topic = {}) const;
  /// The files' names, in one line.
  const std::string& names() const { return names_; }
  /// Messages of every bag that the query takes, in record order. One reader at a time.
  BagMessages messages(const BagQuery& query, const ChunkQuery& chunks = {}) const { return {bags_, query, chunks}; }
  BagMessages messagesOn(const std::set<std::string>& topics) const;

 private:
  void addTopics(const BagFile& bag);

  std::vector<std::unique_ptr<BagFile>> bags_;
  std::map<std::string, BagTopic> topics_;
  std::string names_;
};

}  // namespace hammer_loads
