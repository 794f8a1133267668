#include "hammer_loads/grapple_ros/grapple_node.h"

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/grapple_ros/grapple_flow.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/ros/diagnostics_publisher.h"
#include "hammer_loads/ros/node_log.h"
#include "hammer_loads/ros/output.h"
#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

std::string limitText(const SliderLimit& limit) { return format("%.13g, %s", limit.slider, nameOf(limit.kind)); }

/// In `joint_states`; out, for each jaw, `~jaw_edge/left`, `~jaw_edge/left_twist`, `~jaw_edge/left_accel`, then
/// `~mechanism`, `~run_info` (latched), /diagnostics. One of each per accepted slider sample, with the sample's stamp.
class GrappleNode final : public LiveNode {
 public:
  /// log: recording, unless nothing shall be logged yet.
  GrappleNode(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleSettings& settings,
              std::unique_ptr<BagLog> log)
      : log_(std::move(log)),
        flow_(settings),
        run_info_(private_node.advertise<RunInfo>("run_info", 1, true)),
        diagnostics_(node, private_node, *log_, clock_, [] {}),
        log_services_(
            private_node, *log_, [] {}, [this] { beginRun(); }, [] {}) {
    diagnostics_.add("slider", this, &GrappleNode::describeSlider);
    diagnostics_.add("log", [this](DiagnosticStatusWrapper& status) { describeLog(*log_, status); });
    attachToNode(flow_.outputs(), private_node, *log_);
    RunInfo info = flow_.outputs().run_info.message;
    info.header.stamp = ros::Time::now();
    run_info_.publish(info);
    joint_states_ = node.subscribe("joint_states", kTopicQueue, &GrappleNode::onJointStates, this,
                                   ros::TransportHints().tcpNoDelay());
    topic_ = joint_states_.getTopic();
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// The next input begins a run, and its run_info replaces that of the run before.
  void beginRun() {
    flow_.reset();
    log_->forgetLatched(run_info_.getTopic());
  }
  void onJointStates(const ros::MessageEvent<const sensor_msgs::JointState>& event) {
    const RecordClock::Tick tick = clock_.next(event.getReceiptTime());
    if (tick.ran_back) {
      beginRun();
      log_->split();
    }
    if (log_->logsInputs()) log_->write(topic_, tick.time, *event.getConstMessage());
    const std::uint64_t foreign = flow_.messagesWithoutJoint();
    flow_.jointStates(*event.getConstMessage(), tick.time);
    if (flow_.messagesWithoutJoint() == foreign) last_slider_ = Clock::now();
  }
  /// Rate, age, counts of accepted and refused samples by reason, with the slider positions that are allowed.
  void describeSlider(DiagnosticStatusWrapper& status) {
    const Clock::time_point now = Clock::now();
    summarise(now, status);
    const GrappleTracker& tracker = flow_.tracker();
    status.add("accepted rate [Hz]",
               static_cast<double>(flow_.accepted() - last_accepted_) / secondsBetween(last_report_, now));
    if (last_slider_ != Clock::time_point{})
      status.add("age of the last sample [s]", secondsBetween(last_slider_, now));
    if (tracker.hasMotion()) status.add("slider position [m]", tracker.slider().position);
    if (tracker.hasMotion()) status.add("det J [m4]", tracker.motion().determinant);
    status.add("lower limit [m]", limitText(tracker.grapple().lowerLimit()));
    status.add("upper limit [m]", limitText(tracker.grapple().upperLimit()));
    status.add("accepted", flow_.accepted());
    status.add("accepted without velocity", flow_.withoutVelocity());
    status.add("accepted without acceleration", flow_.withoutAcceleration());
    for (const RefusalCount& refusal : flow_.refusals()) {
      status.add("refused: " + refusal.reason, refusal.count);
      if (!refusal.last.empty()) status.add("last refused: " + refusal.reason, refusal.last);
    }
    last_accepted_ = flow_.accepted();
    last_refused_ = flow_.refused();
    last_without_velocity_ = flow_.withoutVelocity();
    last_report_ = now;
  }
  void summarise(Clock::time_point now, DiagnosticStatusWrapper& status) const {
    const GrappleSettings& settings = flow_.settings();
    const std::uint64_t accepted = flow_.accepted() - last_accepted_, refused = flow_.refused() - last_refused_;
    const double age = secondsBetween(last_slider_, now);
    if (last_slider_ == Clock::time_point{}) {
      status.summary(DiagnosticStatus::WARN, "no sample of " + settings.slider_joint + " yet");
    } else if (age > settings.stale_after) {
      status.summaryf(DiagnosticStatus::ERROR, "stale: no slider sample for %.1f s, nothing is published", age);
    } else if (refused > 0) {
      status.summaryf(DiagnosticStatus::WARN, "%llu of %llu slider samples refused",
                      static_cast<unsigned long long>(refused), static_cast<unsigned long long>(refused + accepted));
    } else if (flow_.withoutVelocity() > last_without_velocity_) {
      status.summary(DiagnosticStatus::WARN, "no slider velocity: no twist and no accel is published");
    } else {
      status.summary(DiagnosticStatus::OK, "working");
    }
  }

  // A member stands before those that use it: the last members are destroyed first.
  std::unique_ptr<BagLog> log_;
  GrappleFlow flow_;
  RecordClock clock_;
  ros::Publisher run_info_;
  Clock::time_point last_slider_{};  ///< arrival of the last input with the slider joint
  Clock::time_point last_report_{Clock::now()};
  std::uint64_t last_accepted_{}, last_refused_{}, last_without_velocity_{};
  DiagnosticsPublisher diagnostics_;
  LogServices log_services_;
  ros::Subscriber joint_states_;
  std::string topic_;  ///< topic of joint_states_
};

}  // namespace

std::unique_ptr<LiveNode> makeGrappleNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems) {
  ParameterMap given = privateParameters(private_node, problems);
  given.erase("diagnostic_period");  // of diagnostic_updater
  const Checked<GrappleSettings> settings = behind(problems, loadGrappleSettings(configDirectory(), given));
  problems = settings.problems;
  if (!settings.value) return nullptr;
  auto log = makeNodeLog(settings.value->log, private_node.getNamespace(), problems);
  if (!log) return nullptr;
  return std::make_unique<GrappleNode>(node, private_node, *settings.value, std::move(log));
}

}  // namespace hammer_loads
