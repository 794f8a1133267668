#include "hammer_loads/ros/bag_processing.h"

#include <cerrno>
#include <cstring>

#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_output.h"
#include "hammer_loads/ros/bag_runs.h"
#include "hammer_loads/ros/bag_sink.h"
#include "hammer_loads/ros/grapple_bag_processing.h"
#include "hammer_loads/ros/loads_flow.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

/// The hammer's flow through the runs of a recording.
class HammerRuns {
 public:
  HammerRuns(const std::vector<BagRun>& runs, LoadsSink& sink, BagReport& report)
      : runs_(runs), sink_(sink), report_(report) {
    begin();
  }

  void take(const rosbag::MessageInstance& item) {
    while (next_ < runs_.size() && item.getTime() >= runs_[next_].from) {
      end();
      begin();
    }
    const InputTopics& topics = flow_->settings().input_topics;
    const std::string& topic = item.getTopic();
    if (topic == "/tf" || topic == "/tf_static") return transforms(item, topic == "/tf_static");
    if (topic == topics.joint_states) flow_->jointStates(*messageOf<sensor_msgs::JointState>(item), item.getTime());
    if (topic == topics.crank) {
      ++report_.samples;
      flow_->crank(*messageOf<sensor_msgs::JointState>(item), item.getTime());
    }
    if (topic == topics.hull_imu && flow_->needsImu())
      flow_->hullImu(*messageOf<sensor_msgs::Imu>(item), item.getTime());
  }

  void end() {
    add(flow_->pipeline().counts(), report_.crank);
    addWarnings(*flow_, report_.warnings);
    ++report_.runs;
  }

  template <typename Message>
  static boost::shared_ptr<Message> messageOf(const rosbag::MessageInstance& item) {
    const auto message = item.instantiate<Message>();
    if (!message) throw rosbag::BagFormatException("a message on " + item.getTopic() + " cannot be read");
    return message;
  }

 private:
  /// Static transforms are the same in every run.
  void begin() {
    flow_.emplace(runs_[next_++].settings, sink_);
    for (const auto& [time, message] : statics_) flow_->transforms(*message, true, time);
  }

  void transforms(const rosbag::MessageInstance& item, bool is_static) {
    if (!is_static && !flow_->needsTransforms()) return;
    const auto message = messageOf<tf2_msgs::TFMessage>(item);
    if (is_static) statics_.emplace_back(item.getTime(), message);
    flow_->transforms(*message, is_static, item.getTime());
  }

  const std::vector<BagRun>& runs_;
  LoadsSink& sink_;
  BagReport& report_;
  std::size_t next_{};
  std::optional<LoadsFlow> flow_;
  std::vector<std::pair<ros::Time, tf2_msgs::TFMessage::ConstPtr>> statics_;
};

/// What is read, and as which type.
using Wanted = std::map<std::string, std::string>;

template <typename Message>
std::string typeOf() {
  return ros::message_traits::datatype<Message>();
}

Wanted wantedTopics(const std::vector<BagRun>& runs, bool hammer, const std::string& slider_topic) {
  Wanted wanted;
  if (!slider_topic.empty()) wanted[slider_topic] = typeOf<sensor_msgs::JointState>();
  if (!hammer) return wanted;
  for (const BagRun& run : runs) {
    const InputTopics& topics = run.settings.input_topics;
    if (run.settings.pipeline.hull_motion == HullMotionSource::kImu)
      wanted[topics.hull_imu] = typeOf<sensor_msgs::Imu>();
    wanted[topics.crank] = wanted[topics.joint_states] = typeOf<sensor_msgs::JointState>();
    if (!run.settings.pipeline.boom_wrench_links.empty())
      wanted["/tf"] = wanted["/tf_static"] = typeOf<tf2_msgs::TFMessage>();
  }
  return wanted;
}

