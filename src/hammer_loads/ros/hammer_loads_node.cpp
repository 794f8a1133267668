#include "hammer_loads/ros/hammer_loads_node.h"

#include <cmath>
#include <iostream>
#include <utility>

#include "hammer_loads/ros/attach.h"
#include "hammer_loads/ros/node_log.h"
#include "hammer_loads/ros/ros_parameters.h"

namespace hammer_loads {

HammerLoadsNode::HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                                 std::unique_ptr<BagLog> log)
    : log_(std::move(log)),
      ledger_(settings.life.ledger.empty() ? nullptr : std::make_unique<life::LedgerThread>(settings.life.ledger)),
      bridge_(settings),
      run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
      config_(configInForce(log_->isRecording())),
      diagnostics_(node, private_node, bridge_, *log_, ledger_.get()),
      reconfigure_(reconfigure_mutex_, private_node),
      log_services_(
          private_node, *log_, [this] { bridge_.finishRun(); }, [this] { beginRun(); }, [this] { logSwitched(); }) {
  if (ledger_) bridge_.keepPieces(*ledger_);
  attachToNode(bridge_.outputs(), private_node, *log_);
  announceRun();
  reconfigure_.updateConfig(config_);
  reconfigure_.setCallback([this](HammerLoadsConfig& config, std::uint32_t) { onReconfigure(config); });
  subscribe(node);
  sayWhatRuns();
}

HammerLoadsNode::~HammerLoadsNode() {
  bridge_.finishRun();
  if (!ledger_) return;
  const std::optional<std::string> problem = ledger_->close();
  if (!problem) return;
  const std::string text =
      *problem + "; " + std::to_string(ledger_->state().waiting) + " pieces of the count are not in it";
  if (ros::ok()) ROS_ERROR("%s", text.c_str());
  if (!ros::ok()) std::cerr << text << std::endl;  // the console is down
}

void HammerLoadsNode::subscribe(ros::NodeHandle& node) {
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  // Joint states first: where both arrive on one topic, a sample's own pitch counts for it.
  joint_states_ = node.subscribe("joint_states", kTopicQueue, &HammerLoadsNode::onJointStates, this, no_delay);
  if (bridge_.needsImu()) hull_imu_ = node.subscribe("hull_imu", kTopicQueue, &HammerLoadsNode::onImu, this, no_delay);
  subscribePressures(node);
  const auto transforms = [this](bool is_static) {
    return boost::function<void(const Event<tf2_msgs::TFMessage>&)>(
        [this, is_static](const Event<tf2_msgs::TFMessage>& event) { onTransforms(event, is_static); });
  };
  using Given = const Event<tf2_msgs::TFMessage>&;
  // A log stands alone: who replays it needs the static transforms, even if this node does not.
  tf_static_ = node.subscribe<tf2_msgs::TFMessage, Given>("/tf_static", kTopicQueue, transforms(true));
  if (bridge_.needsTransforms())
    tf_ = node.subscribe<tf2_msgs::TFMessage, Given>("/tf", kTopicQueue, transforms(false), {}, no_delay);
  // The crank last: a player of bags that waits for its subscriber then finds all others.
  crank_ = node.subscribe("crank", kTopicQueue, &HammerLoadsNode::onCrank, this, no_delay);
  joint_states_topic_ = joint_states_.getTopic();
  crank_topic_ = crank_.getTopic();
  hull_imu_topic_ = hull_imu_.getTopic();
  one_topic_ = joint_states_topic_ == crank_topic_;
  diagnostics_.watch({&crank_, &joint_states_, &hull_imu_});
}

void HammerLoadsNode::subscribePressures(ros::NodeHandle& node) {
  const std::string prefix = node.resolveName("cylinder_pressures");
  pressure_topics_ = HammerBridge::pressureTopics(bridge_.settings(), prefix);
  using Given = const Event<sensor_msgs::FluidPressure>&;
  for (std::size_t i = 0; i < pressure_topics_.size(); ++i) {
    const boost::function<void(Given)> take = [this, i](Given event) { onPressure(i, event); };
    pressures_.push_back(node.subscribe<sensor_msgs::FluidPressure, Given>(pressure_topics_[i].name, kTopicQueue, take,
                                                                           {}, ros::TransportHints().tcpNoDelay()));
    pressure_topics_[i].name = pressures_.back().getTopic();
  }
}

