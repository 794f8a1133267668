#include "hammer_loads/life/ledger_writer.h"

#include <limits>
#include <map>
#include <set>
#include <utility>

#include "hammer_loads/life/channel_unit.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {
namespace {

constexpr double kNull = std::numeric_limits<double>::quiet_NaN();

std::int64_t lastId(Database& database) {
  Database::Statement statement(database, "SELECT last_insert_rowid()");
  return statement.step() ? statement.integer(0) : 0;
}

/// Year, month and day of the Gregorian calendar (H. Hinnant, "chrono-Compatible Low-Level Date Algorithms").
std::string dateText(std::int64_t days_since_1970) {
  const std::int64_t z = days_since_1970 + 719468;  // days since 0000-03-01
  const std::int64_t era = (z >= 0 ? z : z - 146096) / 146097;
  const std::int64_t day_of_era = z - era * 146097;
  const std::int64_t year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t month_from_march = (5 * day_of_year + 2) / 153;
  const std::int64_t day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
  const std::int64_t month = month_from_march < 10 ? month_from_march + 3 : month_from_march - 9;
  const std::int64_t year = year_of_era + era * 400 + (month <= 2 ? 1 : 0);
  return format("%04d-%02d-%02d", static_cast<int>(year), static_cast<int>(month), static_cast<int>(day));
}

bool sameChannels(const std::vector<ChannelRow>& rows, const std::vector<LedgerChannel>& channels) {
  if (rows.size() != channels.size()) return false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].channel.name != channels[i].name || rows[i].channel.grid != channels[i].grid) return false;
  }
  return true;
}

bool isOf(Database& database, std::int64_t epoch, const LedgerMachine& machine) {
  Database::Statement row(database, "SELECT machine FROM epochs WHERE epoch = ?1");
  return row.with(epoch).step() && row.text(0) == machine.identity &&
         sameChannels(channelsOf(database, epoch), machine.channels);
}

std::int64_t newEpoch(Database& database, const LedgerMachine& machine) {
  Database::Statement insert(database, "INSERT INTO epochs(machine, equivalent_cycles_per_hour) VALUES(?1, ?2)");
  insert.run(machine.identity, machine.equivalent_cycles_per_hour);
  const std::int64_t epoch = lastId(database);
  Database::Statement channel(database,
                              "INSERT INTO channels(epoch, name, unit, least, greatest, classes) "
                              "VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  for (const LedgerChannel& c : machine.channels)
    channel.run(epoch, c.name, unitOf(c.name), c.grid.least(), c.grid.greatest(), c.grid.classes());
  return epoch;
}

void setJudgement(Database& database, std::int64_t epoch, const LedgerMachine& machine) {
  Database::Statement(database, "UPDATE epochs SET equivalent_cycles_per_hour = ?2 WHERE epoch = ?1")
      .run(epoch, machine.equivalent_cycles_per_hour);
  Database::Statement update(database,
                             "UPDATE channels SET sn_knee_range = ?3, sn_knee_cycles = ?4, sn_slope = ?5, "
                             "sn_slope_below = ?6, mean_stress_sensitivity = ?7 WHERE epoch = ?1 AND name = ?2");
  for (const LedgerChannel& c : machine.channels) {
    const auto of = [&](double (SnCurve::*figure)() const) { return c.curve ? ((*c.curve).*figure)() : kNull; };
    update.run(epoch, c.name, of(&SnCurve::kneeRange), of(&SnCurve::kneeCycles), of(&SnCurve::slope),
               of(&SnCurve::slopeBelow), c.mean_stress ? c.mean_stress->sensitivity : kNull);
  }
}

/// The run's latest day; a new one where the date is another, earlier ones too: a clock that runs back reorders
/// nothing.
std::int64_t dayFor(Database& database, const RunRow& run, const std::string& date) {
  Database::Statement latest(database, "SELECT day, date FROM days WHERE run = ?1 ORDER BY day DESC LIMIT 1");
  latest.with(run.run);
  if (latest.step() && latest.text(1) == date) return latest.integer(0);
  Database::Statement(database, "INSERT INTO days(epoch, date, duration_ns, turns, run) VALUES(?1, ?2, 0, 0, ?3)")
      .run(run.epoch, date, run.run);
  return lastId(database);
}

void addCycles(Database& database, std::int64_t channel, std::int64_t day, const std::vector<ClosedCycles>& closed) {
  Database::Statement add(
      database,
      "INSERT INTO cycles VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(channel, day, steps, low) DO UPDATE "
      "SET count = count + excluded.count");
  for (const ClosedCycles& c : closed) add.run(channel, day, c.steps, c.low, c.count);
}

void addTally(Database& database, std::int64_t channel, std::int64_t day, const CycleCount& count) {
  Database::Statement add(
      database,
      "INSERT INTO tallies VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14) "
      "ON CONFLICT(channel, day) DO UPDATE SET "
      "counted = counted + excluded.counted, skipped = skipped + excluded.skipped, below = below + excluded.below, "
      "above = above + excluded.above, gaps = gaps + excluded.gaps, deviations = deviations + excluded.deviations, "
      "deviation_sum = deviation_sum + excluded.deviation_sum, "
      "range_square = range_square + excluded.range_square, range_own = range_own + excluded.range_own, "
      "range_common = range_common + excluded.range_common, "
      "least = coalesce(min(least, excluded.least), least, excluded.least), "
      "greatest = coalesce(max(greatest, excluded.greatest), greatest, excluded.greatest)");
  const SampleTally& t = count.tally;
  add.run(channel, day, t.counted, t.skipped, t.below, t.above, t.gaps, t.deviations, t.deviation_sum,
          count.extremes.least, count.extremes.greatest, t.range_square, t.range_own, t.range_common);
}

void setResidue(Database& database, std::int64_t channel, std::int64_t run, const std::vector<std::uint32_t>& residue) {
  Database::Statement(database, "DELETE FROM residues WHERE channel = ?1 AND run = ?2").run(channel, run);
  Database::Statement insert(database, "INSERT INTO residues(channel, run, place, class) VALUES(?1, ?2, ?3, ?4)");
  for (std::size_t i = 0; i < residue.size(); ++i) insert.run(channel, run, static_cast<std::int64_t>(i), residue[i]);
}

RunRow rowOf(const Database::Statement& row) {
  return {row.integer(0), row.integer(1), row.integer(2),
          row.text(3),    row.text(4),    static_cast<std::uint64_t>(row.integer(5))};
}

#define HAMMER_LOADS_RUN_COLUMNS "SELECT run, epoch, pieces, name, parameters, messages FROM runs "

void emptyRun(Database& database, const RunRow& run) {
  for (const char* sql :
       {"DELETE FROM cycles WHERE day IN (SELECT day FROM days WHERE run = ?1)",
        "DELETE FROM tallies WHERE day IN (SELECT day FROM days WHERE run = ?1)", "DELETE FROM days WHERE run = ?1",
        "DELETE FROM residues WHERE run = ?1", "DELETE FROM marks WHERE run = ?1", "DELETE FROM runs WHERE run = ?1"})
    Database::Statement(database, sql).run(run.run);
}

void removeUnusedEpochs(Database& database) {
  database.run(
      "DELETE FROM channels WHERE epoch NOT IN (SELECT epoch FROM runs); "
      "DELETE FROM epochs WHERE epoch NOT IN (SELECT epoch FROM runs)");
}

}  // namespace

