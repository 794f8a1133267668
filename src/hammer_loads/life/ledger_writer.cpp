#include <algorithm>
#include <limits>
#include <optional>

#include "hammer_loads/life/ledger_schema.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {
namespace {

constexpr double kNull = std::numeric_limits<double>::quiet_NaN();

std::int64_t lastId(Database& database) {
  Database::Statement statement(database, "SELECT last_insert_rowid()");
  return statement.step() ? statement.integer(0) : 0;
}

/// Integers for SQL's json_each().
template <typename Integers>
std::string jsonOf(const Integers& integers) {
  std::string json;
  for (const auto integer : integers) json += (json.empty() ? "[" : ",") + std::to_string(integer);
  return json.empty() ? "[]" : json + "]";
}

bool isOf(Database& database, std::int64_t epoch, const LedgerMachine& machine) {
  Database::Statement row(database, "SELECT machine FROM epochs WHERE epoch = ?1");
  if (!row.with(epoch).step() || row.text(0) != machine.identity) return false;
  const std::vector<LedgerChannel> channels = channelsOf(database, epoch);
  return std::equal(channels.begin(), channels.end(), machine.channels.begin(), machine.channels.end(),
                    [](const LedgerChannel& a, const LedgerChannel& b) { return a.hasCountsOf(b); });
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
std::int64_t dayFor(Database& database, const RunRow& run, std::int64_t days_since_1970) {
  constexpr std::int64_t kSecondsPerDay = 86400;
  Database::Statement(database,
                      "INSERT INTO days(epoch, date, duration_ns, turns, run) SELECT ?2, date(?3, 'unixepoch'), 0, 0, "
                      "?1 WHERE date(?3, 'unixepoch') IS NOT "
                      "(SELECT date FROM days WHERE run = ?1 ORDER BY day DESC LIMIT 1)")
      .run(run.run, run.epoch, days_since_1970 * kSecondsPerDay);
  Database::Statement latest(database, "SELECT max(day) FROM days WHERE run = ?1");
  return latest.with(run.run).step() ? latest.integer(0) : 0;
}

void addCycles(Database& database, std::int64_t channel, std::int64_t day, const std::vector<ClosedCycles>& closed) {
  Database::Statement add(
      database,
      "INSERT INTO cycles VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(channel, day, steps, low) DO UPDATE "
      "SET count = count + excluded.count");
  for (const ClosedCycles& c : closed) add.run(channel, day, c.steps, c.low, c.count);
}

void addTally(Database& database, std::int64_t channel, std::int64_t day, const CycleCount& count) {
  std::string columns, values, sums;
  for (const TallyColumn& column : kTallyColumns) {
    const std::string name = column.name;
    columns += ", " + name;
    values += ", " + std::to_string(count.tally.*column.number);
    sums += ", " + name + " = " + name + " + excluded." + name;
  }
  const std::string sql = "INSERT INTO tallies(channel, day, least, greatest" + columns + ") VALUES(?1, ?2, ?3, ?4" +
                          values +
                          ") ON CONFLICT(channel, day) DO UPDATE SET "
                          "least = coalesce(min(least, excluded.least), least, excluded.least), "
                          "greatest = coalesce(max(greatest, excluded.greatest), greatest, excluded.greatest)" +
                          sums;
  Database::Statement(database, sql.c_str()).run(channel, day, count.extremes.least, count.extremes.greatest);
}

void setResidue(Database& database, std::int64_t channel, std::int64_t run, const std::vector<std::uint32_t>& residue) {
  Database::Statement(database, "DELETE FROM residues WHERE channel = ?1 AND run = ?2").run(channel, run);
  Database::Statement(database, "INSERT INTO residues SELECT ?1, ?2, key, value FROM json_each(?3)")
      .run(channel, run, jsonOf(residue));
}

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

std::vector<RunRow> runsLike(Database& database, const std::string& name, const LedgerMachine& machine,
                             const std::vector<std::int64_t>& marks) {
  Database::Statement rows(database,
                           "SELECT run, epoch, pieces, name, parameters, messages FROM runs WHERE name = ?1 OR "
                           "(run IN (SELECT run FROM marks WHERE mark IN (SELECT value FROM json_each(?3))) AND "
                           "epoch IN (SELECT epoch FROM epochs WHERE machine = ?2)) ORDER BY run");
  rows.with(name, machine.identity, jsonOf(marks));
  std::vector<RunRow> runs;
  while (rows.step())
    runs.push_back({rows.integer(0), rows.integer(1), rows.integer(2), rows.text(3), rows.text(4),
                    static_cast<std::uint64_t>(rows.integer(5))});
  return runs;
}

bool isCovered(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks) {
  Database::Statement other(
      database, "SELECT 1 FROM marks WHERE run = ?1 AND mark NOT IN (SELECT value FROM json_each(?2)) LIMIT 1");
  return !other.with(run.run, jsonOf(marks)).step();
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
  const std::vector<LedgerChannel> channels = channelsOf(database, run.epoch);
  if (!database.good()) return;
  if (channels.size() != piece.counts.size()) return database.fail("damaged: channels of an epoch are missing");
  const std::int64_t day = dayFor(database, run, dayOf(piece.stamp));
  Database::Statement(database, "UPDATE days SET duration_ns = duration_ns + ?2, turns = turns + ?3 WHERE day = ?1")
      .run(day, piece.duration, piece.turns);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    addCycles(database, channels[i].id, day, piece.counts[i].closed);
    addTally(database, channels[i].id, day, piece.counts[i]);
    setResidue(database, channels[i].id, run.run, piece.counts[i].residue);
  }
}

void setRun(Database& database, const RunRow& run, std::int64_t pieces, std::uint64_t messages,
            const std::vector<std::int64_t>& marks) {
  Database::Statement(database, "UPDATE runs SET pieces = ?2, messages = ?3 WHERE run = ?1")
      .run(run.run, pieces, messages);
  Database::Statement(database, "INSERT OR IGNORE INTO marks SELECT value, ?1 FROM json_each(?2)")
      .run(run.run, jsonOf(marks));
}

}  // namespace hammer_loads::life