void HammerLoadsNode::sayWhatRuns() const {
  const Settings& settings = bridge_.settings();
  std::string notes;
  for (const std::string& note : settings.notes) notes += "; " + note;
  ROS_INFO("hammer: %s; level %s%s", settings.hammer_given ? "its own file" : "the shipped MO-100",
           nameOf(settings.pipeline.level), notes.c_str());
  ROS_INFO("log: %s", log_->isRecording() ? ("to " + settings.log.directory).c_str() : "not recording");
  if (ledger_) ROS_INFO("ledger of load cycles: %s", ledger_->path().c_str());
  ROS_INFO("waits for %s with joint %s, %s%s", crank_topic_.c_str(), settings.pipeline.crank_joint.c_str(),
           joint_states_topic_.c_str(), bridge_.needsImu() ? (", " + hull_imu_topic_).c_str() : "");
}

/// Late subscribers get the latched message; the log gets its own with the first input.
void HammerLoadsNode::announceRun() {
  RunInfo info = bridge_.outputs().run_info.message;
  info.header.stamp = ros::Time::now();
  run_info_.publish(info);
}

/// The next input begins a run, and its run_info replaces that of the run before.
void HammerLoadsNode::beginRun() {
  bridge_.reset();
  log_->forgetLatched(run_info_.getTopic());
}

/// What is in force, for the server: it does not know the shipped parameter files.
HammerLoadsConfig HammerLoadsNode::configInForce(bool log_enabled) const {
  const PipelineSettings& now = bridge_.settings().pipeline;
  HammerLoadsConfig config = HammerLoadsConfig::__getDefault__();
  config.log_enabled = log_enabled;
  config.output_rate_Hz = now.output_rate;
  config.tolerance = now.tolerance;
  config.withhold_above = now.withhold_above;
  return config;
}

/// A log that stopped by itself restarts only where that is asked for. The answer says what is in force.
void HammerLoadsNode::onReconfigure(HammerLoadsConfig& config) {
  const bool switched = config.log_enabled != config_.log_enabled;
  if (switched) switchLog(config.log_enabled);
  const bool changed = config.output_rate_Hz != config_.output_rate_Hz || config.tolerance != config_.tolerance ||
                       config.withhold_above != config_.withhold_above;
  const bool finite = std::isfinite(config.output_rate_Hz + config.tolerance + config.withhold_above);
  if (!finite) ROS_WARN("set_parameters: nan, must be numbers; nothing is changed");
  if (changed && finite) {
    bridge_.begin(withChanges(bridge_.settings(), {{"output_rate_Hz", config.output_rate_Hz},
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
  if (on != log_->isRecording()) bridge_.finishRun();
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
  log_->write(joint_states_topic_, record_time, *event.getConstMessage());
  bridge_.jointStates(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onCrank(const Event<JointState>& event) {
  const ros::Time record_time = one_topic_ ? clock_.last() : recordTime(event.getReceiptTime());
  diagnostics_.crankArrived();
  if (!one_topic_) log_->write(crank_topic_, record_time, *event.getConstMessage());
  bridge_.crank(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onImu(const Event<sensor_msgs::Imu>& event) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  log_->write(hull_imu_topic_, record_time, *event.getConstMessage());
  bridge_.hullImu(*event.getConstMessage(), record_time);
}

void HammerLoadsNode::onPressure(std::size_t topic, const Event<sensor_msgs::FluidPressure>& event) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  const HammerBridge::PressureTopic& from = pressure_topics_[topic];
  log_->write(from.name, record_time, *event.getConstMessage());
  bridge_.cylinderPressure(from.cylinder, from.chamber, *event.getConstMessage(), record_time);
}

void HammerLoadsNode::onTransforms(const Event<tf2_msgs::TFMessage>& event, bool is_static) {
  const ros::Time record_time = recordTime(event.getReceiptTime());
  const tf2_msgs::TFMessage& message = *event.getConstMessage();
  if (is_static) log_->writeLatched("/tf_static", record_time, message, event.getPublisherName());
  if (!is_static) log_->write("/tf", record_time, message);
  bridge_.transforms(message, is_static, record_time);
}

ros::Time HammerLoadsNode::recordTime(const ros::Time& arrival) {
  const RecordClock::Tick tick = clock_.next(arrival);
  if (tick.ran_back) {
    beginRun();
    log_->split();
  }
  return tick.time;
}

std::unique_ptr<LiveNode> makeHammerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                         std::vector<std::string>& problems) {
  const Checked<Settings> settings = loadPrivateParameters(private_node);
  problems = settings.problems;
  if (!settings.value) return nullptr;
  auto log = makeNodeLog(settings.value->log, private_node.getNamespace(), problems);
  if (!log) return nullptr;
  const InputTopics topics{node.resolveName("crank"), node.resolveName("joint_states"), node.resolveName("hull_imu"),
                           node.resolveName("cylinder_pressures")};
  return std::make_unique<HammerLoadsNode>(node, private_node, withInputTopics(*settings.value, topics),
                                           std::move(log));
}

}  // namespace hammer_loads
