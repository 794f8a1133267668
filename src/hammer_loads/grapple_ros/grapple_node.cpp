#include "hammer_loads/grapple_ros/grapple_node.h"

#include <utility>

#include "hammer_loads/ros/attach.h"
#include "hammer_loads/ros/node_log.h"
#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
GrappleNode::GrappleNode(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleSettings& settings,
                         std::unique_ptr<BagLog> log)
    : log_(std::move(log)),
      flow_(settings),
      run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
      diagnostics_(node, private_node, flow_, *log_, clock_),
      log_services_(
          private_node, *log_, [] {}, [this] { beginRun(); }, [] {}) {
  attachToNode(flow_.outputs(), private_node, *log_);
  RunInfo info = flow_.outputs().run_info.message;
  info.header.stamp = ros::Time::now();
  run_info_.publish(info);
  joint_states_ = node.subscribe("joint_states", kTopicQueue, &GrappleNode::onJointStates, this,
                                 ros::TransportHints().tcpNoDelay());
  topic_ = joint_states_.getTopic();
}

void GrappleNode::onJointStates(const ros::MessageEvent<const sensor_msgs::JointState>& event) {
  const RecordClock::Tick tick = clock_.next(event.getReceiptTime());
  if (tick.ran_back) {
    beginRun();
    log_->split();
  }
  if (log_->logsInputs()) log_->write(topic_, tick.time, *event.getConstMessage());
  const std::uint64_t foreign = flow_.messagesWithoutJoint();
  flow_.jointStates(*event.getConstMessage(), tick.time);
  if (flow_.messagesWithoutJoint() == foreign) diagnostics_.sliderArrived();
}

/// The next input begins a run, and its run_info replaces that of the run before.
void GrappleNode::beginRun() {
  flow_.reset();
  log_->forgetLatched(run_info_.getTopic());
}

std::unique_ptr<LiveNode> makeGrappleNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems) {
  ParameterMap given = privateParameters(private_node, problems);
  given.erase("diagnostic_period");  // of diagnostic_updater
  const Checked<GrappleSettings> settings = loadGrappleSettings(configDirectory(), given);
  problems.insert(problems.end(), settings.problems.begin(), settings.problems.end());
  if (!problems.empty()) return nullptr;
  auto log = makeNodeLog(settings.value->log, private_node.getNamespace(), problems);
  if (!log) return nullptr;
  return std::make_unique<GrappleNode>(node, private_node, *settings.value, std::move(log));
}

}  // namespace hammer_loads
