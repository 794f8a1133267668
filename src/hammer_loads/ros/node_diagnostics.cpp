#include "hammer_loads/ros/node_diagnostics.h"

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/ros/node_log.h"

namespace hammer_loads {

using diagnostic_msgs::DiagnosticStatus;

NodeDiagnostics::NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const HammerBridge& bridge,
                                 HammerInputs& inputs, BagLog& log, const RecordClock& clock,
                                 const life::LiveLedger* ledger)
    : bridge_(bridge), inputs_(inputs), log_(log), ledger_(ledger), publisher_(node, private_node, log, clock, [this] {
        warnOnConsole();
      }) {
  publisher_.add("inputs", this, &NodeDiagnostics::describeInputs);
  publisher_.add("crank", this, &NodeDiagnostics::describeCrank);
  publisher_.add("hull pitch", this, &NodeDiagnostics::describePitch);
  if (bridge.pipeline().boom()) publisher_.add("boom", this, &NodeDiagnostics::describeBoom);
  if (bridge.frameWrenches()) publisher_.add("frames", this, &NodeDiagnostics::describeFrames);
  if (inputs.hull_imu.wanted) publisher_.add("hull imu", this, &NodeDiagnostics::describeImu);
  publisher_.add("model", this, &NodeDiagnostics::describeModel);
  publisher_.add("misuse", this, &NodeDiagnostics::describeMisuse);
  publisher_.add("life", this, &NodeDiagnostics::describeLife);
  if (bridge.limits()) publisher_.add("limits", this, &NodeDiagnostics::describeLimits);
  publisher_.add("reference", this, &NodeDiagnostics::describeReference);
  publisher_.add("log", [&log](Status& status) { describeLog(log, status); });
}

/// Prints each new warning on the console. An awaited input is reported only if it has not come by the next report
/// either. A log that stops by itself is also reported.
void NodeDiagnostics::warnOnConsole() {
  std::set<std::string> awaited;
  for (const Warning& warning : warnings()) {
    if (warning.awaited) awaited.insert(warning.key);
    if (warning.awaited && awaited_.count(warning.key) == 0) continue;
    if (stated_.insert(warning.key).second) ROS_WARN("%s", warning.text.c_str());
  }
  awaited_ = std::move(awaited);
  const LogHealth health = log_.health();
  const bool stopped = health.state == LogState::kDiskFull || health.state == LogState::kFailed;
  if (stopped && health.state != log_state_) ROS_ERROR("log stopped: %s", health.reason.c_str());
  log_state_ = health.state;
}

std::vector<Warning> NodeDiagnostics::warnings() {
  std::vector<Warning> warnings = warningsOf(bridge_.pipeline());
  for (const Warning& warning : bridge_.life().warnings()) warnings.push_back(warning);
  if (const auto warning = ledgerWarning()) warnings.push_back(*warning);
  if (!bridge_.settings().hammer_given)
    warnings.push_back({"hammer", "no hammer file was given: the masses and lengths of the MO-100 are used", true});
  std::uint64_t missing = 0;
  inputs_.forEachSensor([&](const auto& input) {
    const std::uint32_t count = input.subscriber.getNumPublishers();
    if (count > 1)
      warnings.push_back({"publishers", input.topic + ": " + std::to_string(count) + " publishers, must be one", true});
    missing += input.missing.count();
  });
  if (missing > 0)
    warnings.push_back({"missing messages", "inputs: " + std::to_string(missing) +
                                                " messages never came (header.seq), for machine or network is "
                                                "overloaded: lower the load or the rates"});
  return warnings;
}

void NodeDiagnostics::describeInputs(Status& status) {
  const std::vector<Warning> all = warnings();
  status.summary(DiagnosticStatus::OK, "as they should be");
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 0) status.summary(DiagnosticStatus::WARN, all[i].text);
    status.add(all[i].key, all[i].text);
  }
  inputs_.forEachSensor([&](const auto& input) {
    if (input.missing.count() > 0) status.add("never came: " + input.topic, input.missing.count());
  });
}

