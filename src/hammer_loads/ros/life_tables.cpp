#include "hammer_loads/ros/life_tables.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/life/channel_unit.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/settings/channel_names.h"

namespace hammer_loads {
namespace {

void addCurve(const life::LifeSettings& settings, const std::string& name, ChannelCount& count) {
  for (const life::HotSpot& spot : settings.hot_spots) {
    if (life::countedName(life::hotSpotChannel(spot), settings.bandwidth) != name || !spot.curve) continue;
    count.sn_knee_range = spot.curve->kneeRange();
    count.sn_knee_cycles = spot.curve->kneeCycles();
    count.sn_slope = spot.curve->slope();
    count.sn_slope_below = spot.curve->slopeBelow();
    if (spot.mean_stress) count.mean_stress_sensitivity = spot.mean_stress->sensitivity;
  }
}

ChannelCount countOf(const ChannelCycles& message, const life::LifeSettings& settings) {
  ChannelCount count;
  count.least = message.least;
  count.greatest = message.greatest;
  count.classes = message.classes;
  count.samples = message.samples;
  count.skipped = message.skipped;
  count.below = message.below;
  count.above = message.above;
  count.gaps = message.gaps;
  count.minimum = message.minimum;
  count.maximum = message.maximum;
  count.mean_std = message.mean_std;
  count.range_own_std = message.range_own_std;
  count.range_systematic_std = message.range_systematic_std;
  count.steps = message.steps;
  count.low = message.low;
  count.count = message.count;
  count.residue = message.residue;
  addCurve(settings, message.name, count);
  return count;
}

}  // namespace

void LifeTables::begin(HammerBridge& bridge, std::int64_t run) {
  run_ = run;
  cycles_ = {};
  alarms_.clear();
  budget_.emplace(bridge.pipeline());
  bridge.watch([this] { budget_->follow(); });
  bridge.outputs().turn_loads.attach([this](const TurnLoads& message, const ros::Time&) { takeTurn(message); });
  bridge.outputs().alarms.attach([this](const Alarms& message, const ros::Time&) { takeAlarms(message); });
  bridge.outputs().load_cycles.attach([this](const LoadCycles& message, const ros::Time&) { cycles_ = message; });
}

/// Turns seen whole, as those of the table `turns`.
void LifeTables::takeTurn(const TurnLoads& message) {
  if (!message.whole) return;
  for (std::size_t i = 0; i < message.channel.size(); ++i)
    writer_->turnLoad(run_, {message.turn, static_cast<std::int64_t>(i), message.minimum[i], message.maximum[i],
                             message.mean[i], message.minimum_std[i], message.maximum_std[i],
                             message.minimum_systematic_std[i], message.maximum_systematic_std[i]});
}

void LifeTables::takeAlarms(const Alarms& message) {
  for (const Alarm& alarm : message.alarm) {
    const std::int64_t since = stampOf(alarm.since);
    auto row = std::find_if(alarms_.rbegin(), alarms_.rend(), [&](const AlarmRow& r) { return r.name == alarm.name; });
    if (row == alarms_.rend() || row->since != since) {
      alarms_.push_back({alarm.name, alarm.unit, alarm.level, alarm.value, alarm.value_std, alarm.limit, since, 0, 0});
      row = alarms_.rbegin();
    }
    if (std::abs(alarm.value - alarm.limit) > std::abs(row->value - row->limit))
      row->value = alarm.value, row->std = alarm.value_std;
    row->until = stampOf(message.header.stamp);
    ++row->turns;
  }
}

void LifeTables::write(const BudgetFigure& figure) {
  double all = 0.0;
  for (const BudgetFigure::Source& source : figure.sources) all += source.variance;
  for (const BudgetFigure::Source& source : figure.sources)
    writer_->budget(run_, {figure.quantity, figure.value, figure.deviation, source.name, source.variance / all});
}

/// A channel's range has the parts of its own turns; of the boom's, whose constants are not separated, those of all
/// constants and of the rest.
void LifeTables::writeBudget() {
  for (const BudgetFigure& figure : budget_->figures()) write(figure);
  const std::vector<std::string> names = channelNames(nullptr);  // names of the hull's channels
  for (const ChannelCycles& channel : cycles_.channel) {
    if (channel.equivalent_range.empty() || !(channel.equivalent_range.front() > 0.0)) continue;
    BudgetFigure figure{"equivalent_range_" + std::to_string(static_cast<int>(life::kSlopes[0])) + "/" + channel.name,
                        channel.equivalent_range.front(),
                        channel.equivalent_range_std.front(),
                        {}};
    const auto of_hull = std::find(names.begin(), names.end(), channel.name);
    if (of_hull != names.end()) {
      figure.sources = budget_->ofRange(static_cast<std::size_t>(of_hull - names.begin()));
    } else if (channel.range_own_std >= 0.0 && channel.range_systematic_std >= 0.0) {
      figure.sources = {
          {"constants of hammer and crank sensor", channel.range_systematic_std * channel.range_systematic_std},
          {"readings, oil and rock", channel.range_own_std * channel.range_own_std}};
    }
    write(figure);
  }
}

void LifeTables::end(const HammerBridge& bridge) {
  writeBudget();
  for (const AlarmRow& row : alarms_) writer_->alarm(run_, row);
  for (std::size_t i = 0; i < ReferenceComparison::kComponents; ++i) {
    const ReferenceFigures f = bridge.comparison().figures(i);
    if (f.samples > 0)
      writer_->reference(run_, {ReferenceComparison::kNames[i], life::unitOf(ReferenceComparison::kNames[i]), f.samples,
                                f.rms, f.rms_error, f.bias, f.scale, f.correlation, f.within_two_std});
  }
  std::vector<ChannelRecord> records;
  for (const std::string& name : bridge.outputs().turn_loads.message.channel) records.push_back({name, {}});
  for (const ChannelCycles& counted : cycles_.channel) {
    auto record = std::find_if(records.begin(), records.end(), [&](const auto& r) { return r.name == counted.name; });
    if (record == records.end()) record = records.insert(records.end(), {counted.name, {}});
    record->count = countOf(counted, bridge.settings().life);
  }
  for (std::size_t i = 0; i < records.size(); ++i) writer_->channel(run_, static_cast<std::int64_t>(i), records[i]);
}

}  // namespace hammer_loads
