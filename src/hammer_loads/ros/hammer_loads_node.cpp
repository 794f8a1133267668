#include "hammer_loads/ros/hammer_loads_node.h"

#include <utility>

#include "hammer_loads/ros/ros_parameters.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kQueue = 10000;  // ten seconds at 1 kHz, in and out: a stalled machine loses nothing

}  // namespace

HammerLoadsNode::HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                                 std::unique_ptr<BagLog> log)
    : flow_(settings, *this),
      log_(std::move(log)),
      hull_wrench_(private_node.advertise<geometry_msgs::WrenchStamped>("hull_wrench", kQueue)),
      hull_loads_(private_node.advertise<HullLoads>("hull_loads", kQueue)),
      mechanism_(private_node.advertise<sensor_msgs::JointState>("mechanism", kQueue)),
      pin_forces_(private_node.advertise<PinForces>("pin_forces", kQueue)),
      blow_(private_node.advertise<Blow>("blow", kQueue)),
      pulse_(private_node.advertise<Pulse>("pulse", kQueue)),
      run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
      diagnostics_(node, private_node, flow_.pipeline(), log_.get(), settings.notes) {
  RunInfo info = flow_.runInfoMessage();
  info.header.stamp = ros::Time::now();
  run_info_.publish(info);
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  // Joint states first: where both arrive on one topic, a sample's own pitch counts for it.
  joint_states_ = node.subscribe("joint_states", kQueue, &HammerLoadsNode::onJointStates, this, no_delay);
  crank_ = node.subscribe("crank", kQueue, &HammerLoadsNode::onCrank, this, no_delay);
  one_topic_ = joint_states_.getTopic() == crank_.getTopic();
}

void HammerLoadsNode::onJointStates(const JointStateEvent& event) {
  const ros::Time record_time = recordTime(event);
  diagnostics_.jointStatesArrived();
  if (log_) log_->write(joint_states_.getTopic(), record_time, *event.getConstMessage());
  flow_.jointStates(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onCrank(const JointStateEvent& event) {
  const ros::Time record_time = one_topic_ ? clock_.last() : recordTime(event);
  diagnostics_.crankArrived();
  if (log_ && !one_topic_) log_->write(crank_.getTopic(), record_time, *event.getConstMessage());
  flow_.crank(*event.getConstMessage(), record_time);
}

ros::Time HammerLoadsNode::recordTime(const JointStateEvent& event) {
  const RecordClock::Tick tick = clock_.next(event.getReceiptTime());
  if (tick.ran_back) {
    flow_.reset();
    if (log_) log_->split();
  }
  return tick.time;
}

template <typename Message>
void HammerLoadsNode::send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(message);
  if (log_) log_->write(publisher.getTopic(), record_time, message);
}

void HammerLoadsNode::runInfo(const RunInfo& message, const ros::Time& record_time) {
  if (log_) log_->writeLatched(run_info_.getTopic(), record_time, message);
}

void HammerLoadsNode::hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) {
  send(hull_wrench_, message, record_time);
}

void HammerLoadsNode::hullLoads(const HullLoads& message, const ros::Time& record_time) {
  send(hull_loads_, message, record_time);
}

void HammerLoadsNode::mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  send(mechanism_, message, record_time);
}

void HammerLoadsNode::pinForces(const PinForces& message, const ros::Time&) { pin_forces_.publish(message); }

void HammerLoadsNode::blow(const Blow& message, const ros::Time& record_time) { send(blow_, message, record_time); }

void HammerLoadsNode::pulse(const Pulse& message, const ros::Time& record_time) { send(pulse_, message, record_time); }

bool HammerLoadsNode::wantsHullLoads() const { return log_ || hull_loads_.getNumSubscribers() > 0; }

bool HammerLoadsNode::wantsMechanism() const { return log_ || mechanism_.getNumSubscribers() > 0; }

/// Not logged: they follow from the logged mechanism and would be the largest part of the log.
bool HammerLoadsNode::wantsPinForces() const { return pin_forces_.getNumSubscribers() > 0; }

bool HammerLoadsNode::wantsTurns() const {
  return log_ || blow_.getNumSubscribers() > 0 || pulse_.getNumSubscribers() > 0;
}

std::unique_ptr<HammerLoadsNode> makeNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems) {
  const Checked<Settings> settings = loadPrivateParameters(private_node);
  problems = settings.problems;
  if (!settings.value) return nullptr;
  std::unique_ptr<BagLog> log;
  if (settings.value->log.enabled) {
    log = std::make_unique<BagLog>(settings.value->log);
    problems = log->start();
    if (!problems.empty()) return nullptr;
  }
  return std::make_unique<HammerLoadsNode>(node, private_node, *settings.value, std::move(log));
}

}  // namespace hammer_loads