void NodeDiagnostics::describeCrank(Status& status) {
  const Pipeline& pipeline = bridge_.pipeline();
  const SampleCounts counts = pipeline.counts();
  const Clock::time_point now = Clock::now();
  const double elapsed = secondsBetween(last_report_, now);
  const double age = secondsBetween(inputs_.crank.arrived, now);
  const bool heard = inputs_.crank.arrived != Clock::time_point{};
  const std::uint64_t accepted = counts.accepted - last_counts_.accepted;
  const std::uint64_t refused = counts.refusedTotal() - last_counts_.refusedTotal();
  if (!heard) {
    status.summary(DiagnosticStatus::WARN, "no crank sample yet");
  } else if (pipeline.crank().unit() != CrankUnit::kRadians) {
    status.summary(DiagnosticStatus::ERROR,
                   std::string("implausible: ") + textOf(pipeline.crank().unit()) + "; nothing is published");
  } else if (pipeline.crankTrust().turnsBackward()) {
    status.summary(DiagnosticStatus::ERROR,
                   "turns backward: crank_direction must have the other sign; nothing is published");
  } else if (pipeline.crankTrust().isLost()) {
    status.summary(DiagnosticStatus::ERROR,
                   "the estimate is lost before the blow, turn after turn; nothing is published");
  } else if (pipeline.crankTrust().isInconsistent()) {
    status.summaryf(DiagnosticStatus::ERROR,
                    "readings contradict the model by %.1f times the expected variance before the blow; nothing is "
                    "published",
                    pipeline.crank().tracker().strikeConsistency());
  } else if (pipeline.crank().angleIsFrozen()) {
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
  if (heard) status.add(kLastSampleKey, pipeline.result().sample_stamp);
  status.add("accepted", counts.accepted);
  for (std::size_t i = 0; i < counts.refused.size(); ++i) {
    status.add(std::string("refused: ") + kRefusalNames[i], counts.refused[i]);
  }
  status.add("not published, closer to the blow than the angle is known", counts.beside_blow);
  status.add("not published: standard deviation of a force too large", counts.uncertain);
  status.add("restarts", counts.restarts);
  status.add("blows", counts.blows);
  status.add("blows with an impossible restitution or energy, not counted", counts.impossible_blows);
  status.add("passages of the blow backward", counts.backward_passes);
  const CrankFilter& filter = pipeline.crank().tracker();
  status.add("drive inertia, identified [kg m2]", filter.state().drive_inertia);
  status.add("net torque [N m]", filter.state().torque);
  status.add("speed noise, identified [rad/s]", filter.speedNoise());
  status.add("jitter of the stamps, identified [s]", filter.timingNoise());
  status.add("encoder count in use [rad]", filter.encoder().resolution());
  status.add("consistency: mean of innovation^2 over its variance [-]", filter.consistency());
  last_counts_ = counts;
  last_report_ = now;
}

void NodeDiagnostics::describePitch(Status& status) {
  const HullPitch& pitch = bridge_.pipeline().hull().pitch();
  const auto unheard = pitch.unheard();
  if (unheard.empty()) {
    status.summary(DiagnosticStatus::OK, "known");
    if (pitch.looksLikeDegrees())
      status.summary(DiagnosticStatus::ERROR,
                     "implausible: joint angles seem to be in degrees, must be in radians; nothing is published");
  } else {
    std::string names;
    for (const std::string& name : unheard) names += " " + name;
    status.summary(DiagnosticStatus::WARN, "weight by hull_pitch_rad: joints that have not come yet:" + names);
  }
  status.add("pitch [rad]", pitch.pitch());
  status.add("refused: not finite", pitch.refused());
  if (inputs_.joint_states.arrived != Clock::time_point{})
    status.add("age of the last joint states [s]", secondsBetween(inputs_.joint_states.arrived, Clock::now()));
}

void NodeDiagnostics::describeImu(Status& status) {
  const ImuCounts& counts = bridge_.pipeline().hull().imuCounts();
  if (bridge_.pipeline().hull().imuTrust().isLost()) {
    status.summary(DiagnosticStatus::WARN, "not used: readings do not fit an IMU mounted as in imu_*");
  } else if (counts.missed > last_imu_counts_.missed) {
    status.summary(
        DiagnosticStatus::WARN,
        "silent at some crank samples: weight by pitch there, vibration by the model if its oil is identified");
  } else {
    status.summary(DiagnosticStatus::OK, counts.accepted > 0 ? "working" : "no reading yet");
  }
  status.add("accepted", counts.accepted);
  for (std::size_t i = 0; i < counts.refused.size(); ++i)
    status.add(std::string("refused: ") + kImuRefusalNames[i], counts.refused[i]);
  status.add("crank samples without it", counts.missed);
  last_imu_counts_ = counts;
}

void NodeDiagnostics::describeModel(Status& status) {
  const ElasticFollower& elastic = bridge_.pipeline().elastic();
  const bool falls_back = bridge_.settings().pipeline.level == Level::kElastic && !elastic.isUsed();
  status.summaryf(DiagnosticStatus::OK, "level %s",
                  nameOf(falls_back ? Level::kLinkage : bridge_.settings().pipeline.level));
  if (falls_back) status.add("elastic is not used", elastic.whyNotUsed());
  for (const std::string& note : bridge_.settings().notes) status.add("note", note);
}

/// Describes the misuse counts. A count that nothing measures is reported as unknown, which differs from zero.
void NodeDiagnostics::describeMisuse(Status& status) {
  const MisuseCounts counts = bridge_.pipeline().counts().misuse;
  const double hours = counts.work_time / 3600.0;
  const auto add = [&](const std::string& name, double value) {
    status.add(name, value);
    if (hours > 0.0) status.add(name + ", per hour", value / hours);
  };
  status.summary(DiagnosticStatus::OK, "counted");
  status.add("time at work [s]", counts.work_time);
  add("blank firing", static_cast<double>(counts.blank_firings));
  if (counts.withoutHoldDown()) {
    add("blows without hold-down force on the rock", static_cast<double>(*counts.withoutHoldDown()));
    status.add("blows whose hold-down force is measured", counts.judged_blows);
  } else {
    status.add("blows without hold-down force on the rock", "not known: needs cylinder pressures");
  }
  if (counts.still())
    add("hammering without penetration [s]", *counts.still());
  else
    status.add("hammering without penetration [s]", "not known: needs the boom's joints and its description");
}

void NodeDiagnostics::describeBoom(Status& status) {
  const BoomFollower& boom = *bridge_.pipeline().boom();
  const BoomState& state = boom.state();
  // Joints are checked at the last crank sample, so that a stopped crank is no fault of theirs.
  const bool none_yet = inputs_.crank.arrived == Clock::time_point{};
  const std::vector<std::string> complaints = boom.complaints();
  if (none_yet) {
    status.summary(DiagnosticStatus::WARN, "waits for crank samples");
  } else if (!complaints.empty()) {
    std::string text;
    for (const std::string& complaint : complaints) text += "; " + complaint;
    status.summary(DiagnosticStatus::WARN, "no joint loads" + text);
  } else if (state.fault && state.fault->kind == JointFault::Kind::kRunAway) {
    status.summary(DiagnosticStatus::WARN, "no joint loads: the vibration was implausible and was reset");
  } else if (state.useless) {
    status.summary(DiagnosticStatus::WARN, "no joint loads: their standard deviations are as large as the loads");
  } else if (state.zero_moment_arm) {
    status.summary(DiagnosticStatus::WARN, "a cylinder has a zero moment arm: the boom is taken as rigid");
  } else {
    status.summary(DiagnosticStatus::OK, state.choice.compliant ? "compliant" : "rigid");
  }
  status.add("samples without known joints", boom.faults());
  status.add("samples whose joint loads are withheld", boom.useless());
  status.add("vibration ran away", boom.divergences());
  status.add("error of a rigid boom for the last pulse [-]", state.choice.rigid_error);
  status.add("tolerance for it [-]", state.choice.rigid_tolerance);
  status.add("pulse length [s]", state.choice.pulse_length);
  status.add("lowest natural frequency [Hz]", state.choice.lowest_frequency);
  if (state.hold_down) {
    status.add("mean hold-down force may grow by the factor [-]", state.hold_down->least);
    status.add("gives first", boom.firstToGive());
  }
  const JointRefusals& refusals = boom.joints().refusals();
  status.add("joint states refused: not finite", refusals.not_finite);
  status.add("joint states refused: short array", refusals.short_array);
  status.add("joint states refused: out of order", refusals.out_of_order);
  status.add("joint states refused: jumps", refusals.jumps);
}

void NodeDiagnostics::describeFrames(Status& status) {
  const FrameWrenches& wrenches = *bridge_.frameWrenches();
  bool silent = false, used = false;
  for (std::size_t i = 0; i < wrenches.frames().size(); ++i) {
    const std::string complaint = wrenches.complaint(i);
    if (!complaint.empty()) {
      status.summary(DiagnosticStatus::WARN, silent ? status.message + "; " + complaint : complaint);
      silent = true;
    }
    const FrameWrenchCounts counts = wrenches.counts(i);
    status.add(wrenches.frames()[i] + ": published", counts.published);
    status.add(wrenches.frames()[i] + ": dropped", counts.dropped);
    status.add(wrenches.frames()[i] + ": waiting", counts.waiting);
    used = used || counts.published + counts.dropped + counts.waiting > 0;
  }
  if (!silent) status.summary(DiagnosticStatus::OK, used ? "every frame known" : "not computed: no subscriber, no log");
}

}  // namespace hammer_loads
