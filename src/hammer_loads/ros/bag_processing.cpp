#include "hammer_loads/ros/bag_processing.h"

#include <cerrno>
#include <cstring>

#include "hammer_loads/ros/attach.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_output.h"
#include "hammer_loads/ros/bag_runs.h"
#include "hammer_loads/ros/bag_warnings.h"
#include "hammer_loads/ros/grapple_bag_processing.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

/// What is read, and as which type.
using Wanted = std::map<std::string, std::string>;

/// The hammer's bridge through the runs of a recording.
class HammerRuns {
 public:
  HammerRuns(const std::vector<BagRun>& runs, const BagJob& job, rosbag::Bag& output, BagReport& report)
      : runs_(runs), job_(job), output_(output), report_(report) {
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
    if (topic == topics.joint_states) {
      joints_came_ = true;
      flow_->jointStates(*messageOf<sensor_msgs::JointState>(item), item.getTime());
    }
    if (topic == topics.crank) {
      ++report_.samples;
      flow_->crank(*messageOf<sensor_msgs::JointState>(item), item.getTime());
    }
    if (topic == topics.hull_imu && flow_->needsImu())
      flow_->hullImu(*messageOf<sensor_msgs::Imu>(item), item.getTime());
    for (const HammerBridge::PressureTopic& pressure : pressures_) {
      if (topic == pressure.name)
        flow_->cylinderPressure(pressure.cylinder, pressure.chamber, *messageOf<sensor_msgs::FluidPressure>(item),
                                item.getTime());
    }
  }

  void end() {
    flow_->end();
    add(flow_->pipeline().counts(), report_.crank);
    report_.wrenches += flow_->outputs().hull_wrench.sent();
    report_.turns += flow_->outputs().blow.sent();
    warnOfRun(*flow_, joints_came_, report_.warnings);
    ++report_.runs;
  }

 private:
  /// Static transforms are the same in every run.
  void begin() {
    joints_came_ = false;
    const Settings& settings = runs_[next_++].settings;
    flow_.emplace(settings);
    pressures_ = HammerBridge::pressureTopics(settings, settings.input_topics.cylinder_pressures);
    attachToBag(flow_->outputs(), output_, job_.output_prefix, job_.pins);
    for (const auto& [time, message] : statics_) flow_->transforms(*message, true, time);
  }

  void transforms(const rosbag::MessageInstance& item, bool is_static) {
    if (!is_static && !flow_->needsTransforms()) return;
    const auto message = messageOf<tf2_msgs::TFMessage>(item);
    if (is_static) statics_.emplace_back(item.getTime(), message);
    flow_->transforms(*message, is_static, item.getTime());
  }

  const std::vector<BagRun>& runs_;
  const BagJob& job_;
  rosbag::Bag& output_;
  BagReport& report_;
  std::size_t next_{};
  bool joints_came_{};  ///< in this run
  std::optional<HammerBridge> flow_;
  std::vector<HammerBridge::PressureTopic> pressures_;
  std::vector<std::pair<ros::Time, tf2_msgs::TFMessage::ConstPtr>> statics_;
};

Wanted wantedTopics(const std::vector<BagRun>& runs, bool hammer, const std::string& slider_topic) {
  Wanted wanted;
  if (!slider_topic.empty()) wanted[slider_topic] = typeOf<sensor_msgs::JointState>();
  if (!hammer) return wanted;
  for (const BagRun& run : runs) {
    const InputTopics& topics = run.settings.input_topics;
    for (const auto& pressure : HammerBridge::pressureTopics(run.settings, topics.cylinder_pressures))
      wanted[pressure.name] = typeOf<sensor_msgs::FluidPressure>();
    if (needsImu(run.settings.pipeline)) wanted[topics.hull_imu] = typeOf<sensor_msgs::Imu>();
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
    for (const std::string& actual : found->second.types) {
      if (actual != type) return name + " is of type " + onOneLine(actual) + ", must be " + type;
    }
  }
  return {};
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
  std::optional<HammerRuns> hammer;
  std::optional<GrappleFlow> grapple;
  if (work.hammer) hammer.emplace(work.runs, work.job, output, report);
  if (work.job.grapple)
    attachToBag(grapple.emplace(*work.job.grapple).outputs(), output, work.job.grapple_prefix, false);

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
      grapple->jointStates(*messageOf<sensor_msgs::JointState>(item), item.getTime());
  }
  warnOfPublishers(work.inputs, topics, report.warnings);
  warnOfDefinitions(work.inputs, report.warnings);
  warnOfLostMessages(work.inputs, report.warnings);
  if (hammer) {
    hammer->end();
    warnOfMissing(work.inputs, work.runs, heard, report.warnings);
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
  } catch (const rosbag::BagException& error) {  // what goes wrong with an input is none
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
    report.hammer_prefix = job.output_prefix;
    report.grapple_prefix = job.grapple_prefix;
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
