/// Fixture that runs process_bag on bags in a temporary directory.
#pragma once

#include <gtest/gtest.h>
#include <hammer_loads/RunInfo.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "support/command.h"

namespace hammer_loads::test {

/// 30 s at 100 Hz with 122 blows.
inline const std::string kSession = std::string(HAMMER_LOADS_TEST_DATA) + "/mo100_100hz.bag";

class BagFiles : public testing::Test {
 protected:
  BagFiles() {
    std::string name = testing::TempDir() + "bag_files_XXXXXX";
    directory_ = mkdtemp(name.data());
  }
  ~BagFiles() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string copy(const std::string& from, const std::string& name) const {
    std::filesystem::copy_file(from, path(name));
    return path(name);
  }
  /// Runs process_bag; each argument is a file or an option.
  static Outcome run(const std::string& arguments) { return runCommand(HAMMER_LOADS_PROCESS_BAG, arguments); }
  /// Returns the names in the directory, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory_))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  /// Expects exit code 1 and one line on stderr with these words.
  static void expectRefused(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }

  std::filesystem::path directory_;
};

/// Passes every message of the session to `take`.
inline void forEachOfSession(const std::function<void(const rosbag::MessageInstance&)>& take) {
  rosbag::Bag bag(kSession);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) take(item);
}

/// Writes a message as it is recorded from a node.
template <typename Message>
void writeFrom(rosbag::Bag& bag, const std::string& node, const std::string& topic, const ros::Time& time,
               const Message& message) {
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["callerid"] = node;
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  bag.write(topic, time, message, header);
}

/// Returns everything in a bag except run_info, in record order: topic, record time [ns], content.
inline std::vector<std::string> contentOfBag(const std::string& path) {
  std::vector<std::string> content;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    if (item.getDataType() == "hammer_loads/RunInfo") continue;
    std::string bytes(item.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), item.size());
    item.write(stream);
    content.push_back(item.getTopic() + " " + std::to_string(item.getTime().toNSec()) + " " + bytes);
  }
  std::sort(content.begin(), content.end());
  return content;
}

}  // namespace hammer_loads::test
