#include "hammer_loads/ros/bag_processing.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads {
namespace {

class BagSink final : public LoadsSink {
 public:
  BagSink(rosbag::Bag& bag, const BagJob& job) : bag_(bag), prefix_(job.output_prefix + "/"), pins_(job.pins) {}

  void runInfo(const RunInfo& message, const ros::Time& record_time) override {
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["latching"] = "1";
    (*header)["topic"] = prefix_ + "run_info";
    (*header)["type"] = ros::message_traits::datatype<RunInfo>();
    (*header)["md5sum"] = ros::message_traits::md5sum<RunInfo>();
    (*header)["message_definition"] = ros::message_traits::definition<RunInfo>();
    bag_.write(prefix_ + "run_info", record_time, message, header);
  }
  void hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "hull_wrench", record_time, message);
  }
  void hullLoads(const HullLoads& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "hull_loads", record_time, message);
  }
  void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "mechanism", record_time, message);
  }
  void pinForces(const PinForces& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "pin_forces", record_time, message);
  }
  void blow(const Blow& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "blow", record_time, message);
  }
  void pulse(const Pulse& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "pulse", record_time, message);
  }
  bool wantsHullLoads() const override { return true; }
  bool wantsMechanism() const override { return true; }
  bool wantsPinForces() const override { return pins_; }
  bool wantsTurns() const override { return true; }

 private:
  rosbag::Bag& bag_;
  std::string prefix_;
  bool pins_;
};

/// Removes the unfinished output unless it was given its final name.
class PartialFile {
 public:
  explicit PartialFile(const std::string& final_name)
      : final_name_(final_name), name_(final_name + ".part." + std::to_string(getpid())) {}
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    if (!kept_) std::remove(name_.c_str());
  }
  const std::string& name() const { return name_; }
  bool keep() { return kept_ = std::rename(name_.c_str(), final_name_.c_str()) == 0; }

 private:
  std::string final_name_, name_;
  bool kept_{};
};

std::string checkTopics(rosbag::Bag& bag, const BagJob& job) {
  rosbag::View all(bag);
  bool crank = false;
  std::string topics;
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
    const bool wanted = connection->topic == job.crank_topic || connection->topic == job.joint_topic;
    const char* type = ros::message_traits::datatype<sensor_msgs::JointState>();
    if (wanted && connection->datatype != type)
      return connection->topic + " is of type " + connection->datatype + ", must be " + type;
    crank = crank || connection->topic == job.crank_topic;
    topics += " " + connection->topic;
  }
  if (crank) return {};
  return "no topic " + job.crank_topic + " in it, must be there; topics:" + (topics.empty() ? " none" : topics);
}

void process(rosbag::Bag& input, const BagJob& job, LoadsFlow& flow, const std::function<void(double)>& progress) {
  rosbag::View view(input, rosbag::TopicQuery({job.crank_topic, job.joint_topic}));
  const double count = view.size();
  double done = 0.0;
  for (const rosbag::MessageInstance& item : view) {
    const auto message = item.instantiate<sensor_msgs::JointState>();
    if (!message) throw rosbag::BagFormatException("a message on " + item.getTopic() + " cannot be read");
    // One topic may carry both.
    if (item.getTopic() == job.joint_topic) flow.jointStates(*message, item.getTime());
    if (item.getTopic() == job.crank_topic) flow.crank(*message, item.getTime());
    progress(++done / count);
  }
}

}  // namespace

std::string processBag(const BagJob& job, const Settings& settings, const std::function<void(double)>& progress, IntakeCounts& counts) {
  rosbag::Bag input;
  try {
    input.open(job.input, rosbag::bagmode::Read);
    const std::string problem = checkTopics(input, job);
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
    BagSink sink(output, job);
    LoadsFlow flow(settings, sink);
    process(input, job, flow, progress);
    counts = flow.pipeline().counts();
    output.close();
  } catch (const std::exception& error) {
    return job.input + " to " + job.output + ": " + error.what();
  }
  if (!partial.keep()) return job.output + ": cannot be given its name: " + std::strerror(errno);
  return {};
}

}  // namespace hammer_loads
