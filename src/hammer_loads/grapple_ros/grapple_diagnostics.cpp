#include "hammer_loads/grapple_ros/grapple_diagnostics.h"

#include <string>

#include "hammer_loads/ros/log_diagnostics.h"
#include "hammer_loads/ros/steady_time.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string limitText(const SliderLimit& limit) { return format("%.13g, %s", limit.slider, nameOf(limit.kind)); }

}  // namespace

GrappleDiagnostics::GrappleDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleFlow& flow,
                                       BagLog& log, const RecordClock& clock)
    : flow_(flow), publisher_(node, private_node, log, clock) {
  publisher_.add("slider", this, &GrappleDiagnostics::describeSlider);
  publisher_.add("log", [&log](diagnostic_updater::DiagnosticStatusWrapper& status) { describeLog(log, status); });
  // Wall time: a stopped /clock is one of the things to report.
  timer_ = node.createWallTimer(ros::WallDuration(publisher_.period()),
                                [this](const ros::WallTimerEvent&) { publisher_.publish(); });
}

void GrappleDiagnostics::summarise(Clock::time_point now, diagnostic_updater::DiagnosticStatusWrapper& status) const {
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

void GrappleDiagnostics::describeSlider(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const Clock::time_point now = Clock::now();
  summarise(now, status);
  const GrappleTracker& tracker = flow_.tracker();
  status.add("accepted rate [Hz]",
             static_cast<double>(flow_.accepted() - last_accepted_) / secondsBetween(last_report_, now));
  if (last_slider_ != Clock::time_point{}) status.add("age of the last sample [s]", secondsBetween(last_slider_, now));
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

}  // namespace hammer_loads
