#include "hammer_loads/ros/node_diagnostics.h"

#include <numeric>
#include <string>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/ros/log_diagnostics.h"
#include "hammer_loads/ros/steady_time.h"

namespace hammer_loads {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::uint64_t refusedTotal(const IntakeCounts& counts) {
  return std::accumulate(counts.refused.begin(), counts.refused.end(), std::uint64_t{0});
}

}  // namespace

NodeDiagnostics::NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const LoadsFlow& flow,
                                 const BagLog& log)
    : flow_(flow), updater_(node, private_node) {
  updater_.setHardwareID("none");
  updater_.add("crank", this, &NodeDiagnostics::describeCrank);
  updater_.add("hull pitch", this, &NodeDiagnostics::describePitch);
  if (flow.pipeline().boom()) updater_.add("boom", this, &NodeDiagnostics::describeBoom);
  if (flow.frameWrenches()) updater_.add("frames", this, &NodeDiagnostics::describeFrames);
  if (flow.needsImu()) updater_.add("hull imu", this, &NodeDiagnostics::describeImu);
  updater_.add("model", this, &NodeDiagnostics::describeModel);
  updater_.add("log", [&log](diagnostic_updater::DiagnosticStatusWrapper& status) { describeLog(log, status); });
  // Wall time: a stopped /clock is one of the things to report.
  timer_ =
      node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void NodeDiagnostics::describeCrank(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const Pipeline& pipeline = flow_.pipeline();
  const IntakeCounts& counts = pipeline.counts();
  const Clock::time_point now = Clock::now();
  const double elapsed = secondsBetween(last_report_, now);
  const double age = secondsBetween(last_crank_, now);
  const bool heard = last_crank_ != Clock::time_point{};
  const std::uint64_t accepted = counts.accepted - last_counts_.accepted;
  const std::uint64_t refused = refusedTotal(counts) - refusedTotal(last_counts_);
  if (!heard) {
    status.summary(DiagnosticStatus::WARN, "no crank sample yet");
  } else if (pipeline.unitCheck().looksLikeDegrees()) {
    status.summary(DiagnosticStatus::ERROR, "implausible: angle or speed seems to be in degrees, radians are agreed");
  } else if (pipeline.angleIsFrozen()) {
    status.summary(DiagnosticStatus::ERROR, "implausible: the angle stands still while the speed goes on");
  } else if (age > pipeline.settings().stale_after) {
    status.summaryf(DiagnosticStatus::ERROR, "stale: no crank sample for %.1f s, nothing is published", age);
  } else if (refused > 0) {
    status.summaryf(DiagnosticStatus::WARN, "%llu of %llu crank samples gave no wrench",
                    static_cast<unsigned long long>(refused), static_cast<unsigned long long>(refused + accepted));
  } else {
    status.summary(DiagnosticStatus::OK, "working");
  }
  status.add("accepted rate [Hz]", static_cast<double>(accepted) / elapsed);
  if (heard) status.add("age of the last sample [s]", age);
  status.add("accepted", counts.accepted);
  for (std::size_t i = 0; i < counts.refused.size(); ++i) {
    status.add(std::string("refused: ") + kRefusalNames[i], counts.refused[i]);
  }
  status.add("beginnings", counts.restarts);
  if (const auto* filter = dynamic_cast<const CrankFilter*>(&pipeline.tracker())) {
    status.add("drive inertia, identified [kg m2]", filter->state().drive_inertia);
    status.add("net torque [N m]", filter->state().torque);
    status.add("speed noise, identified [rad/s]", filter->speedNoise());
    status.add("angle finer than crank_angle_resolution_rad", filter->encoder().isFiner());
  }
  last_counts_ = counts;
  last_report_ = now;
}

void NodeDiagnostics::describePitch(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const HullPitch& pitch = flow_.pipeline().hullPitch();
  const auto unheard = pitch.unheard();
  if (unheard.empty()) {
    status.summary(DiagnosticStatus::OK, "known");
    if (pitch.looksLikeDegrees())
      status.summary(DiagnosticStatus::ERROR, "implausible: joint angles seem to be in degrees, radians are agreed");
  } else {
    std::string names;
    for (const std::string& name : unheard) names += " " + name;
    status.summary(DiagnosticStatus::WARN, "weight by hull_pitch_rad: joints not heard yet:" + names);
  }
  status.add("pitch [rad]", pitch.pitch());
  status.add("refused: not finite", pitch.refused());
  if (last_joint_states_ != Clock::time_point{})
    status.add("age of the last joint states [s]", secondsBetween(last_joint_states_, Clock::now()));
}

void NodeDiagnostics::describeImu(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ImuCounts& counts = flow_.pipeline().imuCounts();
  if (counts.missed > last_imu_counts_.missed) {
    status.summary(DiagnosticStatus::WARN, "hull's motion not known at every crank sample: weight by pitch there");
  } else {
    status.summary(DiagnosticStatus::OK, counts.accepted > 0 ? "working" : "no reading yet");
  }
  status.add("accepted", counts.accepted);
  for (std::size_t i = 0; i < counts.refused.size(); ++i)
    status.add(std::string("refused: ") + kImuRefusalNames[i], counts.refused[i]);
  status.add("crank samples without it", counts.missed);
  last_imu_counts_ = counts;
}

void NodeDiagnostics::describeModel(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (const auto& [name, level] : kLevelNames)
    if (level == flow_.settings().pipeline.level) status.summaryf(DiagnosticStatus::OK, "level %s", name);
  for (const std::string& note : flow_.settings().notes) status.add("note", note);
}

void NodeDiagnostics::describeBoom(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const BoomFollower& boom = *flow_.pipeline().boom();
  const BoomState& state = boom.state();
  const auto complaints = boom.joints().complaints(state.stamp);
  if (!complaints.empty()) {
    std::string text;
    for (const std::string& complaint : complaints) text += "; " + complaint;
    status.summary(DiagnosticStatus::WARN, "joint loads silent" + text);
  } else if (state.dead_point) {
    status.summary(DiagnosticStatus::WARN, "a cylinder is at its dead point: taken as rigid");
  } else {
    status.summary(DiagnosticStatus::OK, state.choice.compliant ? "compliant" : "rigid");
  }
  status.add("samples without known joints", boom.faults());
  status.add("error of a rigid boom for the last pulse [-]", state.choice.rigid_error);
  status.add("tolerance for it [-]", state.choice.rigid_tolerance);
  status.add("pulse length [s]", state.choice.pulse_length);
  status.add("lowest natural frequency [Hz]", state.choice.lowest_frequency);
  if (state.hold_down) {
    status.add("mean press force may grow by the factor [-]", state.hold_down->least);
    status.add("gives first", boom.firstToGive());
  }
  const JointRefusals& refusals = boom.joints().refusals();
  status.add("joint states refused: not finite", refusals.not_finite);
  status.add("joint states refused: short array", refusals.short_array);
  status.add("joint states refused: out of order", refusals.out_of_order);
}

void NodeDiagnostics::describeFrames(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const FrameWrenches& wrenches = *flow_.frameWrenches();
  status.summary(DiagnosticStatus::OK, "every frame known");
  bool silent = false;
  for (std::size_t i = 0; i < wrenches.frames().size(); ++i) {
    const std::string complaint = wrenches.complaint(i);
    if (!complaint.empty()) {
      status.summary(DiagnosticStatus::WARN, silent ? status.message + "; " + complaint : complaint);
      silent = true;
    }
    const FrameWrenchCounts counts = wrenches.counts(i);
    status.add(wrenches.frames()[i] + ": told", counts.told);
    status.add(wrenches.frames()[i] + ": dropped", counts.dropped + counts.crowded);
    status.add(wrenches.frames()[i] + ": waiting", counts.waiting);
  }
}

}  // namespace hammer_loads
