/// Writing a bag whose last byte is known to have arrived.
#pragma once

#include <ros/message_traits.h>
#include <rosbag/bag.h>

#include <memory>
#include <string>
#include <vector>

namespace hammer_loads {

/// A bag that is being written. rosbag's destructor closes the file and ends the process where that fails (full disk):
/// a bag that was not closed well is therefore kept until the process ends.
class BagOutput {
 public:
  BagOutput();
  BagOutput(const BagOutput&) = delete;
  BagOutput& operator=(const BagOutput&) = delete;
  ~BagOutput();

  /// Throws std::exception where the file cannot be written.
  void open(const std::string& file);
  rosbag::Bag& bag() { return *bag_; }
  /// Throws std::exception if anything has not been written.
  void close();

 private:
  std::unique_ptr<rosbag::Bag> bag_;
};

/// Why an existing file must stay; empty: it is a bag of this package's outputs and of nothing else, as process_bag
/// writes it. A recording of inputs is none, a node's log neither.
std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics);

/// As a latched publisher's message: rosbag play keeps it for late subscribers.
template <typename Message>
void writeLatched(rosbag::Bag& bag, const std::string& topic, const ros::Time& time, const Message& message) {
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["latching"] = "1";
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  bag.write(topic, time, message, header);
}

}  // namespace hammer_loads
