#include "hammer_loads/commands/crank_recording_bag.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hammer_loads/pipeline/hull_state.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

using calibration::RecordedSample;

constexpr double kAhead = 2.0;  // [s] before a piece: joint states show the pitch before the first crank sample

class CrankReader {
 public:
  CrankReader(const Settings& settings, CrankBag& result)
      : crank_joint_(settings.pipeline.crank_joint), weight_(settings.pipeline, settings.boom), result_(result) {}

  void joints(const sensor_msgs::JointState& message) {
    weight_.joints(message.name, message.position);
    result_.pitch_known = weight_.pitch().known();
  }
  void crank(const sensor_msgs::JointState& message) {
    const auto found = std::find(message.name.begin(), message.name.end(), crank_joint_);
    const auto i = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end() || i >= message.position.size()) return;
    if (!first_) first_ = message.header.stamp;
    RecordedSample sample;
    sample.time = (message.header.stamp - *first_).toSec();
    sample.reading = message.position[i];
    if (i < message.velocity.size()) sample.speed = message.velocity[i];
    sample.gravity = weight_.gravity();
    result_.samples.push_back(sample);
  }

 private:
  const std::string& crank_joint_;
  HullGravity weight_;
  CrankBag& result_;
  std::optional<ros::Time> first_;
};

/// Pieces of a recording, each in the middle of an equal part of it.
class Pieces {
 public:
  Pieces(const std::pair<ros::Time, ros::Time>& span, const ReadPieces& pieces)
      : first_(span.first),
        part_((span.second - span.first).toSec() / static_cast<double>(pieces.count)),
        pieces_(pieces) {}

  /// Reads all of a recording if the gaps between its pieces would be shorter than half a piece.
  bool areWhole() const { return part_ < 1.5 * pieces_.length; }
  /// Returns true if a piece, begun this much earlier [s], has a part of the time from `from` to `to`.
  bool touch(const ros::Time& from, const ros::Time& to, double earlier) const {
    if (areWhole()) return true;
    const double begin = (from - first_).toSec(), end = (to - first_).toSec();
    for (std::size_t i = 0; i < pieces_.count; ++i) {
      const double middle = (static_cast<double>(i) + 0.5) * part_;
      if (begin < middle + 0.5 * pieces_.length && end >= middle - 0.5 * pieces_.length - earlier) return true;
    }
    return false;
  }

 private:
  ros::Time first_;
  double part_;  ///< [s]
  ReadPieces pieces_;
};

}  // namespace

CrankBag readCrankBag(const BagInputs& inputs, const Settings& settings, const ReadPieces& wanted,
                      const Progress& progress) {
  CrankBag result;
  const std::string &crank = settings.input_topics.crank, &joints = settings.input_topics.joint_states;
  const auto refuse = [&](const std::string& why) {
    result.problem = inputs.names() + ": " + why;
    return result;
  };
  if (!inputs.has(crank)) return refuse("no topic " + crank + ", is required; topics there: " + inputs.topicList());
  const Pieces pieces(inputs.span(crank), wanted);
  result.whole = pieces.areWhole();
  CrankReader reader(settings, result);
  sensor_msgs::JointState message;
  try {
    BagMessages messages = inputs.messages(
        [&](const BagConnection& connection) { return connection.topic == crank || connection.topic == joints; },
        [&](const BagChunk& chunk) { return pieces.touch(chunk.first, chunk.last, kAhead); });
    const auto count = static_cast<double>(messages.size());
    double done = 0.0;
    while (const BagMessage* item = messages.next()) {
      report(progress, ++done / count);
      const std::string& topic = item->connection->topic;
      if (!item->is<sensor_msgs::JointState>())
        return refuse(topic + " is of type " + onOneLine(item->connection->type) + ", must be sensor_msgs/JointState");
      if (!pieces.touch(item->time, item->time, kAhead)) continue;
      item->to(message);
      if (topic == joints) reader.joints(message);
      if (topic == crank && pieces.touch(item->time, item->time, 0.0)) reader.crank(message);
    }
  } catch (const std::exception& error) {
    return refuse(std::string("cannot be read: ") + onOneLine(error.what()));
  }
  if (result.samples.empty()) return refuse("no sample of " + settings.pipeline.crank_joint + " on " + crank);
  return result;
}

}  // namespace hammer_loads
