#include "hammer_loads/life/life_report.h"

#include <limits>
#include <utility>

namespace hammer_loads::life {
namespace {

constexpr double kNsPerHour = 3600e9;

std::string unitOf(const std::string& channel) {
  const std::size_t at = channel.rfind('_');
  return at == std::string::npos ? std::string{} : channel.substr(at + 1);
}

ChannelReport channelReport(LedgerReader& reader, const LedgerEpoch& epoch, std::size_t channel) {
  const LedgerChannel& judged = epoch.machine.channels[channel];
  const double per_hour = epoch.machine.equivalent_cycles_per_hour;
  ChannelReport report;
  report.name = judged.name;
  report.unit = unitOf(judged.name);
  std::uint64_t duration = 0;
  for (const LedgerDay& day : epoch.days) {
    duration += day.duration;
    report.blows += day.turns;
    const double hours = static_cast<double>(day.duration) / kNsPerHour;
    report.days.push_back(
        {day.date, hours, day.turns, figuresOf(reader.ofDay(epoch, channel, day), judged, hours, per_hour)});
  }
  report.hours = static_cast<double>(duration) / kNsPerHour;
  const CycleCount total = reader.total(epoch, channel);
  report.figures = figuresOf(total, judged, report.hours, per_hour);
  report.tally = total.tally;
  report.extremes = total.extremes;
  return report;
}

}  // namespace

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

Checked<std::vector<EpochReport>> lifeReport(LedgerReader& reader) {
  Checked<std::vector<EpochReport>> result;
  std::vector<EpochReport> reports;
  for (LedgerEpoch& epoch : reader.epochs()) {
    EpochReport report{std::move(epoch), {}};
    for (std::size_t i = 0; i < report.epoch.machine.channels.size() && reader.problem().empty(); ++i)
      report.channels.push_back(channelReport(reader, report.epoch, i));
    reports.push_back(std::move(report));
  }
  if (reader.problem().empty()) {
    result.value = std::move(reports);
  } else {
    result.problems.push_back(reader.problem());
  }
  return result;
}

}  // namespace hammer_loads::life
