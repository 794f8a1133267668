#include "hammer_loads/life/life_settings.h"

#include "hammer_loads/util/number_text.h"

namespace hammer_loads::life {

std::string countedName(const std::string& channel, double bandwidth) {
  return bandwidth > 0.0 ? channel + "_below_" + shortNumber(bandwidth) + "Hz" : channel;
}

LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity) {
  LedgerMachine machine{identity, settings.channels, settings.equivalent_cycles_per_hour};
  for (CountedChannel& channel : machine.channels) channel.name = countedName(channel.name, settings.bandwidth);
  return machine;
}

ChannelFigures figuresOf(const CycleCount& count, const CountedChannel& channel, double hours,
                         double equivalent_cycles_per_hour) {
  const std::vector<RangeMean> cycles = rangesAndMeans(count);
  const RangeDeviation deviation = rangeDeviation(count);
  ChannelFigures figures;
  for (std::size_t i = 0; i < kSlopeCount; ++i) {
    figures.equivalent_range[i] =
        hours > 0.0 ? equivalentLoad(cycles, kSlopes[i], hours * equivalent_cycles_per_hour, deviation)
                    : Figure{kNaN, kNaN, kNaN};
  }
  if (!cycles.empty()) figures.largest_range = cycles.back().range;
  for (const RangeMean& c : cycles) figures.cycles += c.count;
  if (!channel.curve) return figures;
  figures.damage = damage(cycles, *channel.curve, channel.mean_stress, deviation);
  if (hours > 0.0) figures.remaining_hours = remainingHours(*figures.damage, hours);
  return figures;
}

}  // namespace hammer_loads::life
