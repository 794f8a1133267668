#include "hammer_loads/life/ledger_reader.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include "hammer_loads/life/count_state.h"
#include "hammer_loads/life/ledger_rows.h"
#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {

struct LedgerReader::State {
  explicit State(std::string name) : path(std::move(name)), database(path, Database::Use::kRead, kReaderPatience) {}
  static constexpr int kReaderPatience = 5000;  // [ms]; a writer needs some ms
  std::string path;
  Database database;
};

namespace {

std::uint64_t unsignedOf(const Database::Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

/// Adds a row of `tallies`, from its column `counted` on.
void addTally(const Database::Statement& row, CycleCount& count) {
  SampleTally t;
  int column = 0;
  for (std::uint64_t* value : {&t.counted, &t.skipped, &t.below, &t.above, &t.gaps, &t.deviations, &t.deviation_sum})
    *value = unsignedOf(row, column++);
  count.tally.add(t);
  Extremes extremes;
  extremes.least = row.number(column++);
  extremes.greatest = row.number(column);
  count.extremes.add(extremes);
}

}  // namespace

LedgerReader::LedgerReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
LedgerReader::~LedgerReader() = default;
LedgerReader::LedgerReader(LedgerReader&&) noexcept = default;
LedgerReader& LedgerReader::operator=(LedgerReader&&) noexcept = default;

std::string LedgerReader::problem() const {
  return state_->database.good() ? std::string{} : state_->path + ": " + state_->database.problem();
}

Checked<LedgerReader> LedgerReader::open(const std::string& path) {
  Checked<LedgerReader> result;
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    result.problems.push_back(path + ": cannot be read: " + std::strerror(errno));
  } else if (!S_ISREG(status.st_mode)) {
    result.problems.push_back(path + ": is no regular file");
  } else {
    LedgerReader reader(std::make_unique<State>(path));
    beginReading(reader.state_->database);
    if (reader.problem().empty()) {
      result.value.emplace(std::move(reader));
    } else {
      result.problems.push_back(reader.problem());
    }
  }
  return result;
}

std::vector<LedgerEpoch> LedgerReader::epochs() {
  Database& database = state_->database;
  std::vector<LedgerEpoch> epochs;
  Database::Statement rows(database,
                           "SELECT epoch, machine, equivalent_cycles_per_hour, "
                           "(SELECT count(*) FROM runs WHERE runs.epoch = epochs.epoch) FROM epochs ORDER BY epoch");
  while (rows.step()) {
    LedgerEpoch epoch{rows.integer(0), {rows.text(1), {}, rows.number(2)}, {}, unsignedOf(rows, 3)};
    for (ChannelRow& row : channelsOf(database, epoch.id)) epoch.machine.channels.push_back(std::move(row.channel));
    Database::Statement days(database, "SELECT day, date, duration_ns, turns FROM days WHERE epoch = ?1 ORDER BY day");
    days.with(epoch.id);
    while (days.step()) epoch.days.push_back({days.integer(0), days.text(1), unsignedOf(days, 2), unsignedOf(days, 3)});
    epochs.push_back(std::move(epoch));
  }
  return epochs;
}

CycleCount LedgerReader::read(const LedgerEpoch& epoch, std::size_t channel, std::int64_t first_day,
                              std::int64_t last_day) {
  Database& database = state_->database;
  CycleCount count(epoch.machine.channels[channel].grid);
  const std::vector<ChannelRow> rows = channelsOf(database, epoch.id);
  if (!database.good()) return count;
  const std::int64_t id = rows[channel].id;
  Database::Statement tallies(database,
                              "SELECT counted, skipped, below, above, gaps, deviations, deviation_sum, least, greatest "
                              "FROM tallies WHERE channel = ?1 AND day BETWEEN ?2 AND ?3 ORDER BY day");
  tallies.with(id, first_day, last_day);
  while (tallies.step()) addTally(tallies, count);
  Database::Statement cycles(database,
                             "SELECT steps, low, sum(count) FROM cycles WHERE channel = ?1 AND day BETWEEN ?2 AND ?3 "
                             "GROUP BY steps, low ORDER BY steps, low");
  cycles.with(id, first_day, last_day);
  while (cycles.step())
    count.closed.push_back({static_cast<std::uint32_t>(cycles.integer(0)),
                            static_cast<std::uint32_t>(cycles.integer(1)), unsignedOf(cycles, 2)});
  return count;
}

CycleCount LedgerReader::total(const LedgerEpoch& epoch, std::size_t channel) {
  CycleCount count = read(epoch, channel, 0, std::numeric_limits<std::int64_t>::max());
  Database& database = state_->database;
  const std::vector<ChannelRow> rows = channelsOf(database, epoch.id);
  if (!database.good()) return count;
  count.residue = residueOf(database, rows[channel].id, false);
  joinResidues(count.residue, residueOf(database, rows[channel].id, true), count.closed);
  sortClosed(count.closed);
  if (!isPossible(count)) database.fail("damaged: no loads give the count of " + epoch.machine.channels[channel].name);
  return count;
}

CycleCount LedgerReader::ofDay(const LedgerEpoch& epoch, std::size_t channel, const LedgerDay& day) {
  return read(epoch, channel, day.id, day.id);
}

}  // namespace hammer_loads::life
