#include "hammer_loads/tables/table_writer.h"

#include <cmath>
#include <utility>

#include "hammer_loads/life/channel_unit.h"
#include "hammer_loads/life/column_texts.h"
#include "hammer_loads/tables/sha256.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {
namespace {

std::string insertSql(const std::string& table, std::size_t values) {
  std::string sql = "INSERT INTO " + table + " VALUES(";
  for (std::size_t i = 1; i <= values; ++i) sql += (i == 1 ? "?" : ", ?") + std::to_string(i);
  return sql + ")";
}

/// Infinite is NULL as well: SQL knows no such number.
double finite(double value) { return std::isfinite(value) ? value : RunRecord::kUnknown; }

}  // namespace

TableWriter::TurnTable::TurnTable(life::Database& database, const std::string& name,
                                  std::vector<TableColumn> of_message)
    : columns(std::move(of_message)), insert(database, insertSql(name, columns.size() + 2).c_str()) {}

void TableWriter::TurnTable::add(std::int64_t run, const TurnRow& row) {
  insert.reset();
  int place = 0;
  insert.bind(++place, run);
  insert.bind(++place, row.turn);
  insert.bind(++place, row.stamp);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == "turn") continue;
    if (columns[i].is_integer)
      insert.bind(++place, static_cast<std::int64_t>(row.values[i]));
    else
      insert.bind(++place, finite(row.values[i]));
  }
  insert.step();
}

TableWriter::TableWriter(const std::string& file, std::vector<TableColumn> turn, std::vector<TableColumn> blow)
    : database_(file, life::Database::Use::kWrite, 0) {
  const std::string schema = beginTablesSql(turn, blow);
  database_.run(schema.c_str());
  insert(life::columnTexts(schema), database_);
  turns_.emplace(database_, "turns", std::move(turn));
  blows_.emplace(database_, "blows", std::move(blow));
  turn_load_.emplace(database_, insertSql("turn_loads", 10).c_str());
  boom_cylinder_.emplace(database_, insertSql("boom_cylinders", 7).c_str());
  boom_mode_.emplace(database_, insertSql("boom_modes", 7).c_str());
}

void TableWriter::turn(std::int64_t run, const TurnRow& row) { turns_->add(run, row); }
void TableWriter::blow(std::int64_t run, const TurnRow& row) { blows_->add(run, row); }

void TableWriter::turnLoad(std::int64_t run, const TurnLoad& load) {
  turn_load_->run(run, load.turn, load.channel, finite(load.minimum), finite(load.maximum), finite(load.mean),
                  finite(load.minimum_std), finite(load.maximum_std), finite(load.minimum_systematic_std),
                  finite(load.maximum_systematic_std));
}

void TableWriter::boomCylinder(std::int64_t run, const BoomCylinderRow& row) {
  boom_cylinder_->run(run, row.turn, row.cylinder, finite(row.joint_angle), finite(row.stiffness),
                      finite(row.deviation), std::int64_t{row.doubtful});
}

void TableWriter::boomMode(std::int64_t run, const BoomModeRow& row) {
  boom_mode_->run(run, row.turn, row.mode, finite(row.frequency), finite(row.frequency_std), finite(row.damping),
                  finite(row.damping_std));
}

void TableWriter::channel(std::int64_t run, std::int64_t number, const ChannelRecord& record) {
  if (record.count) return count(run, number, record);
  Statement(database_, "INSERT INTO channels(run_id, channel, name, unit, counted) VALUES(?1, ?2, ?3, ?4, 0)")
      .run(run, number, record.name, life::unitOf(record.name));
}

