#include "hammer_loads/ros/hammer_loads_node.h"

#include <cmath>
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
      joint_loads_(private_node.advertise<JointLoads>("joint_loads", kQueue)),
      boom_vibration_(private_node.advertise<BoomVibration>("boom_vibration", kQueue)),
      mechanism_(private_node.advertise<JointState>("mechanism", kQueue)),
      pin_forces_(private_node.advertise<PinForces>("pin_forces", kQueue)),
      blow_(private_node.advertise<Blow>("blow", kQueue)),
      pulse_(private_node.advertise<Pulse>("pulse", kQueue)),
      run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
      diagnostics_(node, private_node, flow_, *log_),
      reconfigure_(reconfigure_mutex_, private_node),
      log_services_(
          private_node, *log_, [this] { beginRun(); }, [this] { logSwitched(); }) {
  for (const std::string& link : settings.pipeline.boom_wrench_links)
    boom_wrench_[link] = private_node.advertise<geometry_msgs::WrenchStamped>("boom_wrench/" + link, kQueue);
  announceRun();
  config_ = configInForce(settings.log.enabled);
  reconfigure_.updateConfig(config_);
  reconfigure_.setCallback([this](HammerLoadsConfig& config, std::uint32_t) { onReconfigure(config); });
  subscribe(node);
}

void HammerLoadsNode::subscribe(ros::NodeHandle& node) {
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  // Joint states first: where both arrive on one topic, a sample's own pitch counts for it.
  joint_states_ = node.subscribe("joint_states", kQueue, &HammerLoadsNode::onJointStates, this, no_delay);
  crank_ = node.subscribe("crank", kQueue, &HammerLoadsNode::onCrank, this, no_delay);
  if (flow_.needsImu()) hull_imu_ = node.subscribe("hull_imu", kQueue, &HammerLoadsNode::onImu, this, no_delay);
  one_topic_ = joint_states_.getTopic() == crank_.getTopic();
  const auto transforms = [this](bool is_static) {
    return boost::function<void(const Event<tf2_msgs::TFMessage>&)>(
        [this, is_static](const Event<tf2_msgs::TFMessage>& event) { onTransforms(event, is_static); });
  };
  using Given = const Event<tf2_msgs::TFMessage>&;
  // A log stands alone: whoever replays it needs the static transforms, even if this node does not.
  tf_static_ = node.subscribe<tf2_msgs::TFMessage, Given>("/tf_static", kQueue, transforms(true));
  if (flow_.needsTransforms())
    tf_ = node.subscribe<tf2_msgs::TFMessage, Given>("/tf", kQueue, transforms(false), {}, no_delay);
}

/// Those who subscribe later get the latched message; the log gets its own with the first input.
void HammerLoadsNode::announceRun() {
  RunInfo info = flow_.runInfoMessage();
  info.header.stamp = ros::Time::now();
  run_info_.publish(info);
}

/// The next input begins a run, and its run_info replaces that of the run before.
void HammerLoadsNode::beginRun() {
  flow_.reset();
  log_->forgetLatched(run_info_.getTopic());
}

/// What is in force, for the server: it does not know the shipped parameter files.
HammerLoadsConfig HammerLoadsNode::configInForce(bool log_enabled) const {
  const PipelineSettings& now = flow_.settings().pipeline;
  HammerLoadsConfig config = HammerLoadsConfig::__getDefault__();
  config.log_enabled = log_enabled;
  config.output_rate_Hz = now.output_rate;
  config.tolerance = now.tolerance;
  config.withhold_above = now.withhold_above;
  return config;
}

/// A log that stopped by itself is begun anew only where that is asked for. The answer says what is in force.
void HammerLoadsNode::onReconfigure(HammerLoadsConfig& config) {
  const bool switched = config.log_enabled != config_.log_enabled;
  if (switched) switchLog(config.log_enabled);
  const bool changed = config.output_rate_Hz != config_.output_rate_Hz || config.tolerance != config_.tolerance ||
                       config.withhold_above != config_.withhold_above;
  const bool finite = std::isfinite(config.output_rate_Hz + config.tolerance + config.withhold_above);
  if (!finite) ROS_WARN("set_parameters: nan, must be numbers; nothing is changed");
  if (changed && finite) {
    flow_.begin(withChanges(flow_.settings(), {{"output_rate_Hz", config.output_rate_Hz},
                                               {"tolerance", config.tolerance},
                                               {"withhold_above", config.withhold_above}}));
    log_->forgetLatched(run_info_.getTopic());
    if (!switched) log_->split();
    announceRun();
    config_ = configInForce(config_.log_enabled);
  }
  config = config_;
}

