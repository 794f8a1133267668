#include "hammer_loads/life/life_report.h"

#include <utility>

#include "hammer_loads/life/channel_unit.h"

namespace hammer_loads::life {
namespace {

ChannelReport channelReport(LedgerReader& reader, const LedgerEpoch& epoch, const LedgerChannel& channel) {
  constexpr double kNsPerHour = 3600e9;
  const LedgerCounts counts = reader.counts(epoch, channel);
  ChannelReport report{channel.name, unitOf(channel.name), {}, counts.total.tally, counts.total.extremes};
  const auto add = [&](const LedgerDay& day, const CycleCount& count) {
    const double hours = static_cast<double>(day.duration) / kNsPerHour;
    report.periods.push_back(
        {day.date, hours, day.turns, figuresOf(count, channel, hours, epoch.machine.equivalent_cycles_per_hour)});
  };
  LedgerDay all{{}, "all", 0, 0};
  for (const LedgerDay& day : epoch.days) all.duration += day.duration, all.turns += day.turns;
  add(all, counts.total);
  for (std::size_t i = 0; i < epoch.days.size(); ++i) add(epoch.days[i], counts.days[i]);
  return report;
}

}  // namespace

Checked<std::vector<EpochReport>> lifeReport(LedgerReader& reader) {
  Checked<std::vector<EpochReport>> result;
  std::vector<EpochReport> reports;
  for (LedgerEpoch& epoch : reader.epochs()) {
    EpochReport report{std::move(epoch), {}};
    for (const LedgerChannel& channel : report.epoch.machine.channels) {
      if (!reader.problem().empty()) break;
      report.channels.push_back(channelReport(reader, report.epoch, channel));
    }
    reports.push_back(std::move(report));
  }
  if (reader.problem().empty())
    result.value = std::move(reports);
  else
    result.problems.push_back(reader.problem());
  return result;
}

}  // namespace hammer_loads::life
