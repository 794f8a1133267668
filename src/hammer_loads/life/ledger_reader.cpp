#include "hammer_loads/life/ledger_reader.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

#include "hammer_loads/life/count_state.h"
#include "hammer_loads/life/ledger_rows.h"
#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {

/// What the residues of runs give, one after another.
struct LedgerReader::Seams {
  std::int64_t channel{-1};
  std::map<std::int64_t, std::vector<ClosedCycles>> closed;  ///< by the day of the run that closed them
  std::vector<std::uint32_t> residue;
};

struct LedgerReader::State {
  explicit State(std::string name) : path(std::move(name)), database(path, Database::Use::kRead, kReaderPatience) {}
  static constexpr int kReaderPatience = 5000;  // [ms]; a writer needs some ms
  std::string path;
  Database database;
  Seams seams;  ///< of the channel read last
};

namespace {

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
    Database::Statement days(database,
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
  Database::Statement rows(state_->database,
                           "SELECT name, epoch, messages, (SELECT coalesce(sum(turns), 0) FROM days WHERE days.run = "
                           "runs.run), apart FROM runs ORDER BY epoch, run");
  std::vector<LedgerRunInfo> runs;
  while (rows.step())
    runs.push_back({rows.text(0), rows.integer(1), unsignedOf(rows, 2), unsignedOf(rows, 3), rows.integer(4) != 0});
  return runs;
}

std::int64_t LedgerReader::idOf(const LedgerEpoch& epoch, std::size_t channel) {
  const std::vector<ChannelRow> rows = channelsOf(state_->database, epoch.id);
  return channel < rows.size() ? rows[channel].id : -1;
}

void LedgerReader::read(std::int64_t channel, std::optional<std::int64_t> day, CycleCount& count) {
  Database& database = state_->database;
  const std::string place = std::string(" WHERE channel = ?1 ") + (day ? "AND day = ?2 " : "");
  const std::string tally =
      "SELECT counted, skipped, below, above, gaps, deviations, deviation_sum, range_square, range_own, range_common, "
      "least, greatest FROM tallies" +
      place;
  const std::string cycle = "SELECT steps, low, sum(count) FROM cycles" + place + "GROUP BY steps, low";
  Database::Statement tallies(database, tally.c_str()), cycles(database, cycle.c_str());
  for (Database::Statement* rows : {&tallies, &cycles}) day ? rows->with(channel, *day) : rows->with(channel);
  while (tallies.step()) addTally(tallies, count);
  while (cycles.step())
    count.closed.push_back({static_cast<std::uint32_t>(cycles.integer(0)),
                            static_cast<std::uint32_t>(cycles.integer(1)), unsignedOf(cycles, 2)});
}

const LedgerReader::Seams& LedgerReader::seams(std::int64_t epoch, std::int64_t channel) {
  Database& database = state_->database;
  Seams& seams = state_->seams;
  if (seams.channel == channel) return seams;
  seams = {channel, {}, {}};
  std::map<std::int64_t, std::vector<std::uint32_t>> residues;  // in the order of runs
  Database::Statement rows(database, "SELECT run, class FROM residues WHERE channel = ?1 ORDER BY run, place");
  rows.with(channel);
  while (rows.step()) residues[rows.integer(0)].push_back(static_cast<std::uint32_t>(rows.integer(1)));
  std::map<std::int64_t, std::int64_t> last_day;
  Database::Statement days(database, "SELECT run, max(day) FROM days WHERE epoch = ?1 GROUP BY run");
  days.with(epoch);
  while (days.step()) last_day[days.integer(0)] = days.integer(1);
  for (const auto& [run, residue] : residues) joinResidues(seams.residue, residue, seams.closed[last_day[run]]);
  return seams;
}

CycleCount LedgerReader::total(const LedgerEpoch& epoch, std::size_t channel) {
  CycleCount count(epoch.machine.channels[channel].grid);
  const std::int64_t id = idOf(epoch, channel);
  read(id, std::nullopt, count);
  const Seams& joined = seams(epoch.id, id);
  count.residue = joined.residue;
  for (const auto& [day, closed] : joined.closed) count.closed.insert(count.closed.end(), closed.begin(), closed.end());
  sortClosed(count.closed);
  Database& database = state_->database;
  if (database.good() && !isPossible(count))
    database.fail("damaged: no loads give the count of " + epoch.machine.channels[channel].name);
  return count;
}

CycleCount LedgerReader::ofDay(const LedgerEpoch& epoch, std::size_t channel, const LedgerDay& day) {
  CycleCount count(epoch.machine.channels[channel].grid);
  const std::int64_t id = idOf(epoch, channel);
  const Seams& joined = seams(epoch.id, id);
  for (const std::int64_t part : day.ids) {
    read(id, part, count);
    const auto closed = joined.closed.find(part);
    if (closed != joined.closed.end())
      count.closed.insert(count.closed.end(), closed->second.begin(), closed->second.end());
  }
  sortClosed(count.closed);
  return count;
}

}  // namespace hammer_loads::life
