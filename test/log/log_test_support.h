/// Shared by the log tests: a temporary directory, waiting with a deadline, reading bags back.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads::test {

inline const bool clock_is_ready = (ros::Time::init(), true);

inline constexpr std::chrono::seconds kDeadline{120};

/// Returns true as soon as the condition holds, false at the deadline.
inline bool waitFor(const std::function<bool()>& condition, std::chrono::milliseconds deadline = kDeadline) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

inline geometry_msgs::WrenchStamped wrench(std::size_t i) {
  geometry_msgs::WrenchStamped message;
  message.header.seq = static_cast<std::uint32_t>(i);
  message.header.frame_id = "hammer_hull";
  message.wrench.force.x = 1.1 * static_cast<double>(i);
  message.wrench.torque.y = -0.3 * static_cast<double>(i);
  return message;
}

/// Returns a message that compression cannot shorten.
inline std_msgs::String noise(std::size_t size, std::size_t seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std_msgs::String message;
  message.data.resize(size);
  for (char& c : message.data) c = static_cast<char>(random());
  return message;
}

/// Returns the time of message i; messages are 1 ms apart.
inline ros::Time at(std::size_t i) { return ros::Time(1000.0 + 1e-3 * static_cast<double>(i)); }

/// Sends the i-th message, of 50 kB.
inline void send(BagLog& log, std::size_t i) { log.write("/noise", at(i), noise(50'000, i)); }

/// Sends until the log stops for lack of space; returns false if it does not stop.
inline bool sendUntilFull(BagLog& log) {
  std::size_t sent = 0;
  return waitFor([&] {
           if (log.health().queue_fill < 0.5) send(log, sent++);
           return !log.isRecording();
         }) &&
         waitFor([&] { return log.health().state == LogState::kDiskFull; });
}

/// One message of a bag.
struct Entry {
  std::string topic, caller;
  ros::Time time;
  bool latched{};
  std::vector<std::uint8_t> bytes;

  template <typename Message>
  Message as() const {
    Message message;
    auto copy = bytes;
    ros::serialization::IStream stream(copy.data(), static_cast<std::uint32_t>(copy.size()));
    ros::serialization::deserialize(stream, message);
    return message;
  }
};

/// Returns the i for which the entry is wrench(i).
inline std::size_t number(const Entry& entry) { return entry.as<geometry_msgs::WrenchStamped>().header.seq; }

/// Returns a bag's messages in time order, as every tool reads it. Throws if the bag is not complete.
inline std::vector<Entry> readBag(const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  std::vector<Entry> entries;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    Entry entry{message.getTopic(), message.getCallerId(), message.getTime(), message.isLatching(),
                std::vector<std::uint8_t>(message.size())};
    ros::serialization::OStream stream(entry.bytes.data(), message.size());
    message.write(stream);
    entries.push_back(std::move(entry));
  }
  return entries;
}

inline std::vector<Entry> onTopic(const std::vector<Entry>& entries, const std::string& topic) {
  std::vector<Entry> found;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(found),
               [&topic](const Entry& entry) { return entry.topic == topic; });
  return found;
}

/// Fresh directory for each test, removed afterwards.
class LogTest : public ::testing::Test {
 protected:
  LogTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "hammer_loads_log_XXXXXX").string();
    directory_ = mkdtemp(pattern.data());
    settings_.enabled = true;
    settings_.directory = directory_;
    settings_.prefix = "test";
    settings_.split_size = 100'000'000;
    settings_.queue_size = 16'000'000;
  }
  ~LogTest() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return directory_ + '/' + name; }

  /// Returns the files whose names end so, in order of writing: N in the name counts up.
  std::vector<std::string> files(const std::string& ending = ".bag") const {
    std::vector<std::pair<long, std::string>> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
      const std::string name = entry.path().string();
      if (name.size() < ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
        continue;
      found.emplace_back(std::atol(name.c_str() + name.rfind('_') + 1), name);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::string> names;
    for (const auto& [number, name] : found) names.push_back(name);
    return names;
  }

  /// Returns the messages of all closed bags in sequence.
  std::vector<Entry> readAll() const {
    std::vector<Entry> all;
    for (const std::string& file : files()) {
      const std::vector<Entry> entries = readBag(file);
      all.insert(all.end(), entries.begin(), entries.end());
    }
    return all;
  }

  static void writeFile(const std::string& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string readFile(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string directory_;
  LogSettings settings_;
};

}  // namespace hammer_loads::test