void TableWriter::count(std::int64_t run, std::int64_t channel, const ChannelRecord& record) {
  const ChannelCount& c = *record.count;
  Statement(database_, insertSql("channels", 23).c_str())
      .run(run, channel, record.name, life::unitOf(record.name), std::int64_t{1}, finite(c.least), finite(c.greatest),
           c.classes, c.samples, c.skipped, c.below, c.above, c.gaps, finite(c.minimum), finite(c.maximum),
           finite(c.mean_std), finite(c.range_own_std), finite(c.range_systematic_std), finite(c.sn_knee_range),
           finite(c.sn_knee_cycles), finite(c.sn_slope), finite(c.sn_slope_below), finite(c.mean_stress_sensitivity));
  Statement cycle(database_, insertSql("cycles", 5).c_str());
  for (std::size_t i = 0; i < c.count.size(); ++i) cycle.run(run, channel, c.steps[i], c.low[i], c.count[i]);
  Statement residue(database_, insertSql("residues", 4).c_str());
  std::int64_t place = 0;
  for (const std::uint32_t turning_point : c.residue) residue.run(run, channel, place++, turning_point);
}

void TableWriter::alarm(std::int64_t run, const AlarmRow& row) {
  Statement(database_, insertSql("alarms", 10).c_str())
      .run(run, row.name, row.level, row.unit, finite(row.value), finite(row.std), finite(row.limit), row.since,
           row.until, row.turns);
}

void TableWriter::reference(std::int64_t run, const ReferenceRow& row) {
  Statement(database_, insertSql("reference", 10).c_str())
      .run(run, row.component, row.unit, row.samples, finite(row.rms), finite(row.rms_error), finite(row.bias),
           finite(row.scale), finite(row.correlation), finite(row.within_two_std));
}

void TableWriter::budget(std::int64_t run, const BudgetRow& row) {
  Statement(database_, insertSql("budget", 7).c_str())
      .run(run, row.quantity, life::unitOf(row.quantity), finite(row.value), finite(row.deviation), row.source,
           finite(row.share));
}

void TableWriter::traces(std::int64_t run, const TurnTraces& traces) {
  if (const TurnTrace* typical = traces.typical()) trace(run, "typical", *typical);
  if (traces.worst()) trace(run, "worst", *traces.worst());
}

void TableWriter::trace(std::int64_t run, const std::string& kind, const TurnTrace& trace) {
  Statement insert(database_, insertSql("traces", 10).c_str());
  std::int64_t place = 0;
  for (const TraceSample& s : trace.samples)
    insert.run(run, kind, trace.turn, place++, seconds(s.stamp - trace.start), finite(s.force_x), finite(s.force_z),
               finite(s.torque_y), finite(s.force_z_std), finite(s.crank_angle));
}

void TableWriter::run(std::int64_t run, const RunRecord& r) {
  const std::string key = sha256Of({r.input_sha256, r.parameters_sha256, r.version, std::to_string(run)});
  Statement(database_, insertSql("runs", 30).c_str())
      .run(run, key, r.input_sha256, r.parameters_sha256, r.machine, r.version, r.revision, r.parameters_yaml,
           r.first_stamp, r.last_stamp, finite(r.duration), r.level, r.samples, r.published, r.restarts, r.turns,
           r.blows, r.backward_passes, finite(r.consistency), finite(r.timing_noise), finite(r.speed_noise),
           finite(r.angle_resolution), finite(r.drive_inertia), finite(r.drive_inertia_relative_std),
           finite(r.equivalent_cycles_per_hour), r.blank_firings, r.judged_blows, r.blows_without_hold_down,
           finite(r.still_time), finite(r.hull_pitch));
  Statement parameter(database_, insertSql("parameters", 4).c_str());
  for (const RunRecord::Parameter& p : r.parameters) parameter.run(run, p.key, p.value, p.shipped);
  Statement refusal(database_, insertSql("refusals", 3).c_str());
  for (const RunRecord::Refusals& refused : r.refusals) {
    if (refused.count > 0) refusal.run(run, refused.reason, refused.count);
  }
  Statement warning(database_, insertSql("warnings", 4).c_str());
  std::int64_t place = 0;
  for (const RunRecord::Warning& w : r.warnings) warning.run(run, place++, w.key, w.text);
}

void TableWriter::finish() {
  turns_.reset();
  blows_.reset();
  turn_load_.reset();
  boom_cylinder_.reset();
  boom_mode_.reset();
  database_.run("COMMIT");
}

}  // namespace hammer_loads
