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

/// Part of a recording that is read: pieces of `length`, evenly spread over it, or all of it.
struct ReadPieces {
  std::size_t count{6};
  double length{20.0};  ///< [s]: some eighty blows, so that neighbours are neighbours
  /// Twice as many.
  ReadPieces more() const { return {2 * count, length}; }
};

struct CrankBag {
  std::string problem;  ///< one line why it could not be read
  std::vector<calibration::RecordedSample> samples;
  bool pitch_known{};  ///< every pitch joint was heard
  bool whole{};        ///< all of it was read
};

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

/// In record order; time is the header stamp less that of the first message. A recording that is not much longer than
/// the pieces together is read completely. Topics and joints as in the settings.
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

calibration::Globals inForce(const CrankSensor& sensor) {
  const CrankSensorPlace& p = sensor.place();
  calibration::Globals g = calibration::Globals::Zero();
  g[calibration::kZero] = p.zero * sensor.gain();
  g.segment<2>(calibration::kSine1) << p.eccentricity[0] * std::cos(p.eccentricity_phase[0]),
      p.eccentricity[0] * std::sin(p.eccentricity_phase[0]);
  g.segment<2>(calibration::kSine2) << p.eccentricity[1] * std::cos(p.eccentricity_phase[1]),
      p.eccentricity[1] * std::sin(p.eccentricity_phase[1]);
  return g;
}

calibration::CalibrationBasis basisOf(const Settings& settings, double rocker_std) {
  const PipelineSettings& pipeline = settings.pipeline;
  return {settings.mechanism,
          pipeline.level,
          filterSettings(settings.mechanism, pipeline),
          pipeline.crank_sensor.place().ratio,
          rocker_std,
          inForce(pipeline.crank_sensor)};
}

/// Pieces of the recording, and more of them until no more are needed.
calibration::Calibration calibrated(const BagInputs& inputs, const Settings& settings, double rocker_std,
                                    CrankBag& bag) {
  constexpr double kReading = 0.2;  // part of the time of a round
  constexpr double kGain =
      0.8;  // of the deviation: twice the blows leave 0.71 of noise, all of what they have in common
  double before = kInfinity;
  for (ReadPieces pieces;; pieces = pieces.more()) {
    ProgressBar bar;
    const Progress progress = std::ref(bar);
    bag = readCrankBag(inputs, settings, pieces, piece(progress, 0.0, kReading));
    if (!bag.problem.empty()) return {};
    calibration::Calibration found =
        calibration::calibrate(bag.samples, basisOf(settings, rocker_std), piece(progress, kReading, 1.0));
    report(progress, 1.0);
    const double worst = found.worstByBlows();
    if (bag.whole || found.isSettled() || worst > kGain * before) return found;
    before = worst;
    std::cerr << "note: " << pieces.count << " pieces of " << pieces.length
              << " s do not suffice, more of the recording is read\n";
  }
}

}  // namespace

CalibrationTexts calibrateCrank(const BagInputs& inputs, const Settings& settings, const CrankCalibrationJob& job,
                                const std::string& source) {
  CalibrationTexts result;
  CrankBag bag;
  const calibration::Calibration found = calibrated(inputs, settings, job.rocker_std, bag);
  if (!bag.problem.empty()) {
    result.problems = {bag.problem};
    return result;
  }
  if (!bag.pitch_known && !settings.pipeline.pitch_joints.empty())
    std::cerr << "note: not every pitch joint is on " << settings.input_topics.joint_states
              << ": the hull's pitch is taken as hull_pitch_rad\n";
  result.words = (found.problem.empty() ? "" : job.recording + ": ") + textOf(found, job.verbose);
  if (found.problem.empty()) result.yaml = yamlOf(found, source);
  if (!result.yaml.empty()) result.picture = svgOf(found);
  return result;
}

}  // namespace hammer_loads
