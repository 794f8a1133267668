#include <dynamic_reconfigure/server.h>
#include <hammer_loads/HammerLoadsConfig.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <boost/thread/recursive_mutex.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/ros/live_node.h"
#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/ros/node_log.h"
#include "hammer_loads/ros/output.h"
#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

/// Live node with the topics of the contract. By default, it sends one wrench per accepted crank sample, with its
/// stamp. Services `~log/...` and dynamic_reconfigure change what may safely change; each change begins a new run.
class HammerLoadsNode final : public LiveNode {
 public:
  /// log: already started if settings.log.enabled. ledger: null if none is kept.
  HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                  std::unique_ptr<BagLog> log, std::unique_ptr<life::LiveLedger> ledger)
      : log_(std::move(log)),
        ledger_(std::move(ledger)),
        bridge_(settings, ledger_.get()),
        inputs_(settings),
        run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
        config_(configInForce(log_->isRecording())),
        diagnostics_(node, private_node, bridge_, inputs_, *log_, clock_, ledger_.get()),
        reconfigure_(reconfigure_mutex_, private_node),
        log_services_(
            private_node, *log_, [this] { bridge_.finishRun(); }, [this] { beginRun(); }, [this] { logSwitched(); }) {
    attachToNode(bridge_.outputs(), private_node, *log_);
    announceRun();
    reconfigure_.updateConfig(config_);
    reconfigure_.setCallback([this](HammerLoadsConfig& config, std::uint32_t) { onReconfigure(config); });
    inputs_.forEach([this, &node](auto& input) { subscribe(node, input); });
    sayWhatRuns();
  }
  /// Ends the run and writes the rest to log and ledger.
  ~HammerLoadsNode() override {
    inputs_.forEach([](auto& input) { input.subscriber.shutdown(); });
    bridge_.finishRun();
    if (!ledger_) return;
    const std::optional<std::string> problem = ledger_->close();
    if (!problem) return;
    const std::string text =
        *problem + "; " + std::to_string(ledger_->state().waiting) + " pieces of the count are not in it";
    if (ros::ok()) ROS_ERROR("%s", text.c_str());
    if (!ros::ok()) std::cerr << text << std::endl;  // the ROS console is shut down
  }

 private:
  template <typename Message>
  using Event = ros::MessageEvent<const Message>;

  template <typename Message>
  void subscribe(ros::NodeHandle& node, Input<Message>& input) {
    using Given = const Event<Message>&;
    // A log must be complete: its replay needs the latched messages even if this node does not.
    if (!input.wanted && !input.latched) return;
    const boost::function<void(Given)> arrived = [this, &input](Given event) { take(input, event); };
    input.subscriber = node.subscribe<Message, Given>(input.topic, kTopicQueue, arrived, {},
                                                      ros::TransportHints().tcpNoDelay(!input.latched));
    input.topic = input.subscriber.getTopic();
  }
  template <typename Message>
  void take(Input<Message>& input, const Event<Message>& event) {
    // If both have the same topic, the message has already arrived as joint states.
    const bool again = static_cast<const void*>(&input) == &inputs_.crank && input.topic == inputs_.joint_states.topic;
    const ros::Time record_time = again ? clock_.last() : recordTime(event.getReceiptTime());
    const Message& message = *event.getConstMessage();
    input.arrived = std::chrono::steady_clock::now();
    // With simulated time, a bag may be played, whose topics can have several publishers.
    if constexpr (ros::message_traits::HasHeader<Message>::value)
      if (!again && !ros::Time::isSimTime()) input.missing.take(event.getPublisherName(), message.header.seq);
    if (log_->logsInputs()) {
      if (input.latched) log_->writeLatched(input.topic, record_time, message, event.getPublisherName());
      if (!input.latched && !again) log_->write(input.topic, record_time, message);
    }
    input.take(bridge_, message, record_time);
  }
  void sayWhatRuns() const {
    const Settings& settings = bridge_.settings();
    std::string notes;
    for (const std::string& note : settings.notes) notes += "; " + note;
    ROS_INFO("hammer: %s; level %s%s", settings.hammer_given ? "its own file" : "the shipped MO-100",
             nameOf(settings.pipeline.level), notes.c_str());
    ROS_INFO("log: %s%s", log_->isRecording() ? ("to " + settings.log.directory).c_str() : "not recording",
             log_->logsInputs() ? "" : ", without the inputs: its outputs cannot be computed again");
    if (ledger_) ROS_INFO("ledger of load cycles: %s", ledger_->path().c_str());
    const std::string imu = inputs_.hull_imu.wanted ? ", " + inputs_.hull_imu.topic : "";
    ROS_INFO("waits for %s with joint %s, %s%s", inputs_.crank.topic.c_str(), settings.pipeline.crank_joint.c_str(),
             inputs_.joint_states.topic.c_str(), imu.c_str());
  }
  /// Publishes run_info for late subscribers. The log gets its own one with the first input.
  void announceRun() {
    RunInfo info = bridge_.outputs().run_info.message;
    info.header.stamp = ros::Time::now();
    run_info_.publish(info);
  }
  /// Begins a run with the next input. Its run_info replaces that of the previous run.
  void beginRun() {
    bridge_.reset();
    log_->forgetLatched(run_info_.getTopic());
  }
  /// Applies a requested configuration. The answer contains the configuration in force.
  void onReconfigure(HammerLoadsConfig& config) {
    const bool switched = config.log_enabled != config_.log_enabled;
    if (switched) switchLog(config.log_enabled);
    const bool changed = config.output_rate_Hz != config_.output_rate_Hz || config.tolerance != config_.tolerance ||
                         config.withhold_above != config_.withhold_above;
    Checked<Settings> settings;
    if (changed)
      settings = withChanges(bridge_.settings(), {{"output_rate_Hz", config.output_rate_Hz},
                                                  {"tolerance", config.tolerance},
                                                  {"withhold_above", config.withhold_above}});
    for (const std::string& problem : settings.problems)
      ROS_WARN("set_parameters: %s; nothing is changed", problem.c_str());
    if (settings.value) {
      bridge_.begin(*std::move(settings.value));
      log_->forgetLatched(run_info_.getTopic());
      if (!switched) log_->split();
      announceRun();
      config_ = configInForce(config_.log_enabled);
    }
    config = config_;
  }
  void switchLog(bool on) {
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
  /// Updates the configuration after a service has switched the log.
  void logSwitched() {
    config_.log_enabled = log_->isRecording();
    reconfigure_.updateConfig(config_);
  }
  /// Returns the configuration in force for the server, which does not know the shipped parameter files.
  HammerLoadsConfig configInForce(bool log_enabled) const {
    const PipelineSettings& now = bridge_.settings().pipeline;
    HammerLoadsConfig config = HammerLoadsConfig::__getDefault__();
    config.log_enabled = log_enabled;
    config.output_rate_Hz = now.output_rate;
    config.tolerance = now.tolerance;
    config.withhold_above = now.withhold_above;
    return config;
  }
  ros::Time recordTime(const ros::Time& arrival) {
    const RecordClock::Tick tick = clock_.next(arrival);
    if (tick.ran_back) {
      beginRun();
      log_->split();
    }
    return tick.time;
  }

  // Each member is declared before those that use it, because the last members are destroyed first.
  std::unique_ptr<BagLog> log_;
  std::unique_ptr<life::LiveLedger> ledger_;  ///< null: none is kept
  HammerBridge bridge_;
  HammerInputs inputs_;
  RecordClock clock_;
  ros::Publisher run_info_;
  HammerLoadsConfig config_;  ///< in force
  NodeDiagnostics diagnostics_;
  boost::recursive_mutex reconfigure_mutex_;
  dynamic_reconfigure::Server<HammerLoadsConfig> reconfigure_;
  LogServices log_services_;
};

}  // namespace

std::unique_ptr<LiveNode> makeHammerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                         std::vector<std::string>& problems) {
  const Checked<Settings> settings = loadPrivateParameters(private_node);
  problems = settings.problems;
  if (!settings.value) return nullptr;
  auto log = makeNodeLog(settings.value->log, private_node.getNamespace(), problems);
  if (!log) return nullptr;
  std::unique_ptr<life::LiveLedger> ledger;
  if (!settings.value->life.ledger.empty()) {
    Checked<std::unique_ptr<life::LiveLedger>> loaded = life::loadLedger(settings.value->life.ledger);
    problems = loaded.problems;
    if (!loaded.value) return nullptr;
    ledger = *std::move(loaded.value);
  }
  const InputTopics topics = inputTopics([&node](const InputName& input) { return node.resolveName(input.name); });
  return std::make_unique<HammerLoadsNode>(node, private_node, withInputTopics(*settings.value, topics), std::move(log),
                                           std::move(ledger));
}

}  // namespace hammer_loads
