#include "hammer_loads/ros/node_diagnostics.h"

#include <numeric>
#include <string>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/ros/log_diagnostics.h"

namespace hammer_loads {
namespace {

using diagnostic_msgs::DiagnosticStatus;

double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

std::uint64_t refusedTotal(const IntakeCounts& counts) {
  return std::accumulate(counts.refused.begin(), counts.refused.end(), std::uint64_t{0});
}

}  // namespace

NodeDiagnostics::NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const Pipeline& pipeline,
                                 const BagLog* log, const std::vector<std::string>& notes)
    : pipeline_(pipeline), notes_(notes), updater_(node, private_node) {
  updater_.setHardwareID("none");
  updater_.add("crank", this, &NodeDiagnostics::describeCrank);
  updater_.add("hull pitch", this, &NodeDiagnostics::describePitch);
  updater_.add("model", this, &NodeDiagnostics::describeModel);
  updater_.add("log", [log](diagnostic_updater::DiagnosticStatusWrapper& status) { describeLog(log, status); });
  // Wall time: a stopped /clock is one of the things to report.
  timer_ = node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void NodeDiagnostics::describeCrank(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const IntakeCounts& counts = pipeline_.counts();
  const Clock::time_point now = Clock::now();
  const double elapsed = secondsBetween(last_report_, now);
  const double age = secondsBetween(last_crank_, now);
  const bool heard = last_crank_ != Clock::time_point{};
  const std::uint64_t accepted = counts.accepted - last_counts_.accepted;
  const std::uint64_t refused = refusedTotal(counts) - refusedTotal(last_counts_);
  if (!heard) {
    status.summary(DiagnosticStatus::WARN, "no crank sample yet");
  } else if (age > pipeline_.settings().stale_after) {
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
  if (const auto* filter = dynamic_cast<const CrankFilter*>(&pipeline_.tracker())) {
    status.add("drive inertia, identified [kg m2]", filter->state().drive_inertia);
    status.add("net torque [N m]", filter->state().torque);
    status.add("speed noise, identified [rad/s]", filter->speedNoise());
    status.add("angle finer than crank_angle_resolution_rad", filter->encoder().isFiner());
  }
  last_counts_ = counts;
  last_report_ = now;
}

void NodeDiagnostics::describePitch(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const HullPitch& pitch = pipeline_.hullPitch();
  const auto unheard = pitch.unheard();
  if (unheard.empty()) {
    status.summary(DiagnosticStatus::OK, "known");
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

void NodeDiagnostics::describeModel(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (const auto& [name, level] : kLevelNames)
    if (level == pipeline_.settings().level) status.summaryf(DiagnosticStatus::OK, "level %s", name);
  for (const std::string& note : notes_) status.add("note", note);
}

}  // namespace hammer_loads
