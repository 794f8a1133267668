#include "hammer_loads/life/ledger_reader.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {

namespace {

constexpr int kReaderPatience = 5000;  // [ms]; a writer needs some ms

std::uint64_t unsignedOf(const Database::Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

/// Adds a row of `tallies`, from its column `counted` on.
void addTally(const Database::Statement& row, CycleCount& count) {
  SampleTally t;
  int column = 0;
  for (std::uint64_t* value : {&t.counted, &t.skipped, &t.below, &t.above, &t.gaps, &t.deviations, &t.deviation_sum,
                               &t.range_square, &t.range_own, &t.range_common})
    *value = unsignedOf(row, column++);
  count.tally.add(t);
  Extremes extremes;
  extremes.least = row.number(column++);
  extremes.greatest = row.number(column);
  count.extremes.add(extremes);
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
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    result.problems.push_back(path + ": cannot be read: " + std::strerror(errno));
  } else if (!S_ISREG(status.st_mode)) {
    result.problems.push_back(path + ": is no regular file");
  } else {
    LedgerReader reader(path);
    if (reader.problem().empty()) {
      result.value.emplace(std::move(reader));
    } else {
      result.problems.push_back(reader.problem());
    }
  }
  return result;
}

std::vector<LedgerEpoch> LedgerReader::epochs() {
  std::vector<LedgerEpoch> epochs;
  Database::Statement rows(*database_,
                           "SELECT epoch, machine, equivalent_cycles_per_hour, "
                           "(SELECT count(*) FROM runs WHERE runs.epoch = epochs.epoch) FROM epochs ORDER BY epoch");
  while (rows.step()) {
    LedgerEpoch epoch{rows.integer(0), {rows.text(1), {}, rows.number(2)}, {}, {}, unsignedOf(rows, 3)};
    for (ChannelRow& row : channelsOf(*database_, epoch.id)) {
      epoch.machine.channels.push_back(std::move(row.channel));
      epoch.channels.push_back(row.id);
    }
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

void LedgerReader::read(CycleCount& count, std::int64_t channel, const char* condition, std::int64_t value) {
  const std::string place = std::string(" WHERE channel = ?1 AND ") + condition;
  const std::string tally =
      "SELECT counted, skipped, below, above, gaps, deviations, deviation_sum, range_square, range_own, range_common, "
      "least, greatest FROM tallies" +
      place;
  const std::string cycle = "SELECT steps, low, sum(count) FROM cycles" + place + " GROUP BY steps, low";
  Database::Statement tallies(*database_, tally.c_str()), cycles(*database_, cycle.c_str());
  tallies.with(channel, value);
  while (tallies.step()) addTally(tallies, count);
  cycles.with(channel, value);
  while (cycles.step())
    count.closed.push_back({static_cast<std::uint32_t>(cycles.integer(0)),
                            static_cast<std::uint32_t>(cycles.integer(1)), unsignedOf(cycles, 2)});
}

const LedgerReader::Seams& LedgerReader::seamsOf(std::int64_t channel) {
  if (seams_.channel == channel) return seams_;
  seams_ = {channel, {}, {}};
  std::map<std::int64_t, std::pair<std::int64_t, std::vector<std::uint32_t>>> residues;  // by run, with its last day
  Database::Statement rows(*database_,
                           "SELECT run, class, (SELECT max(day) FROM days WHERE days.run = residues.run) FROM residues "
                           "WHERE channel = ?1 ORDER BY run, place");
  rows.with(channel);
  while (rows.step()) {
    auto& [last_day, residue] = residues[rows.integer(0)];
    last_day = rows.integer(2);
    residue.push_back(static_cast<std::uint32_t>(rows.integer(1)));
  }
  for (const auto& [run, ends] : residues) joinResidues(seams_.residue, ends.second, seams_.closed[ends.first]);
  return seams_;
}

CycleCount LedgerReader::total(const LedgerEpoch& epoch, std::size_t channel) {
  CycleCount count(epoch.machine.channels[channel].grid);
  read(count, epoch.channels[channel], "day >= ?2", 0);
  const Seams& seams = seamsOf(epoch.channels[channel]);
  count.residue = seams.residue;
  for (const auto& [day, closed] : seams.closed) count.closed.insert(count.closed.end(), closed.begin(), closed.end());
  sortClosed(count.closed);
  if (database_->good() && !isPossible(count))
    database_->fail("damaged: no loads give the count of " + epoch.machine.channels[channel].name);
  return count;
}

CycleCount LedgerReader::ofDay(const LedgerEpoch& epoch, std::size_t channel, const LedgerDay& day) {
  CycleCount count(epoch.machine.channels[channel].grid);
  const Seams& seams = seamsOf(epoch.channels[channel]);
  for (const std::int64_t part : day.ids) {
    read(count, epoch.channels[channel], "day = ?2", part);
    const auto closed = seams.closed.find(part);
    if (closed != seams.closed.end())
      count.closed.insert(count.closed.end(), closed->second.begin(), closed->second.end());
  }
  sortClosed(count.closed);
  return count;
}

}  // namespace hammer_loads::life
