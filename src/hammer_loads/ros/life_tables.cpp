#include "hammer_loads/ros/life_tables.h"

#include <algorithm>

namespace hammer_loads {
namespace {

void addCurve(const life::LifeSettings& settings, const std::string& name, ChannelCount& count) {
  for (const life::HotSpot& spot : settings.hot_spots) {
    if (life::hotSpotChannel(spot) != name || !spot.curve) continue;
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
  count.mean_deviation = message.mean_deviation;
  count.range_own_deviation = message.range_own_deviation;
  count.range_common_deviation = message.range_common_deviation;
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
  bridge.outputs().turn_loads.attach([this](const TurnLoads& message, const ros::Time&) { takeTurn(message); });
  bridge.outputs().load_cycles.attach([this](const LoadCycles& message, const ros::Time&) { cycles_ = message; });
}

/// Turns seen whole, as those of the table `turns`.
void LifeTables::takeTurn(const TurnLoads& message) {
  if (!message.whole) return;
  for (std::size_t i = 0; i < message.channel.size(); ++i)
    writer_->turnLoad(
        run_, {message.turn, static_cast<std::int64_t>(i), message.minimum[i], message.maximum[i], message.mean[i],
               message.minimum_deviation[i], message.maximum_deviation[i], message.minimum_common_deviation[i],
               message.maximum_common_deviation[i]});
}

void LifeTables::end(const HammerBridge& bridge) {
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
