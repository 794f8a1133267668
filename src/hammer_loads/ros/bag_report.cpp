#include "hammer_loads/ros/bag_report.h"

#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstring>

#include "hammer_loads/log/log_gaps.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Returns the MD5 sum of each output's type in this version. run_info is left out: its reader reports differences.
const std::map<std::string, std::string>& definitions() {
  static const std::map<std::string, std::string> known = [] {
    std::map<std::string, std::string> of_type;
    HammerOutputs().forEach([&of_type](const auto& output) {
      using Message = typename std::decay_t<decltype(output)>::Message;
      const bool own = typeOf<Message>().rfind("hammer_loads/", 0) == 0;
      if (own && output.delivery() != Delivery::kLatched)
        of_type[typeOf<Message>()] = ros::message_traits::md5sum<Message>();
    });
    return of_type;
  }();
  return known;
}

/// Returns the joint names in the crank's messages in one line.
std::string jointsOn(const BagInputs& inputs, const std::string& topic) {
  constexpr std::size_t kMost = 20;
  std::set<std::string> names;
  BagMessages messages = inputs.messagesOn({topic});
  sensor_msgs::JointState message;
  while (const BagMessage* item = messages.next()) {
    item->to(message);
    for (const std::string& name : message.name) names.insert(onOneLine(name));
    if (names.size() > kMost) break;
  }
  return names.empty() ? "none" : joined(names);
}

/// Warns of several publishers on one of these topics. Transforms are excepted, since they usually have several.
void warnOfPublishers(const BagInputs& inputs, const std::set<std::string>& topics, std::vector<BagWarning>& warnings) {
  for (const std::string& name : topics) {
    const auto found = inputs.topics().find(name);
    if (found == inputs.topics().end() || found->second.publishers.size() < 2) continue;
    if (found->second.types.count(typeOf<tf2_msgs::TFMessage>()) != 0) continue;  // as usual for transforms
    addOnce(warnings, {"publishers", name + ": several publishers: " + joined(found->second.publishers)});
  }
}

/// Warns of messages that the log of these bags has lost.
void warnOfLostMessages(const BagInputs& inputs, std::vector<BagWarning>& warnings) {
  for (const auto& [name, topic] : inputs.topics()) {
    if (!isGapTopic(name) || topic.types.count(typeOf<diagnostic_msgs::DiagnosticStatus>()) == 0) continue;
    std::uint64_t lost = 0;
    BagMessages messages = inputs.messagesOn({name});
    diagnostic_msgs::DiagnosticStatus gap;
    while (const BagMessage* item = messages.next()) {
      item->to(gap);
      lost += lostMessages(gap);
    }
    if (lost > 0)
      addOnce(warnings, {"lost messages", name + ": the log lost " + std::to_string(lost) +
                                              " messages; where an input is among them, the outputs differ from those "
                                              "of the node"});
  }
}

/// Warns of messages of another version of this package, whose definition differs.
void warnOfDefinitions(const BagInputs& inputs, std::vector<BagWarning>& warnings) {
  std::vector<std::string> others;
  for (const auto& [name, topic] : inputs.topics()) {
    const auto known = definitions().find(*topic.types.begin());
    if (known == definitions().end() || topic.definitions == std::set<std::string>{known->second}) continue;
    others.push_back(onOneLine(name) + " (" + known->first + ")");
  }
  if (!others.empty())
    addOnce(warnings, {"definitions", "messages of another version of this package cannot be read: " + joined(others)});
}

/// Warns of topics that the runs need and that have no message.
void warnOfMissing(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& heard,
                   std::vector<BagWarning>& warnings) {
  for (const BagRun& run : runs) {
    const InputTopics& topics = run.settings.input_topics;
    const PipelineSettings& pipeline = run.settings.pipeline;
    const bool joints = !pipeline.pitch_joints.empty() || run.settings.boom;
    if (joints && heard.count(topics.joint_states) == 0)
      addOnce(warnings, {"joint states", "no message on " + topics.joint_states +
                                             " (--joint-states-topic); topics of its type there: " +
                                             inputs.topicsOfType(typeOf<sensor_msgs::JointState>())});
    if (pipeline.hull_motion == HullMotionSource::kImu && heard.count(topics.hull_imu) == 0)
      addOnce(warnings, {"imu", "hull_motion: imu, but no message on " + topics.hull_imu +
                                    " (--imu-topic): weight by pitch; topics of its type there: " +
                                    inputs.topicsOfType(typeOf<sensor_msgs::Imu>())});
  }
}

}  // namespace

void addOnce(std::vector<std::string>& lines, const std::string& line) {
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
}