std::optional<RunRow> findRun(Database& database, const std::string& name) {
  Database::Statement row(database, HAMMER_LOADS_RUN_COLUMNS "WHERE name = ?1");
  if (!row.with(name).step()) return std::nullopt;
  return rowOf(row);
}

std::vector<RunRow> runsLike(Database& database, const LedgerMachine& machine, const std::string& name,
                             const std::vector<std::int64_t>& marks) {
  std::map<std::int64_t, RunRow> runs;
  if (const std::optional<RunRow> named = findRun(database, name)) runs.emplace(named->run, *named);
  Database::Statement marked(database, HAMMER_LOADS_RUN_COLUMNS
                             "WHERE run IN (SELECT run FROM marks WHERE mark = ?1) AND "
                             "epoch IN (SELECT epoch FROM epochs WHERE machine = ?2)");
  for (const std::int64_t mark : marks) {
    marked.with(mark, machine.identity);
    while (marked.step()) runs.emplace(marked.integer(0), rowOf(marked));
  }
  std::vector<RunRow> in_order;
  for (const auto& [id, run] : runs) in_order.push_back(run);
  return in_order;
}

bool holdsMarksOf(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks) {
  const std::set<std::int64_t> here(marks.begin(), marks.end());
  Database::Statement rows(database, "SELECT mark FROM marks WHERE run = ?1");
  rows.with(run.run);
  while (rows.step()) {
    if (here.count(rows.integer(0)) == 0) return false;
  }
  return true;
}

RunRow beginRun(Database& database, const LedgerMachine& machine, const RunId& id,
                const std::vector<RunRow>& replaced) {
  RunRow row;
  for (const RunRow& run : replaced) emptyRun(database, run);
  if (!replaced.empty() && isOf(database, replaced.front().epoch, machine)) {
    row.run = replaced.front().run;
    row.epoch = replaced.front().epoch;
  } else {
    removeUnusedEpochs(database);
    Database::Statement latest(database, "SELECT max(epoch) FROM epochs");
    const std::int64_t epoch = latest.step() ? latest.integer(0) : 0;
    row.epoch = isOf(database, epoch, machine) ? epoch : newEpoch(database, machine);
  }
  setJudgement(database, row.epoch, machine);
  const std::optional<std::int64_t> place = row.run > 0 ? std::make_optional(row.run) : std::nullopt;
  Database::Statement(database, "INSERT INTO runs VALUES(?1, ?2, ?3, 0, ?4, 0)")
      .run(place, id.name, row.epoch, id.parameters);
  row.run = lastId(database);
  removeUnusedEpochs(database);
  return row;
}

void removeRun(Database& database, const RunRow& run) {
  emptyRun(database, run);
  removeUnusedEpochs(database);
}

void addPiece(Database& database, const RunRow& run, const LifePiece& piece) {
  const std::vector<ChannelRow> channels = channelsOf(database, run.epoch);
  if (!database.good()) return;
  if (channels.size() != piece.counts.size()) return database.fail("damaged: channels of an epoch are missing");
  const std::int64_t day = dayFor(database, run, dateText(dayOf(piece.stamp)));
  Database::Statement(database, "UPDATE days SET duration_ns = duration_ns + ?2, turns = turns + ?3 WHERE day = ?1")
      .run(day, piece.duration, piece.turns);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    addCycles(database, channels[i].id, day, piece.counts[i].closed);
    addTally(database, channels[i].id, day, piece.counts[i]);
    setResidue(database, channels[i].id, run.run, piece.counts[i].residue);
  }
}

void setRun(Database& database, const RunRow& run, std::int64_t pieces, std::uint64_t messages,
            const std::vector<std::int64_t>& marks, std::size_t first_mark) {
  Database::Statement(database, "UPDATE runs SET pieces = ?2, messages = ?3 WHERE run = ?1")
      .run(run.run, pieces, messages);
  Database::Statement add(database, "INSERT OR IGNORE INTO marks VALUES(?1, ?2)");
  for (std::size_t i = first_mark; i < marks.size(); ++i) add.run(marks[i], run.run);
}

}  // namespace hammer_loads::life