/// Why a wanted topic cannot be read, or cannot be what is meant; empty: none of that.
std::string typeProblem(const BagInputs& inputs, const Wanted& wanted) {
  for (const auto& [name, type] : wanted) {
    const auto found = inputs.topics().find(name);
    if (found == inputs.topics().end()) continue;
    for (const std::string& is : found->second.types) {
      if (is != type) return name + " is of type " + onOneLine(is) + ", must be " + type;
    }
  }
  return {};
}

void warnOfPublishers(const BagInputs& inputs, const Wanted& wanted, std::vector<std::string>& warnings) {
  for (const auto& [name, type] : wanted) {
    const auto found = inputs.topics().find(name);
    if (found == inputs.topics().end() || found->second.publishers.size() < 2 || type == typeOf<tf2_msgs::TFMessage>())
      continue;
    std::string publishers;
    for (const std::string& node : found->second.publishers) publishers += (publishers.empty() ? "" : ", ") + node;
    addOnce(warnings, name + ": several publishers: " + publishers);
  }
}

/// Topics that are wanted and did not come.
void warnOfMissing(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& heard,
                   std::vector<std::string>& warnings) {
  for (const BagRun& run : runs) {
    const InputTopics& topics = run.settings.input_topics;
    const PipelineSettings& pipeline = run.settings.pipeline;
    const bool joints = !pipeline.pitch_joints.empty() || run.settings.boom;
    if (joints && heard.count(topics.joint_states) == 0)
      addOnce(warnings, "no message on " + topics.joint_states + " (--joint-states-topic); topics of its type there: " +
                            inputs.topicsOfType(typeOf<sensor_msgs::JointState>()));
    if (pipeline.hull_motion == HullMotionSource::kImu && heard.count(topics.hull_imu) == 0)
      addOnce(warnings, "hull_motion: imu, but no message on " + topics.hull_imu +
                            " (--imu-topic): weight by pitch; topics of its type there: " +
                            inputs.topicsOfType(typeOf<sensor_msgs::Imu>()));
  }
}

/// Names in the crank's messages, in one line.
std::string jointsOn(const BagInputs& inputs, const std::string& topic) {
  constexpr std::size_t kMost = 20;
  std::set<std::string> names;
  rosbag::View view;
  inputs.addTo(view, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& item : view) {
    const auto message = HammerRuns::messageOf<sensor_msgs::JointState>(item);
    for (const std::string& name : message->name) names.insert(onOneLine(name));
    if (names.size() > kMost) break;
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

/// Why there is no wrench at all.
std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report) {
  const std::string& topic = run.settings.input_topics.crank;
  if (report.samples == 0) return "no message on " + topic;
  std::string text = "no wrench from " + std::to_string(report.samples) + " messages on " + topic + ": ";
  if (report.crank.refused[static_cast<std::size_t>(Refusal::kMissingJoint)] > 0)
    text += "joint " + run.settings.pipeline.crank_joint +
            " (crank_joint) is required, joints there: " + jointsOn(inputs, topic) + "; ";
  std::string counts;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i) {
    if (report.crank.refused[i] == 0) continue;
    counts +=
        (counts.empty() ? "" : ", ") + std::string(kRefusalNames[i]) + " " + std::to_string(report.crank.refused[i]);
  }
  return text + (counts.empty() ? "none was refused" : counts);
}

/// Everything that one job works with once its inputs are known to be good.
struct Work {
  const BagInputs& inputs;
  const BagJob& job;
  const std::vector<BagRun>& runs;
  bool hammer{};             ///< the crank's topic is there
  std::string slider_topic;  ///< empty: no grapple
};

