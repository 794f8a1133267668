#include "hammer_loads/life/ledger_reader.h"

#include <map>
#include <utility>

#include "hammer_loads/life/four_point.h"
#include "hammer_loads/life/ledger_schema.h"

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

}  // namespace

LedgerReader::LedgerReader(const std::string& path)
    : path_(path), database_(path, Database::Use::kRead, kReaderPatience) {
  database_.run("BEGIN");
  if (!isLedger(database_)) database_.fail("holds no ledger");
  checkLedger(database_);
}

std::vector<LedgerEpoch> LedgerReader::epochs() {
  std::vector<LedgerEpoch> epochs;
  Database::Statement rows(database_,
                           "SELECT epoch, machine, equivalent_cycles_per_hour, "
                           "(SELECT count(*) FROM runs WHERE runs.epoch = epochs.epoch) FROM epochs ORDER BY epoch");
  while (rows.step()) {
    const std::int64_t id = rows.integer(0);
    LedgerEpoch epoch{id, {rows.text(1), channelsOf(database_, id), rows.number(2)}, {}, unsignedOf(rows, 3)};
    Database::Statement days(database_,
                             "SELECT day, date, duration_ns, turns FROM days WHERE epoch = ?1 ORDER BY run, day", id);
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

std::string LedgerReader::runs() {
  Database::Statement rows(database_,
                           "SELECT name || ',' || epoch || ',' || messages || ',' || (SELECT coalesce(sum(turns), 0) "
                           "FROM days WHERE days.run = runs.run) FROM runs ORDER BY epoch, run");
  std::string csv = "run,epoch,crank_messages,blows\n";
  while (rows.step()) csv += rows.text(0) + '\n';
  return csv;
}

LedgerCounts LedgerReader::counts(const LedgerEpoch& epoch, const CountedChannel& channel) {
  const CycleCount none(channel.grid);
  LedgerCounts counts{none, std::vector<CycleCount>(epoch.days.size(), none)};
  std::map<std::int64_t, CycleCount*> of_day;
  for (std::size_t i = 0; i < epoch.days.size(); ++i)
    for (const std::int64_t id : epoch.days[i].ids) of_day[id] = &counts.days[i];
  const auto both = [&](std::int64_t day, const auto& add) {
    add(counts.total);
    if (const auto found = of_day.find(day); found != of_day.end()) add(*found->second);
  };
  const auto add_closed = [&](std::int64_t day, const ClosedCycles& closed) {
    both(day, [&](CycleCount& count) { count.closed.push_back(closed); });
  };
  std::string columns = "day, least, greatest";
  for (const TallyColumn& column : kTallyColumns) columns += std::string(", ") + column.name;
  Database::Statement tallies(database_, "SELECT " + columns + " FROM tallies WHERE channel = ?1", channel.id);
  while (tallies.step()) both(tallies.integer(0), [&](CycleCount& count) { addTally(tallies, count); });
  Database::Statement cycles(database_, "SELECT day, steps, low, count FROM cycles WHERE channel = ?1", channel.id);
  while (cycles.step())
    add_closed(cycles.integer(0),
               {unsignedOf<std::uint32_t>(cycles, 1), unsignedOf<std::uint32_t>(cycles, 2), unsignedOf(cycles, 3)});
  // The residues of the runs follow each other; the last day of a run has the cycles that they close.
  Database::Statement residues(database_,
                               "SELECT class, (SELECT max(day) FROM days WHERE days.run = residues.run) FROM residues "
                               "WHERE channel = ?1 ORDER BY run, place",
                               channel.id);
  FourPointStack<std::uint32_t> stack;
  while (residues.step())
    stack.push(unsignedOf<std::uint32_t>(residues, 0), [&](std::uint32_t b, std::uint32_t c) {
      add_closed(residues.integer(1), ClosedCycles::between(b, c, 1));
    });
  counts.total.residue = stack.residue();
  sortClosed(counts.total.closed);
  for (CycleCount& count : counts.days) sortClosed(count.closed);
  return counts;
}

}  // namespace hammer_loads::life
