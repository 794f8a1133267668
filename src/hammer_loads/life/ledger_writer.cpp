#include "hammer_loads/life/ledger_writer.h"

#include <limits>
#include <utility>

#include "hammer_loads/life/ledger_rows.h"
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

/// The latest epoch, if it is of this machine.
std::optional<std::int64_t> presentEpoch(Database& database, const LedgerMachine& machine) {
  Database::Statement latest(database, "SELECT epoch, machine FROM epochs ORDER BY epoch DESC LIMIT 1");
  if (!latest.step() || latest.text(1) != machine.identity) return std::nullopt;
  const std::int64_t epoch = latest.integer(0);
  if (!sameChannels(channelsOf(database, epoch), machine.channels)) return std::nullopt;
  return epoch;
}

std::int64_t newEpoch(Database& database, const LedgerMachine& machine) {
  Database::Statement insert(database, "INSERT INTO epochs(machine, equivalent_cycles_per_hour) VALUES(?1, ?2)");
  insert.run(machine.identity, machine.equivalent_cycles_per_hour);
  const std::int64_t epoch = lastId(database);
  Database::Statement channel(database,
                              "INSERT INTO channels(epoch, name, least, greatest, classes) VALUES(?1, ?2, ?3, ?4, ?5)");
  for (const LedgerChannel& c : machine.channels)
    channel.run(epoch, c.name, c.grid.least(), c.grid.greatest(), c.grid.classes());
  return epoch;
}

void setJudgement(Database& database, std::int64_t epoch, const LedgerMachine& machine) {
  Database::Statement(database, "UPDATE epochs SET equivalent_cycles_per_hour = ?2 WHERE epoch = ?1")
      .run(epoch, machine.equivalent_cycles_per_hour);
  Database::Statement update(database,
                             "UPDATE channels SET sn_knee_range_MPa = ?3, sn_knee_cycles = ?4, sn_slope = ?5, "
                             "sn_slope_below = ?6, mean_stress_sensitivity = ?7 WHERE epoch = ?1 AND name = ?2");
  for (const LedgerChannel& c : machine.channels) {
    const auto of = [&](double (SnCurve::*figure)() const) { return c.curve ? ((*c.curve).*figure)() : kNull; };
    update.run(epoch, c.name, of(&SnCurve::kneeRange), of(&SnCurve::kneeCycles), of(&SnCurve::slope),
               of(&SnCurve::slopeBelow), c.mean_stress ? c.mean_stress->sensitivity : kNull);
  }
}

/// The epoch's latest day; a new one where the date is another, earlier ones too: a clock that runs back reorders
/// nothing.
std::int64_t dayFor(Database& database, std::int64_t epoch, const std::string& date) {
  Database::Statement latest(database, "SELECT day, date FROM days WHERE epoch = ?1 ORDER BY day DESC LIMIT 1");
  latest.with(epoch);
  if (latest.step() && latest.text(1) == date) return latest.integer(0);
  Database::Statement(database, "INSERT INTO days(epoch, date, duration_ns, turns) VALUES(?1, ?2, 0, 0)")
      .run(epoch, date);
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
      "INSERT INTO tallies VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11) ON CONFLICT(channel, day) DO UPDATE "
      "SET "
      "counted = counted + excluded.counted, skipped = skipped + excluded.skipped, below = below + excluded.below, "
      "above = above + excluded.above, gaps = gaps + excluded.gaps, deviations = deviations + excluded.deviations, "
      "deviation_sum = deviation_sum + excluded.deviation_sum, "
      "least = coalesce(min(least, excluded.least), least, excluded.least), "
      "greatest = coalesce(max(greatest, excluded.greatest), greatest, excluded.greatest)");
  const SampleTally& t = count.tally;
  add.run(channel, day, t.counted, t.skipped, t.below, t.above, t.gaps, t.deviations, t.deviation_sum,
          count.extremes.least, count.extremes.greatest);
}

void setResidue(Database& database, std::int64_t channel, bool open, const std::vector<std::uint32_t>& residue) {
  Database::Statement(database, "DELETE FROM residues WHERE channel = ?1 AND open = ?2")
      .run(channel, std::int64_t{open});
  Database::Statement insert(database, "INSERT INTO residues VALUES(?1, ?2, ?3, ?4)");
  for (std::size_t i = 0; i < residue.size(); ++i)
    insert.run(channel, std::int64_t{open}, static_cast<std::int64_t>(i), residue[i]);
}

}  // namespace

std::optional<RunRow> findRun(Database& database, const std::string& name) {
  Database::Statement row(database, "SELECT run, epoch, pieces, ended FROM runs WHERE name = ?1");
  if (!row.with(name).step()) return std::nullopt;
  return RunRow{row.integer(0), row.integer(1), row.integer(2), row.integer(3) != 0};
}

RunRow beginRun(Database& database, const LedgerMachine& machine, const std::string& name) {
  std::vector<RunRow> open;
  {
    Database::Statement rows(database, "SELECT run, epoch, pieces FROM runs WHERE ended = 0 ORDER BY run");
    while (rows.step()) open.push_back({rows.integer(0), rows.integer(1), rows.integer(2), false});
  }
  for (const RunRow& run : open) endRun(database, run);
  const std::optional<std::int64_t> present = presentEpoch(database, machine);
  const std::int64_t epoch = present ? *present : newEpoch(database, machine);
  setJudgement(database, epoch, machine);
  Database::Statement(database, "INSERT INTO runs(name, epoch, pieces, ended) VALUES(?1, ?2, 0, 0)").run(name, epoch);
  return {lastId(database), epoch, 0, false};
}

void addPiece(Database& database, const RunRow& run, const LifePiece& piece) {
  const std::vector<ChannelRow> channels = channelsOf(database, run.epoch);
  if (!database.good()) return;
  if (channels.size() != piece.counts.size()) return database.fail("damaged: channels of an epoch are missing");
  const std::int64_t day = dayFor(database, run.epoch, dateText(dayOf(piece.stamp)));
  Database::Statement(database, "UPDATE days SET duration_ns = duration_ns + ?2, turns = turns + ?3 WHERE day = ?1")
      .run(day, piece.duration, piece.turns);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    addCycles(database, channels[i].id, day, piece.counts[i].closed);
    addTally(database, channels[i].id, day, piece.counts[i]);
    setResidue(database, channels[i].id, true, piece.counts[i].residue);
  }
}

void setPieces(Database& database, const RunRow& run, std::int64_t pieces) {
  Database::Statement(database, "UPDATE runs SET pieces = ?2 WHERE run = ?1").run(run.run, pieces);
}

void endRun(Database& database, const RunRow& run) {
  Database::Statement latest(database, "SELECT day FROM days WHERE epoch = ?1 ORDER BY day DESC LIMIT 1");
  latest.with(run.epoch);
  const std::int64_t day = latest.step() ? latest.integer(0) : 0;  // no day: no piece, no residue
  for (const ChannelRow& channel : channelsOf(database, run.epoch)) {
    std::vector<std::uint32_t> residue = residueOf(database, channel.id, false);
    std::vector<ClosedCycles> closed;
    joinResidues(residue, residueOf(database, channel.id, true), closed);
    sortClosed(closed);
    addCycles(database, channel.id, day, closed);
    setResidue(database, channel.id, false, residue);
    setResidue(database, channel.id, true, {});
  }
  Database::Statement(database, "UPDATE runs SET ended = 1 WHERE run = ?1").run(run.run);
}

}  // namespace hammer_loads::life
