#include "hammer_loads/life/life_settings.h"

#include <limits>

#include "hammer_loads/util/number_text.h"

namespace hammer_loads::life {

std::string hotSpotChannel(const HotSpot& spot) { return "stress/" + spot.name; }

std::string countedName(const std::string& channel, double bandwidth) {
  return bandwidth > 0.0 ? channel + "_below_" + shortNumber(bandwidth) + "Hz" : channel;
}

LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity) {
  LedgerMachine machine{identity, {}, settings.equivalent_cycles_per_hour};
  for (const CountedChannel& c : settings.channels)
    machine.channels.push_back({countedName(c.name, settings.bandwidth), c.grid, {}, {}, 0});
  for (const HotSpot& spot : settings.hot_spots)
    machine.channels.push_back(
        {countedName(hotSpotChannel(spot), settings.bandwidth), spot.grid, spot.curve, spot.mean_stress, 0});
  return machine;
}

ChannelFigures figuresOf(const CycleCount& count, const LedgerChannel& channel, double hours,
                         double equivalent_cycles_per_hour) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::vector<RangeMean> cycles = rangesAndMeans(count);
  const RangeDeviation deviation = rangeDeviation(count);
  ChannelFigures figures;
  for (std::size_t i = 0; i < kSlopeCount; ++i) {
    figures.equivalent_range[i] =
        hours > 0.0 ? equivalentLoad(cycles, kSlopes[i], hours * equivalent_cycles_per_hour, deviation)
                    : Figure{kNone, kNone, kNone};
  }
  if (!cycles.empty()) figures.largest_range = cycles.back().range;
  for (const RangeMean& c : cycles) figures.cycles += c.count;
  if (!channel.curve) return figures;
  figures.damage = damage(cycles, *channel.curve, channel.mean_stress, deviation);
  if (hours > 0.0) figures.remaining_hours = remainingHours(*figures.damage, hours);
  return figures;
}

}  // namespace hammer_loads::life
