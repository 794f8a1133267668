#include "hammer_loads/ros/bag_inputs.h"

#include <hammer_loads/RunInfo.h>
#include <rosbag/exceptions.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kLongest = 10000000;  // [s]; no recording is longer

bool beginsAsBag(const std::string& file) {
  std::string begin(9, '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), 9);
  return begin == "#ROSBAG V";
}

/// Opens a bag. Returns the reason why it cannot be opened; empty on success.
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

/// Returns true if the file is among the first `count` files, under any name.
bool isAmong(const std::vector<std::string>& files, std::size_t count, const std::string& file) {
  std::error_code error;
  return std::any_of(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const std::string& other) { return std::filesystem::equivalent(file, other, error); });
}

bool beginsWith(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// Returns true for an output: a message of this package, loads or motion (geometry_msgs), or the mechanism's joints.
bool isOutput(const std::string& topic, const BagTopic& found, const std::string& prefix) {
  if (!beginsWith(topic, prefix)) return false;
  return std::all_of(found.types.begin(), found.types.end(), [&](const std::string& type) {
    return beginsWith(type, "hammer_loads/") || beginsWith(type, "geometry_msgs/") || topic == prefix + "mechanism";
  });
}

}  // namespace

BagMessages::BagMessages(const std::vector<std::unique_ptr<BagFile>>& bags, const BagQuery& query,
                         const ChunkQuery& chunks) {
  for (const auto& bag : bags) {
    Source source{bag.get(), {}};
    for (const auto& [id, connection] : bag->connections()) {
      if (query(connection)) source.wanted.emplace(id, &connection);
    }
    for (const BagChunk& chunk : bag->chunks()) {
      if (chunks && !chunks(chunk)) continue;
      std::uint64_t count = 0;
      for (const auto& [id, messages] : chunk.counts) count += source.wanted.count(id) * messages;
      if (count > 0) places_.push_back({&chunk, sources_.size()});
      size_ += count;
    }
    sources_.push_back(std::move(source));
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.chunk->first, a.source, a.chunk->position) <
           std::tie(b.chunk->first, b.source, b.chunk->position);
  });
}

bool BagMessages::isLater(const std::unique_ptr<OpenChunk>& a, const std::unique_ptr<OpenChunk>& b) {
  return std::tie(a->message().time, a->place) > std::tie(b->message().time, b->place);
}

void BagMessages::open(std::size_t place) {
  if (spare_.empty()) spare_.push_back(std::make_unique<OpenChunk>());
  std::unique_ptr<OpenChunk> chunk = std::move(spare_.back());
  spare_.pop_back();
  const Source& source = sources_[places_[place].source];
  source.bag->read(*places_[place].chunk, source.wanted, chunk->read);
  chunk->place = place;
  chunk->at = 0;
  if (chunk->read.messages.empty()) return spare_.push_back(std::move(chunk));
  open_.push_back(std::move(chunk));
  std::push_heap(open_.begin(), open_.end(), isLater);
}

void BagMessages::passMessage() {
  std::pop_heap(open_.begin(), open_.end(), isLater);
  if (++open_.back()->at < open_.back()->read.messages.size())
    return std::push_heap(open_.begin(), open_.end(), isLater);
  spare_.push_back(std::move(open_.back()));
  open_.pop_back();
}

const BagMessage* BagMessages::next() {
  if (given_) passMessage();
  given_ = false;
  while (next_place_ < places_.size() &&
         (open_.empty() || places_[next_place_].chunk->first <= open_.front()->message().time))
    open(next_place_++);
  if (open_.empty()) return nullptr;
  given_ = true;
  return &open_.front()->message();
}

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
  std::vector<std::string> list;
  for (const auto& [name, topic] : topics_)
    list.push_back(onOneLine(name) + " (" + onOneLine(*topic.types.begin()) + ")");
  return list.empty() ? "none" : joined(list);
}

std::string BagInputs::topicsOfType(const std::string& type) const {
  std::vector<std::string> list;
  for (const auto& [name, topic] : topics_)
    if (topic.types.count(type) != 0) list.push_back(onOneLine(name));
  return list.empty() ? "none" : joined(list);
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

std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics) {
  const Checked<BagInputs> bag = BagInputs::open({file});
  if (!bag.value) return "it is no readable bag of this package";
  std::vector<std::string> prefixes;
  for (const auto& [name, topic] : bag.value->topics()) {
    const std::size_t slash = name.rfind('/');
    const bool run_info = topic.types.count(ros::message_traits::datatype<RunInfo>()) != 0;
    if (run_info && slash != std::string::npos && slash > 0) prefixes.push_back(name.substr(0, slash + 1));
  }
  for (const auto& [name, topic] : bag.value->topics()) {
    const bool ours = std::any_of(prefixes.begin(), prefixes.end(), [&, &name = name, &topic = topic](const auto& p) {
      return isOutput(name, topic, p);
    });
    if (!ours) return "it holds " + name + ", which is no output of this package";
    if (std::count(input_topics.begin(), input_topics.end(), name) != 0) return "it holds " + name + ", an input";
  }
  return prefixes.empty() ? "it is no bag of this package: it holds no run_info" : "";
}

}  // namespace hammer_loads