void HammerLoadsNode::switchLog(bool on) {
  if (!on) log_->stop();
  if (on && !log_->isRecording()) {
    const std::vector<std::string> problems = log_->start();
    for (const std::string& problem : problems) ROS_ERROR("%s", problem.c_str());
    on = problems.empty();
    if (on) beginRun();
  }
  config_.log_enabled = on;
}

/// By a service.
void HammerLoadsNode::logSwitched() {
  config_.log_enabled = log_->isRecording();
  reconfigure_.updateConfig(config_);
}

void HammerLoadsNode::onJointStates(const Event<JointState>& event) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  diagnostics_.jointStatesArrived();
  log_->write(joint_states_.getTopic(), record_time, *event.getConstMessage());
  flow_.jointStates(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onCrank(const Event<JointState>& event) {
  const ros::Time record_time = one_topic_ ? clock_.last() : recordTime(event.getReceiptTime());
  diagnostics_.crankArrived();
  if (!one_topic_) log_->write(crank_.getTopic(), record_time, *event.getConstMessage());
  flow_.crank(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onImu(const Event<sensor_msgs::Imu>& event) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  log_->write(hull_imu_.getTopic(), record_time, *event.getConstMessage());
  flow_.hullImu(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onTransforms(const Event<tf2_msgs::TFMessage>& event, bool is_static) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  const tf2_msgs::TFMessage& message = *event.getConstMessage();
  if (is_static) log_->writeLatched("/tf_static", record_time, message, event.getPublisherName());
  if (!is_static) log_->write("/tf", record_time, message);
  flow_.transforms(message, is_static, record_time);
}

ros::Time HammerLoadsNode::recordTime(const ros::Time& arrival) {
  const RecordClock::Tick tick = clock_.next(arrival);
  if (tick.ran_back) {
    beginRun();
    log_->split();
  }
  return tick.time;
}

template <typename Message>
void HammerLoadsNode::send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(message);
  log_->write(publisher.getTopic(), record_time, message);
}

void HammerLoadsNode::runInfo(const RunInfo& message, const ros::Time& record_time) {
  log_->writeLatched(run_info_.getTopic(), record_time, message);
}

void HammerLoadsNode::hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) {
  send(hull_wrench_, message, record_time);
}

void HammerLoadsNode::boomWrench(const std::string& link, const geometry_msgs::WrenchStamped& message,
                                 const ros::Time& record_time) {
  send(boom_wrench_.at(link), message, record_time);
}

void HammerLoadsNode::jointLoads(const JointLoads& message, const ros::Time& record_time) {
  send(joint_loads_, message, record_time);
}

void HammerLoadsNode::boomVibration(const BoomVibration& message, const ros::Time& record_time) {
  send(boom_vibration_, message, record_time);
}

void HammerLoadsNode::hullLoads(const HullLoads& message, const ros::Time& record_time) {
  send(hull_loads_, message, record_time);
}

void HammerLoadsNode::mechanism(const JointState& message, const ros::Time& record_time) {
  send(mechanism_, message, record_time);
}

void HammerLoadsNode::pinForces(const PinForces& message, const ros::Time&) { pin_forces_.publish(message); }

void HammerLoadsNode::blow(const Blow& message, const ros::Time& record_time) { send(blow_, message, record_time); }

void HammerLoadsNode::pulse(const Pulse& message, const ros::Time& record_time) { send(pulse_, message, record_time); }

std::unique_ptr<HammerLoadsNode> makeNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems) {
  const Checked<Settings> settings = loadPrivateParameters(private_node);
  problems = settings.problems;
  if (!settings.value) return nullptr;
  auto log = std::make_unique<BagLog>(forNode(settings.value->log, private_node.getNamespace()));
  if (settings.value->log.enabled) {
    problems = log->start();
    if (!problems.empty()) return nullptr;
  }
  return std::make_unique<HammerLoadsNode>(node, private_node, *settings.value, std::move(log));
}

}  // namespace hammer_loads
