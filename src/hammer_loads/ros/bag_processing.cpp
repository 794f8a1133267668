#include "hammer_loads/ros/bag_processing.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cerrno>
#include <cstring>

#include "hammer_loads/ros/bag_sink.h"
#include "hammer_loads/ros/grapple_bag_processing.h"
#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads {
namespace {

/// What of the job the bag has input for.
struct BagInputs {
  bool crank{}, joints{};
};

std::string checkTopics(rosbag::Bag& bag, const BagJob& job, BagInputs& inputs) {
  rosbag::View all(bag);
  std::string topics;
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
    const bool wanted = connection->topic == job.crank_topic || connection->topic == job.joint_topic;
    const char* type = ros::message_traits::datatype<sensor_msgs::JointState>();
    if (wanted && connection->datatype != type)
      return connection->topic + " is of type " + connection->datatype + ", must be " + type;
    inputs.crank = inputs.crank || connection->topic == job.crank_topic;
    inputs.joints = inputs.joints || connection->topic == job.joint_topic;
    topics += " " + connection->topic;
  }
  if (job.grapple ? inputs.joints : inputs.crank) return {};
  return "no topic " + (job.grapple ? job.joint_topic : job.crank_topic) +
         " in it, must be there; topics:" + (topics.empty() ? " none" : topics);
}

/// Null flows have no part in it.
void process(rosbag::Bag& input, const BagJob& job, LoadsFlow* hammer, GrappleFlow* grapple,
             const std::function<void(double)>& progress) {
  std::vector<std::string> topics{job.crank_topic, job.joint_topic};
  if (hammer && hammer->needsTransforms()) topics.insert(topics.end(), {"/tf", "/tf_static"});
  if (hammer && hammer->needsImu()) topics.push_back(job.imu_topic);
  rosbag::View view(input, rosbag::TopicQuery(topics));
  const double count = view.size();
  double done = 0.0;
  for (const rosbag::MessageInstance& item : view) {
    progress(++done / count);
    if (const auto transforms = item.instantiate<tf2_msgs::TFMessage>()) {
      hammer->transforms(*transforms, item.getTopic() == "/tf_static", item.getTime());
      continue;
    }
    if (const auto imu = item.instantiate<sensor_msgs::Imu>()) {
      hammer->hullImu(*imu, item.getTime());
      continue;
    }
    const auto message = item.instantiate<sensor_msgs::JointState>();
    if (!message) throw rosbag::BagFormatException("a message on " + item.getTopic() + " cannot be read");
    // One topic may carry both.
    const bool joints = item.getTopic() == job.joint_topic;
    if (hammer && joints) hammer->jointStates(*message, item.getTime());
    if (hammer && item.getTopic() == job.crank_topic) hammer->crank(*message, item.getTime());
    if (grapple && joints) grapple->jointStates(*message, item.getTime());
  }
}

BagReport write(rosbag::Bag& input, const BagInputs& inputs, rosbag::Bag& output, const BagJob& job,
                const Settings& settings, const std::function<void(double)>& progress) {
  BagSink sink(output, job.output_prefix, job.pins);
  GrappleBagSink grapple_sink(output, job.grapple_prefix);
  std::optional<LoadsFlow> hammer;
  std::optional<GrappleFlow> grapple;
  if (inputs.crank) hammer.emplace(settings, sink);
  if (job.grapple) grapple.emplace(*job.grapple, grapple_sink);
  process(input, job, hammer ? &*hammer : nullptr, grapple ? &*grapple : nullptr, progress);
  BagReport report;
  if (hammer) report.crank = hammer->pipeline().counts();
  if (grapple) report.grapple = refusalReport(*grapple);
  return report;
}

}  // namespace

std::string processBag(const BagJob& job, const Settings& settings, const std::function<void(double)>& progress,
                       BagReport& report) {
  if (job.grapple && job.grapple_prefix == job.output_prefix)
    return "--grapple-prefix: " + job.grapple_prefix + ", must differ from --output-prefix";
  rosbag::Bag input;
  BagInputs inputs;
  try {
    input.open(job.input, rosbag::bagmode::Read);
    const std::string problem = checkTopics(input, job, inputs);
    if (!problem.empty()) return job.input + ": " + problem;
  } catch (const std::exception& error) {
    return job.input + ": cannot be read as a bag: " + error.what();
  }

  PartialFile partial(job.output);
  rosbag::Bag output;
  try {
    output.open(partial.name(), rosbag::bagmode::Write);
    output.setCompression(rosbag::compression::LZ4);
  } catch (const std::exception& error) {
    return job.output + ": cannot be written: " + error.what();
  }

  try {
    report = write(input, inputs, output, job, settings, progress);
    output.close();
  } catch (const std::exception& error) {
    return job.input + " to " + job.output + ": " + error.what();
  }
  if (!partial.keep()) return job.output + ": cannot be given its name: " + std::strerror(errno);
  return {};
}

std::string textOf(const BagReport& report) {
  std::string text;
  for (std::size_t i = 0; i < report.crank.refused.size(); ++i) {
    if (report.crank.refused[i] == 0) continue;
    text += std::string("crank samples without a wrench, ") + kRefusalNames[i] + ": " +
            std::to_string(report.crank.refused[i]) + "\n";
  }
  return text + report.grapple;
}

}  // namespace hammer_loads