void addOnce(std::vector<BagWarning>& warnings, const BagWarning& warning) {
  const bool known = std::any_of(warnings.begin(), warnings.end(), [&](const BagWarning& other) {
    return other.run == warning.run && other.text == warning.text;
  });
  if (!known) warnings.push_back(warning);
}

std::vector<std::string> textsOf(const std::vector<BagWarning>& warnings) {
  std::vector<std::string> texts;
  for (const BagWarning& warning : warnings) addOnce(texts, warning.text);
  return texts;
}

void add(const SampleCounts& counts, SampleCounts& sum) {
  sum.accepted += counts.accepted;
  sum.beside_blow += counts.beside_blow;
  sum.uncertain += counts.uncertain;
  sum.restarts += counts.restarts;
  sum.blows += counts.blows;
  sum.impossible_blows += counts.impossible_blows;
  sum.backward_passes += counts.backward_passes;
  sum.misuse.add(counts.misuse);
  for (std::size_t i = 0; i < counts.refused.size(); ++i) sum.refused[i] += counts.refused[i];
}

std::string textOf(const BagReport& report) {
  constexpr double kMuch = 0.02;  // share of the samples; in a good recording half a per cent are close to a blow
  std::string text;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i) {
    if (report.crank.refused[i] == 0) continue;
    text += std::string("crank samples without a wrench, ") + kRefusalNames[i] + ": " +
            std::to_string(report.crank.refused[i]) + "\n";
  }
  if (static_cast<double>(report.crank.beside_blow) > kMuch * static_cast<double>(report.samples))
    text += "crank samples closer to the blow than the angle is known, not published: " +
            std::to_string(report.crank.beside_blow) + "\n";
  return text;
}

std::string summaryOf(const BagReport& report) {
  std::string text = std::to_string(report.samples) + " crank samples, " + std::to_string(report.wrenches) +
                     " wrenches, " + std::to_string(report.turns) + " turns";
  if (report.runs > 1) text += " in " + std::to_string(report.runs) + " runs";
  if (!report.prefix.empty()) text += ", written under " + report.prefix;
  return text;
}

void warnOfRun(const HammerBridge& bridge, bool joints_came, std::int64_t run, std::vector<BagWarning>& warnings) {
  for (const Warning& warning : warningsOf(bridge.pipeline())) {
    const bool of_joints = std::strcmp(warning.key, "pitch joints") == 0;
    const std::string& topic = bridge.settings().input_topics.joint_states;
    if (!of_joints) addOnce(warnings, {warning.key, warning.text, run});
    if (of_joints && joints_came)  // otherwise warnOfMissing() adds a warning
      addOnce(warnings, {warning.key, topic + ": " + warning.text, run});
  }
  for (const Warning& warning : bridge.life().warnings()) addOnce(warnings, {warning.key, warning.text, run});
}

void warnOfRecording(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& topics,
                     const std::set<std::string>& heard, std::vector<BagWarning>& warnings) {
  warnOfPublishers(inputs, topics, warnings);
  warnOfDefinitions(inputs, warnings);
  warnOfLostMessages(inputs, warnings);
  warnOfMissing(inputs, runs, heard, warnings);
}

bool isUseless(const BagReport& report) {
  const bool contradicts = report.turns == 0 && report.crank.contradictSince({});
  return report.wrenches == 0 || contradicts || (report.crank.accepted <= 1 && report.samples > 1);
}

std::string contradictionsOf(const std::vector<BagWarning>& warnings) {
  std::vector<std::string> texts;
  for (const BagWarning& warning : warnings)
    if (isContradiction(warning.key)) addOnce(texts, warning.text);
  return joined(texts, "; ");
}

std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report) {
  const std::string& topic = run.settings.input_topics.crank;
  if (report.samples == 0) return "no message on " + topic;
  std::string text = (report.wrenches == 0 ? "no wrench from " : "no wrench of use from ") +
                     std::to_string(report.samples) + " messages on " + topic + ": ";
  if (report.crank.refused[static_cast<std::size_t>(Refusal::kMissingJoint)] > 0)
    text += "joint " + run.settings.pipeline.crank_joint +
            " (crank_joint) is required, joints there: " + jointsOn(inputs, topic) + "; ";
  const std::string contradictions = contradictionsOf(report.warnings);
  if (!contradictions.empty()) text += contradictions + "; ";
  if (report.crank.refusedFor(Refusal::kDuplicate) + 1 >= report.samples)
    text += "header stamps do not advance, must be the instants of the samples; ";
  std::vector<std::string> counts;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i)
    if (report.crank.refused[i] > 0)
      counts.push_back(std::string(kRefusalNames[i]) + " " + std::to_string(report.crank.refused[i]));
  return text + (counts.empty() ? "none was refused" : joined(counts));
}

}  // namespace hammer_loads