void process(const Work& work, rosbag::Bag& output, const std::function<void(double)>& progress, BagReport& report) {
  BagSink sink(output, work.job.output_prefix, work.job.pins);
  GrappleBagSink grapple_sink(output, work.job.grapple_prefix);
  std::optional<HammerRuns> hammer;
  std::optional<GrappleFlow> grapple;
  if (work.hammer) hammer.emplace(work.runs, sink, report);
  if (work.job.grapple) grapple.emplace(*work.job.grapple, grapple_sink);

  const Wanted wanted = wantedTopics(work.runs, work.hammer, work.slider_topic);
  std::vector<std::string> topics;
  for (const auto& [name, type] : wanted) topics.push_back(name);
  std::set<std::string> heard;
  rosbag::View view;
  work.inputs.addTo(view, rosbag::TopicQuery(topics));
  const double count = view.size();
  double done = 0.0;
  for (const rosbag::MessageInstance& item : view) {
    progress(++done / count);
    heard.insert(item.getTopic());
    if (hammer) hammer->take(item);
    if (grapple && item.getTopic() == work.slider_topic)
      grapple->jointStates(*HammerRuns::messageOf<sensor_msgs::JointState>(item), item.getTime());
  }
  warnOfPublishers(work.inputs, wanted, report.warnings);
  if (hammer) {
    hammer->end();
    warnOfMissing(work.inputs, work.runs, heard, report.warnings);
    report.wrenches = sink.wrenches();
    report.turns = sink.turns();
  }
  if (!grapple) return;
  report.grapple = refusalReport(*grapple);
  report.jaw_edges = grapple->accepted();
}

/// Into the output's file; what went wrong in one line, empty if nothing did.
std::string write(const Work& work, const std::function<void(double)>& progress, BagReport& report) {
  BagOutput output;
  errno = 0;
  try {
    output.open(work.job.output);
    process(work, output.bag(), progress, report);
    output.close();
    return {};
  } catch (const rosbag::BagFormatException&) {
    throw;  // of the input
  } catch (const rosbag::BagException& error) {
    if (std::strstr(error.what(), "reading") != nullptr) throw;
    return "cannot be written: " + onOneLine(errno != 0 ? std::strerror(errno) : error.what());
  }
}

}  // namespace

std::vector<std::string> processBag(const BagJob& job, const std::function<void(double)>& progress, BagReport& report) {
  if (job.grapple && job.grapple_prefix == job.output_prefix)
    return {"--grapple-prefix: " + job.grapple_prefix + ", must differ from --output-prefix"};
  const Checked<BagInputs> inputs = BagInputs::open(job.inputs);
  if (!inputs.value) return inputs.problems;
  const std::string& names = inputs.value->names();
  try {
    const Checked<std::vector<BagRun>> runs = runsOf(*inputs.value, job, report.warnings);
    if (!runs.value) return runs.problems;
    report.notes = runs.notes;
    Work work{*inputs.value, job, *runs.value, false, ""};
    const InputTopics& first = runs.value->front().settings.input_topics;
    for (const BagRun& run : *runs.value)
      work.hammer = work.hammer || inputs.value->has(run.settings.input_topics.crank);
    if (!work.hammer) report.notes = report.warnings = {};
    if (job.grapple) work.slider_topic = first.joint_states;
    const std::string& required = job.grapple ? first.joint_states : first.crank;
    if (job.grapple ? !inputs.value->has(required) : !work.hammer)
      return {names + ": no topic " + required + ", is required; topics there: " + inputs.value->topicList()};
    const std::string problem = typeProblem(*inputs.value, wantedTopics(work.runs, work.hammer, work.slider_topic));
    if (!problem.empty()) return {names + ": " + problem};
    const std::string failure = write(work, progress, report);
    if (!failure.empty()) return {job.output + ": " + failure};
    if (report.wrenches == 0 && report.jaw_edges == 0)
      return {names + ": " +
              (work.hammer ? noWrench(*inputs.value, runs.value->back(), report)
                           : "no jaw edge; " + onOneLine(report.grapple))};
    if (work.hammer && report.wrenches == 0)
      addOnce(report.warnings, noWrench(*inputs.value, runs.value->back(), report));
    return {};
  } catch (const std::exception& error) {
    return {names + ": cannot be read: " + onOneLine(error.what())};
  }
}

}  // namespace hammer_loads
