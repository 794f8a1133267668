#include "hammer_loads/ros/bag_inputs.h"

#include <rosbag/exceptions.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kLongest = 10000000;  // [s]: no recording lasts as long

bool beginsAsBag(const std::string& file) {
  constexpr char kMagic[] = "#ROSBAG V";
  char read[sizeof kMagic - 1]{};
  std::ifstream(file, std::ios::binary).read(read, sizeof read);
  return std::memcmp(read, kMagic, sizeof read) == 0;
}

/// Opens a bag. Returns the reason why it cannot be opened; empty if it was.
std::string openProblem(std::unique_ptr<BagFile>& bag, const std::string& file) {
  struct stat found {};
  if (stat(file.c_str(), &found) != 0) return file + ": cannot be read: " + std::strerror(errno);
  if (!S_ISREG(found.st_mode)) return file + ": is no regular file, must be a bag";
  try {
    bag = std::make_unique<BagFile>(file);
    return {};
  } catch (const rosbag::BagUnindexedException&) {
    return file + ": the bag has no index, its recording did not end properly; `rosbag reindex " + file + "` makes one";
  } catch (const std::exception& error) {
    const std::string help = beginsAsBag(file) ? "; it is cut or damaged, `rosbag reindex " + file + "` may help" : "";
    return file + ": cannot be read as a bag: " + onOneLine(error.what()) + help;
  }
}

/// Returns true if a file was opened before, by whatever name.
bool isAmong(const std::vector<std::string>& files, std::size_t count, const std::string& file) {
  struct stat one {
  }, other{};
  if (stat(file.c_str(), &one) != 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (stat(files[i].c_str(), &other) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino) return true;
  }
  return false;
}

}  // namespace

Checked<BagInputs> BagInputs::open(const std::vector<std::string>& files) {
  Checked<BagInputs> result;
  BagInputs inputs;
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::unique_ptr<BagFile> bag;
    const std::string problem =
        isAmong(files, i, files[i]) ? files[i] + ": given twice, must be given once" : openProblem(bag, files[i]);
    if (!problem.empty()) {
      result.problems.push_back(problem);
      continue;
    }
    inputs.addTopics(*bag);
    inputs.bags_.push_back(std::move(bag));
    inputs.names_ += (i == 0 ? "" : ", ") + files[i];
  }
  if (result.problems.empty()) result.value.emplace(std::move(inputs));
  return result;
}

void BagInputs::addTopics(const BagFile& bag) {
  for (const auto& [id, connection] : bag.connections()) {
    BagTopic& topic = topics_[connection.topic];
    topic.types.insert(connection.type);
    topic.definitions.insert(connection.md5sum);
    if (!connection.publisher.empty()) topic.publishers.insert(connection.publisher);
  }
}

std::string BagInputs::topicList() const {
  std::string list;
  for (const auto& [name, topic] : topics_)
    list += (list.empty() ? "" : ", ") + onOneLine(name) + " (" + onOneLine(*topic.types.begin()) + ")";
  return list.empty() ? "none" : list;
}

std::string BagInputs::topicsOfType(const std::string& type) const {
  std::string list;
  for (const auto& [name, topic] : topics_) {
    if (topic.types.count(type) != 0) list += (list.empty() ? "" : ", ") + onOneLine(name);
  }
  return list.empty() ? "none" : list;
}

std::pair<ros::Time, ros::Time> BagInputs::span(const std::string& topic) const {
  std::vector<ros::Time> times;
  ros::Time end;
  for (const auto& bag : bags_) {
    const auto isWanted = [&](const auto& counted) {
      const auto connection = bag->connections().find(counted.first);
      return topic.empty() || (connection != bag->connections().end() && connection->second.topic == topic);
    };
    for (const BagChunk& chunk : bag->chunks()) {
      if (std::none_of(chunk.counts.begin(), chunk.counts.end(), isWanted)) continue;
      times.insert(times.end(), {chunk.first, chunk.last});
      end = std::max(end, chunk.last);
    }
  }
  ros::Time begin = end;
  for (const ros::Time& time : times)
    if (time.sec != 0 || end.sec < kLongest) begin = std::min(begin, time);
  return {begin, end};
}

BagMessages BagInputs::messagesOn(const std::set<std::string>& topics) const {
  return messages([&topics](const BagConnection& connection) { return topics.count(connection.topic) != 0; });
}

}  // namespace hammer_loads
