#include "hammer_loads/ros/bag_tables.h"

#include <algorithm>
#include <sstream>
#include <string>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/boom_health.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/ros/version.h"
#include "hammer_loads/settings/hammer_parameters.h"
#include "hammer_loads/settings/parameter_texts.h"
#include "hammer_loads/tables/sha256.h"
#include "hammer_loads/util/digest.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Removes paths, since the places of a node's log and ledger are no property of the machine. yaml: one key per line.
std::string withoutPaths(const std::string& yaml) {
  std::istringstream lines(yaml);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(':'));
    if (key.rfind("log_", 0) != 0 && key != "life_ledger") kept += line + '\n';
  }
  return kept;
}

/// Adds the deviations that no file gives, since a test report states the uncertainty of every input.
void addUsualDeviations(const HammerParameters& hammer, RunRecord& record) {
  for (const auto& [key, deviation] : deviationsInForce(hammer)) {
    const auto has_key = [&key = key](const RunRecord::Parameter& p) { return p.key == key; };
    if (!(deviation > 0.0) || std::any_of(record.parameters.begin(), record.parameters.end(), has_key)) continue;
    const std::string value = format("%.3g", deviation);
    record.parameters.push_back({key, value, value});
  }
}

/// The run's record at its beginning.
RunRecord recordOf(const Settings& settings, const std::string& input_sha256) {
  RunRecord record;
  const std::string yaml = withoutPaths(settings.yaml);
  const std::vector<ParameterText> parameters = parameterTexts(configDirectory(), yaml);
  record.input_sha256 = input_sha256;
  record.parameters_sha256 = sha256Of({yaml, settings.robot_description});
  record.machine = digestOf(settings.machine);
  record.version = packageVersion();
  record.revision = packageRevision();
  record.parameters_yaml = yaml;
  record.equivalent_cycles_per_hour = settings.life.equivalent_cycles_per_hour;
  record.level = nameOf(settings.pipeline.level);
  for (const ParameterText& parameter : parameters)
    record.parameters.push_back({parameter.key, parameter.value, parameter.shipped});
  addUsualDeviations(settings.mechanism.parameters(), record);
  return record;
}

void addCounts(const SampleCounts& counts, RunRecord& record) {
  record.restarts = counts.restarts;
  record.backward_passes = counts.backward_passes;
  record.blank_firings = counts.misuse.blank_firings;
  record.judged_blows = counts.misuse.judged_blows;
  record.blows_without_hold_down = counts.misuse.withoutHoldDown();
  record.still_time = counts.misuse.still().value_or(RunRecord::kUnknown);
  for (std::size_t i = 0; i < counts.refused.size(); ++i)
    record.refusals.push_back({kRefusalNames[i], counts.refused[i]});
  record.refusals.push_back({"beside the blow", counts.beside_blow});
  record.refusals.push_back({"uncertain", counts.uncertain});
}

/// Numbers that the filter has learned by the end of the run.
void addLearned(const CrankFilter& filter, RunRecord& record) {
  record.consistency = filter.consistency();
  record.angle_resolution = filter.angleResolution();
  record.timing_noise = filter.timingNoise();
  record.speed_noise = filter.speedNoise();
  record.drive_inertia = filter.driveInertia();
  record.drive_inertia_relative_std = filter.blowFactor().inertia_std;
}

}  // namespace

BagTables::BagTables(const std::string& file, const std::vector<std::string>& inputs)
    : input_sha256_(sha256OfFiles(inputs)),
      pulse_(numberFieldsOf<Pulse>()),
      blow_(numberFieldsOf<Blow>()),
      writer_(file, pulse_.columns(), blow_.columns()) {}

void BagTables::begin(HammerBridge& bridge) {
  records_.push_back(recordOf(bridge.settings(), input_sha256_));
  traces_ = {};
  longest_step_ = bridge.settings().pipeline.stale_after;
  life_.begin(bridge, run());
  HammerOutputs& outputs = bridge.outputs();
  outputs.hull_loads.attach([this](const HullLoads& message, const ros::Time&) { takeSample(message); });
  outputs.pulse.attach(
      [this, &bridge](const Pulse& message, const ros::Time&) { takePulse(message, bridge.pipeline()); });
  outputs.blow.attach([this](const Blow& message, const ros::Time&) {
    writer_.blow(run(), {message.turn, stampOf(message.header.stamp), blow_.valuesOf(message)});
  });
}

void BagTables::takeSample(const HullLoads& message) {
  const StampNs stamp = stampOf(message.header.stamp);
  RunRecord& record = records_.back();
  if (!record.first_stamp) record.first_stamp = stamp;
  const double step = record.last_stamp ? seconds(stamp - *record.last_stamp) : 0.0;
  if (step > 0.0 && step <= longest_step_) record.duration += step;
  record.last_stamp = stamp;
  traces_.add({stamp, message.force_x, message.force_z, message.torque_y, message.force_z_std, message.crank_angle});
}

void BagTables::takeHealth(std::uint64_t turn, const BoomFollower& boom) {
  const std::optional<BoomHealth> health = boomHealth(boom);
  if (!health) return;
  for (int i = 0; i < health->count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const BoomHealth::OfCylinder& c = health->cylinder[at];
    writer_.boomCylinder(run(), {turn, boom.boom().cylinders()[at].parameters().name, c.joint_angle, c.stiffness,
                                 c.deviation, !health->oil_explains});
    const BoomHealth::OfMode& m = health->mode[at];
    writer_.boomMode(run(), {turn, i + 1, m.frequency, m.deviation, m.damping, m.damping_std});
  }
}

void BagTables::takePulse(const Pulse& message, const Pipeline& pipeline) {
  const StampNs stamp = stampOf(message.header.stamp);
  writer_.turn(run(), {message.turn, stamp, pulse_.valuesOf(message)});
  traces_.turnEnded(message.turn, stamp, message.period, message.amplitude);
  if (pipeline.boom()) takeHealth(message.turn, *pipeline.boom());
}

void BagTables::end(const HammerBridge& bridge, std::uint64_t samples) {
  RunRecord& record = records_.back();
  record.samples = samples;
  record.published = bridge.outputs().hull_loads.sent();
  record.turns = bridge.outputs().pulse.sent();
  record.blows = bridge.outputs().blow.sent();
  addCounts(bridge.pipeline().counts(), record);
  addLearned(bridge.pipeline().crank().tracker(), record);
  record.hull_pitch = bridge.pipeline().hull().pitch().pitch();
  writer_.traces(run(), traces_);
  life_.end(bridge);
}

void BagTables::finish(const std::vector<BagWarning>& warnings) {
  std::int64_t run = 0;
  for (RunRecord& record : records_) {
    ++run;
    for (const BagWarning& warning : warnings) {
      if (warning.run == 0 || warning.run == run) record.warnings.push_back({warning.key, warning.text});
    }
    writer_.run(run, record);
  }
  writer_.finish();
}

}  // namespace hammer_loads
