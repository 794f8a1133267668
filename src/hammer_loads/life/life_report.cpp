#include "hammer_loads/life/life_report.h"

#include <utility>

#include "hammer_loads/life/channel_unit.h"

namespace hammer_loads::life {
namespace {

constexpr double kNsPerHour = 3600e9;

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
