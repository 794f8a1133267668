#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/calibration/report.h"
#include "hammer_loads/commands/calibrate.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/pipeline/filter_settings.h"
#include "hammer_loads/pipeline/hull_state.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads {
namespace {

struct CrankBag {
  std::string problem;  ///< one line why it could not be read
  std::vector<calibration::RecordedSample> samples;
  bool pitch_known{};  ///< every pitch joint was heard
  bool whole{};        ///< all of it was read
};

using calibration::RecordedSample;

constexpr double kAhead = 2.0;  // [s] before a piece: joint states show the pitch before the first crank sample

/// Part of a recording that is read: pieces, each in the middle of an equal part of it, or all of it.
class Pieces {
 public:
  static constexpr double kLength = 20.0;  // [s]: some eighty blows, so that neighbours are neighbours

  Pieces(const std::pair<ros::Time, ros::Time>& span, std::size_t count)
      : first_(span.first), part_((span.second - span.first).toSec() / static_cast<double>(count)), count_(count) {}

  /// Reads all of a recording if the gaps between its pieces would be shorter than half a piece.
  bool areWhole() const { return part_ < 1.5 * kLength; }
  /// Returns true if a piece, begun this much earlier [s], has a part of the time from `from` to `to`.
  bool touch(const ros::Time& from, const ros::Time& to, double earlier) const {
    if (areWhole()) return true;
    const double begin = (from - first_).toSec(), end = (to - first_).toSec();
    for (std::size_t i = 0; i < count_; ++i) {
      const double middle = (static_cast<double>(i) + 0.5) * part_;
      if (begin < middle + 0.5 * kLength && end >= middle - 0.5 * kLength - earlier) return true;
    }
    return false;
  }

 private:
  ros::Time first_;
  double part_;  ///< [s]
  std::size_t count_;
};

/// In record order; time is the header stamp less that of the first message. A recording that is not much longer than
/// the pieces together is read completely. Topics and joints as in the settings.
CrankBag readCrankBag(const BagInputs& inputs, const Settings& settings, std::size_t count, const Progress& progress) {
  CrankBag result;
  const std::string &crank = settings.input_topics.crank, &joints = settings.input_topics.joint_states;
  const std::string& crank_joint = settings.pipeline.crank_joint;
  const auto refuse = [&](const std::string& why) {
    result.problem = inputs.names() + ": " + why;
    return result;
  };
  if (!inputs.has(crank)) return refuse("no topic " + crank + ", is required; topics there: " + inputs.topicList());
  const Pieces pieces(inputs.span(crank), count);
  result.whole = pieces.areWhole();
  HullGravity weight(settings.pipeline, settings.boom);
  std::optional<ros::Time> first;
  const auto take = [&](const sensor_msgs::JointState& message) {
    const auto found = std::find(message.name.begin(), message.name.end(), crank_joint);
    const auto i = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end() || i >= message.position.size()) return;
    if (!first) first = message.header.stamp;
    RecordedSample sample{(message.header.stamp - *first).toSec(), message.position[i], {}, weight.gravity()};
    if (i < message.velocity.size()) sample.speed = message.velocity[i];
    result.samples.push_back(sample);
  };
  sensor_msgs::JointState message;
  std::string wrong_type;
  result.problem = readOrSay(inputs, [&] {
    BagMessages messages = inputs.messages(
        [&](const BagConnection& connection) { return connection.topic == crank || connection.topic == joints; },
        [&](const BagChunk& chunk) { return pieces.touch(chunk.first, chunk.last, kAhead); });
    double done = 0.0;
    while (const BagMessage* item = messages.next()) {
      report(progress, ++done / static_cast<double>(messages.size()));
      const std::string& topic = item->connection->topic;
      if (!item->is<sensor_msgs::JointState>())
        return void(wrong_type = topic + " is of type " + onOneLine(item->connection->type));
      if (!pieces.touch(item->time, item->time, kAhead)) continue;
      item->to(message);
      if (topic == joints) weight.joints(message.name, message.position);
      if (topic == crank && pieces.touch(item->time, item->time, 0.0)) take(message);
    }
  });
  if (!result.problem.empty()) return result;
  if (!wrong_type.empty()) return refuse(wrong_type + ", must be sensor_msgs/JointState");
  if (result.samples.empty()) return refuse("no sample of " + crank_joint + " on " + crank);
  result.pitch_known = weight.pitch().known();
  return result;
}

}  // namespace

/// Pieces of the recording, and more of them until no more are needed.
CalibrationTexts calibrateCrank(const BagInputs& inputs, const Settings& settings, const CalibrateArguments& given) {
  constexpr double kReading = 0.2;  // part of the time of a round
  constexpr double kGain =
      0.8;  // of the deviation: twice the blows leave 0.71 of noise, all of what they have in common
  const calibration::CalibrationBasis basis{settings.mechanism, settings.pipeline.level,
                                            filterSettings(settings.mechanism, settings.pipeline), given.rocker_std};
  CrankBag bag;
  calibration::Calibration found;
  double before = kInfinity;
  for (std::size_t pieces = 6;; pieces *= 2) {
    ProgressBar bar;
    const Progress progress = std::ref(bar);
    bag = readCrankBag(inputs, settings, pieces, piece(progress, 0.0, kReading));
    if (!bag.problem.empty()) return {{bag.problem}, {}, {}, {}};
    found = calibration::calibrate(bag.samples, basis, piece(progress, kReading, 1.0));
    report(progress, 1.0);
    const double worst = found.worstByBlows();
    if (bag.whole || found.isSettled() || worst > kGain * before) break;
    before = worst;
    std::cerr << "note: " << pieces << " pieces of " << Pieces::kLength
              << " s do not suffice, more of the recording is read\n";
  }
  if (!bag.pitch_known && !settings.pipeline.pitch_joints.empty())
    std::cerr << "note: not every pitch joint is on " << settings.input_topics.joint_states
              << ": the hull's pitch is taken as hull_pitch_rad\n";
  CalibrationTexts texts;
  texts.words = (found.problem.empty() ? "" : given.bags.front() + ": ") + textOf(found, given.verbose);
  if (found.problem.empty()) texts.yaml = yamlOf(found, given.source());
  if (!texts.yaml.empty()) texts.picture = svgOf(found);
  return texts;
}

}  // namespace hammer_loads
