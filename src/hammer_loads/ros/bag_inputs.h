/// Recorded bags as one input: the splits of a recording, in record order.
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// What the bags hold under one name.
struct BagTopic {
  std::set<std::string> types;        ///< as `sensor_msgs/JointState`
  std::set<std::string> definitions;  ///< MD5 sums of the types
  std::set<std::string> publishers;   ///< names of the nodes; empty where the bag does not say
};

/// Name of a message's type.
template <typename Message>
std::string typeOf() {
  return ros::message_traits::datatype<Message>();
}

/// Throws std::runtime_error where it is damaged or of another definition.
template <typename Message>
boost::shared_ptr<Message> messageOf(const rosbag::MessageInstance& item) {
  std::string reason = "of another definition";
  try {
    if (const auto message = item.instantiate<Message>()) return message;
  } catch (const rosbag::BagException& error) {
    reason = error.what();
  }
  throw std::runtime_error("a message on " + item.getTopic() + " cannot be read: " + reason);
}

class BagInputs {
 public:
  /// Opens every bag; why that could not be, one line each.
  static Checked<BagInputs> open(const std::vector<std::string>& files);

  const std::map<std::string, BagTopic>& topics() const { return topics_; }
  bool has(const std::string& topic) const { return topics_.count(topic) != 0; }
  /// Names and types of the topics, in one line.
  std::string topicList() const;
  /// Names of the topics of this type, in one line; "none" if there are none.
  std::string topicsOfType(const std::string& type) const;
  /// The files' names, in one line.
  const std::string& names() const { return names_; }
  /// Adds what the query takes of every bag to a view.
  void addTo(rosbag::View& view, const boost::function<bool(const rosbag::ConnectionInfo*)>& query) const;

 private:
  void addTopics(const rosbag::Bag& bag);

  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::map<std::string, BagTopic> topics_;
  std::string names_;
};

}  // namespace hammer_loads
