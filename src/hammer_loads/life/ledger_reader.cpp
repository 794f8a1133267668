#include "hammer_loads/life/ledger_reader.h"

#include <map>
#include <utility>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/ledger_schema.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {
namespace {

constexpr int kReaderPatience = 5000;  // [ms]; a writer needs some ms

template <typename Unsigned = std::uint64_t>
Unsigned unsignedOf(const Database::Statement& row, int column) {
  return static_cast<Unsigned>(row.integer(column));
}

/// Extremes and tally of a row, from its second column on.
void addTally(const Database::Statement& row, CycleCount& count) {
  Extremes extremes;
  extremes.least = row.number(1);
  extremes.greatest = row.number(2);
  count.extremes.add(extremes);
  SampleTally tally;
  int place = 3;
  for (const TallyColumn& column : kTallyColumns) tally.*column.number = unsignedOf(row, place++);
  count.tally.add(tally);
}

/// Closes the cycles across the seams between a channel's runs, whose residues follow each other in `total`.
/// closed(day, cycles): by the last day of the run that closes them.
template <typename Closed>
void joinRuns(Database& database, std::int64_t channel, std::vector<std::uint32_t>& total, const Closed& closed) {
  Database::Statement rows(database,
                           "SELECT run, class, (SELECT max(day) FROM days WHERE days.run = residues.run) FROM residues "
                           "WHERE channel = ?1 ORDER BY run, place");
  struct Residue {
    std::int64_t last_day{};
    std::vector<std::uint32_t> classes;
  };
  std::map<std::int64_t, Residue> residues;  // by run
  rows.with(channel);
  while (rows.step()) {
    Residue& residue = residues[rows.integer(0)];
    residue.classes.push_back(unsignedOf<std::uint32_t>(rows, 1));
    residue.last_day = rows.integer(2);
  }
  for (const auto& [run, residue] : residues) {
    std::vector<ClosedCycles> cycles;
    joinResidues(total, residue.classes, cycles);
    closed(residue.last_day, cycles);
  }
}

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

LedgerReader::LedgerReader(const std::string& path)
    : path_(path), database_(std::make_unique<Database>(path, Database::Use::kRead, kReaderPatience)) {
  beginReading(*database_);
}

std::string LedgerReader::problem() const {
  return database_->good() ? std::string{} : path_ + ": " + database_->problem();
}

Checked<LedgerReader> LedgerReader::open(const std::string& path) {
  Checked<LedgerReader> result;
  LedgerReader reader(path);
  if (reader.problem().empty())
    result.value.emplace(std::move(reader));
  else
    result.problems.push_back(reader.problem());
  return result;
}

std::vector<LedgerEpoch> LedgerReader::epochs() {
  std::vector<LedgerEpoch> epochs;
  Database::Statement rows(*database_,
                           "SELECT epoch, machine, equivalent_cycles_per_hour, "
                           "(SELECT count(*) FROM runs WHERE runs.epoch = epochs.epoch) FROM epochs ORDER BY epoch");
  while (rows.step()) {
    const std::int64_t id = rows.integer(0);
    LedgerEpoch epoch{id, {rows.text(1), channelsOf(*database_, id), rows.number(2)}, {}, unsignedOf(rows, 3)};
    Database::Statement days(*database_,
                             "SELECT day, date, duration_ns, turns FROM days WHERE epoch = ?1 ORDER BY run, day");
    days.with(epoch.id);
    while (days.step()) {
      if (epoch.days.empty() || epoch.days.back().date != days.text(1)) epoch.days.push_back({{}, days.text(1), 0, 0});
      LedgerDay& day = epoch.days.back();
      day.ids.push_back(days.integer(0));
      day.duration += unsignedOf(days, 2);
      day.turns += unsignedOf(days, 3);
    }
    epochs.push_back(std::move(epoch));
  }
  return epochs;
}

std::vector<LedgerRunInfo> LedgerReader::runs() {
  Database::Statement rows(*database_,
                           "SELECT name, epoch, messages, (SELECT coalesce(sum(turns), 0) FROM days WHERE days.run = "
                           "runs.run) FROM runs ORDER BY epoch, run");
  std::vector<LedgerRunInfo> runs;
  while (rows.step()) runs.push_back({rows.text(0), rows.integer(1), unsignedOf(rows, 2), unsignedOf(rows, 3)});
  return runs;
}

LedgerCounts LedgerReader::counts(const LedgerEpoch& epoch, const LedgerChannel& channel) {
  const CycleCount none(channel.grid);
  LedgerCounts counts{none, std::vector<CycleCount>(epoch.days.size(), none)};
  std::map<std::int64_t, CycleCount*> of_day;
  for (std::size_t i = 0; i < epoch.days.size(); ++i)
    for (const std::int64_t id : epoch.days[i].ids) of_day[id] = &counts.days[i];
  const auto both = [&](std::int64_t day, const auto& add) {
    add(counts.total);
    if (const auto found = of_day.find(day); found != of_day.end()) add(*found->second);
  };
  std::string columns = "day, least, greatest";
  for (const TallyColumn& column : kTallyColumns) columns += std::string(", ") + column.name;
  const std::string sql = "SELECT " + columns + " FROM tallies WHERE channel = ?1";
  Database::Statement tallies(*database_, sql.c_str());
  tallies.with(channel.id);
  while (tallies.step()) both(tallies.integer(0), [&](CycleCount& count) { addTally(tallies, count); });
  Database::Statement cycles(*database_, "SELECT day, steps, low, count FROM cycles WHERE channel = ?1");
  cycles.with(channel.id);
  while (cycles.step()) {
    const ClosedCycles closed{unsignedOf<std::uint32_t>(cycles, 1), unsignedOf<std::uint32_t>(cycles, 2),
                              unsignedOf(cycles, 3)};
    both(cycles.integer(0), [&](CycleCount& count) { count.closed.push_back(closed); });
  }
  joinRuns(
      *database_, channel.id, counts.total.residue, [&](std::int64_t day, const std::vector<ClosedCycles>& closed) {
        both(day, [&](CycleCount& count) { count.closed.insert(count.closed.end(), closed.begin(), closed.end()); });
      });
  sortClosed(counts.total.closed);
  for (CycleCount& count : counts.days) sortClosed(count.closed);
  if (database_->good() && !isPossible(counts.total))
    database_->fail("damaged: no loads give the count of " + channel.name);
  return counts;
}

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
