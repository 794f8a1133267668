/// Writing a bag that is complete or not there at all.
#pragma once

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace hammer_loads {

/// Removes the unfinished output unless it was given its final name.
class PartialFile {
 public:
  explicit PartialFile(const std::string& final_name)
      : final_name_(final_name), name_(final_name + ".part." + std::to_string(getpid())) {}
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    if (!kept_) std::remove(name_.c_str());
  }
  const std::string& name() const { return name_; }
  bool keep() { return kept_ = std::rename(name_.c_str(), final_name_.c_str()) == 0; }

 private:
  std::string final_name_, name_;
  bool kept_{};
};

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
