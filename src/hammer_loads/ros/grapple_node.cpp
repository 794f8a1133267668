#include "hammer_loads/ros/grapple_node.h"

#include <utility>

#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kQueue = 10000;  // ten seconds at 1 kHz, in and out: a stalled machine loses nothing

}  // namespace

GrappleNode::GrappleNode(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleSettings& settings,
                         std::unique_ptr<BagLog> log)
    : flow_(settings, *this),
      log_(std::move(log)),
      jaws_{{{private_node.advertise<geometry_msgs::PointStamped>("jaw_edge/left", kQueue),
              private_node.advertise<geometry_msgs::TwistStamped>("jaw_edge/left_twist", kQueue),
              private_node.advertise<geometry_msgs::AccelStamped>("jaw_edge/left_accel", kQueue)},
             {private_node.advertise<geometry_msgs::PointStamped>("jaw_edge/right", kQueue),
              private_node.advertise<geometry_msgs::TwistStamped>("jaw_edge/right_twist", kQueue),
              private_node.advertise<geometry_msgs::AccelStamped>("jaw_edge/right_accel", kQueue)}}},
      mechanism_(private_node.advertise<sensor_msgs::JointState>("mechanism", kQueue)),
      run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
      diagnostics_(node, private_node, flow_, *log_),
      log_services_(
          private_node, *log_, [this] { beginRun(); }, [] {}) {
  RunInfo info = flow_.runInfoMessage();
  info.header.stamp = ros::Time::now();
  run_info_.publish(info);
  joint_states_ =
      node.subscribe("joint_states", kQueue, &GrappleNode::onJointStates, this, ros::TransportHints().tcpNoDelay());
}

void GrappleNode::onJointStates(const ros::MessageEvent<const sensor_msgs::JointState>& event) {
  const RecordClock::Tick tick = clock_.next(event.getReceiptTime());
  if (tick.ran_back) {
    beginRun();
    log_->split();
  }
  log_->write(joint_states_.getTopic(), tick.time, *event.getConstMessage());
  const std::uint64_t foreign = flow_.messagesWithoutJoint();
  flow_.jointStates(*event.getConstMessage(), tick.time);
  if (flow_.messagesWithoutJoint() == foreign) diagnostics_.sliderArrived();
}

/// The next input begins a run, and its run_info replaces that of the run before.
void GrappleNode::beginRun() {
  flow_.reset();
  log_->forgetLatched(run_info_.getTopic());
}

template <typename Message>
void GrappleNode::send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(message);
  log_->write(publisher.getTopic(), record_time, message);
}

void GrappleNode::runInfo(const RunInfo& message, const ros::Time& record_time) {
  log_->writeLatched(run_info_.getTopic(), record_time, message);
}

void GrappleNode::edge(Jaw jaw, const geometry_msgs::PointStamped& message, const ros::Time& record_time) {
  send(publishers(jaw).edge, message, record_time);
}

void GrappleNode::twist(Jaw jaw, const geometry_msgs::TwistStamped& message, const ros::Time& record_time) {
  send(publishers(jaw).twist, message, record_time);
}

void GrappleNode::accel(Jaw jaw, const geometry_msgs::AccelStamped& message, const ros::Time& record_time) {
  send(publishers(jaw).accel, message, record_time);
}

void GrappleNode::mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  send(mechanism_, message, record_time);
}

bool GrappleNode::wants(Jaw jaw) const {
  const JawPublishers& p = publishers(jaw);
  return log_->isRecording() || p.edge.getNumSubscribers() > 0 || p.twist.getNumSubscribers() > 0 ||
         p.accel.getNumSubscribers() > 0;
}

bool GrappleNode::wantsMechanism() const { return log_->isRecording() || mechanism_.getNumSubscribers() > 0; }

std::unique_ptr<GrappleNode> makeGrappleNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                             std::vector<std::string>& problems) {
  const ParameterMap given = privateParameters(private_node, problems);
  const Checked<GrappleSettings> settings = loadGrappleSettings(configDirectory(), given);
  problems.insert(problems.end(), settings.problems.begin(), settings.problems.end());
  if (!problems.empty()) return nullptr;
  auto log = std::make_unique<BagLog>(forNode(settings.value->log, private_node.getNamespace()));
  if (settings.value->log.enabled) {
    problems = log->settingProblems();
    if (!problems.empty()) return nullptr;
    for (const std::string& bag : log->unfinishedBags()) ROS_WARN("%s", BagLog::recoveryHint(bag).c_str());
    for (const std::string& reason : log->start()) ROS_ERROR("%s; the node runs without a log", reason.c_str());
  }
  return std::make_unique<GrappleNode>(node, private_node, *settings.value, std::move(log));
}

}  // namespace hammer_loads
