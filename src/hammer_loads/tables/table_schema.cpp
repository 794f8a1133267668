#include "hammer_loads/tables/table_schema.h"

#include <array>
#include <fstream>
#include <string_view>

namespace hammer_loads {
namespace {

// The file is new and has a temporary name: no journal beside it.
constexpr char kBegin[] = R"(
PRAGMA page_size = 4096; PRAGMA encoding = 'UTF-8'; PRAGMA auto_vacuum = NONE;
PRAGMA journal_mode = OFF; PRAGMA locking_mode = EXCLUSIVE; PRAGMA temp_store = MEMORY; PRAGMA cache_size = -8000;
)";

constexpr char kTables[] = R"(
CREATE TABLE runs(
  run_id INTEGER PRIMARY KEY, run_key TEXT NOT NULL UNIQUE, input_sha256 TEXT NOT NULL, parameters_sha256 TEXT NOT NULL,
  machine TEXT NOT NULL, version TEXT NOT NULL, revision TEXT NOT NULL, parameters_yaml TEXT NOT NULL,
  first_stamp_ns INTEGER, last_stamp_ns INTEGER, duration REAL,
  level TEXT, samples INTEGER, published INTEGER, restarts INTEGER, turns INTEGER, blows INTEGER, backward_passes INTEGER,
  consistency REAL, timing_noise REAL, speed_noise REAL, angle_resolution REAL, drive_inertia REAL,
  drive_inertia_std REAL, equivalent_cycles_per_hour REAL,
  blank_firings INTEGER, judged_blows INTEGER, blows_without_hold_down INTEGER, still_time REAL, hull_pitch REAL);
CREATE TABLE parameters(run_id INTEGER, key TEXT, value TEXT, shipped TEXT, PRIMARY KEY(run_id, key)) WITHOUT ROWID;
CREATE TABLE refusals(run_id INTEGER, reason TEXT, count INTEGER, PRIMARY KEY(run_id, reason)) WITHOUT ROWID;
CREATE TABLE warnings(run_id INTEGER, place INTEGER, key TEXT, text TEXT, PRIMARY KEY(run_id, place)) WITHOUT ROWID;
CREATE TABLE channels(
  run_id INTEGER, channel INTEGER, name TEXT, unit TEXT, counted INTEGER, least REAL, greatest REAL, classes INTEGER,
  samples INTEGER, skipped INTEGER, below INTEGER, above INTEGER, gaps INTEGER,
  minimum REAL, maximum REAL, mean_std REAL, range_own_std REAL, range_systematic_std REAL,
  sn_knee_range REAL, sn_knee_cycles REAL, sn_slope REAL, sn_slope_below REAL, mean_stress_sensitivity REAL,
  PRIMARY KEY(run_id, channel)) WITHOUT ROWID;
CREATE TABLE turn_loads(
  run_id INTEGER, turn INTEGER, channel INTEGER, minimum REAL, maximum REAL, mean REAL, minimum_std REAL,
  maximum_std REAL, minimum_systematic_std REAL, maximum_systematic_std REAL,
  PRIMARY KEY(run_id, turn, channel)) WITHOUT ROWID;
CREATE TABLE cycles(
  run_id INTEGER, channel INTEGER, steps INTEGER, low INTEGER, count INTEGER,
  PRIMARY KEY(run_id, channel, steps, low)) WITHOUT ROWID;
CREATE TABLE residues(
  run_id INTEGER, channel INTEGER, place INTEGER, class INTEGER,
  PRIMARY KEY(run_id, channel, place)) WITHOUT ROWID;
CREATE TABLE boom_cylinders(
  run_id INTEGER, turn INTEGER, cylinder TEXT, joint_angle REAL, stiffness_ratio REAL,
  stiffness_ratio_std REAL, doubtful INTEGER, PRIMARY KEY(run_id, turn, cylinder)) WITHOUT ROWID;
CREATE TABLE boom_modes(
  run_id INTEGER, turn INTEGER, mode INTEGER, frequency REAL, frequency_std REAL, damping_ratio REAL,
  damping_ratio_std REAL, PRIMARY KEY(run_id, turn, mode)) WITHOUT ROWID;
CREATE TABLE budget(
  run_id INTEGER, quantity TEXT, value REAL, deviation REAL, source TEXT, share REAL,
  PRIMARY KEY(run_id, quantity, source)) WITHOUT ROWID;
CREATE TABLE traces(
  run_id INTEGER, kind TEXT, turn INTEGER, place INTEGER, time REAL, force_x REAL, force_z REAL, torque_y REAL,
  force_z_std REAL, crank_angle REAL, PRIMARY KEY(run_id, kind, place)) WITHOUT ROWID;
)";

std::string turnTable(const std::string& name, const std::vector<TableColumn>& columns) {
  std::string sql = "CREATE TABLE " + name + "(run_id INTEGER, turn INTEGER, stamp_ns INTEGER";
  for (const TableColumn& column : columns) {
    if (column.name != "turn") sql += ", " + column.name + (column.is_integer ? " INTEGER" : " REAL");
  }
  return sql + ", PRIMARY KEY(run_id, turn)) WITHOUT ROWID;\n";
}

}  // namespace

std::string beginTablesSql(const std::vector<TableColumn>& turn, const std::vector<TableColumn>& blow) {
  return std::string(kBegin) + "BEGIN;\nPRAGMA application_id = " + std::to_string(kTablesApplication) +
         ";\nPRAGMA user_version = " + std::to_string(kTablesVersion) + ";\n" + kTables + turnTable("turns", turn) +
         turnTable("blows", blow);
}

/// By the file's header (sqlite.org/fileformat.html): nothing is opened that might be changed by that.
std::string whyTablesMustStay(const std::string& file) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  constexpr std::size_t kApplicationAt = 68;
  std::array<char, 100> header{};
  std::ifstream(file, std::ios::binary).read(header.data(), header.size());
  if (std::string_view(header.data(), kMagic.size()) != kMagic) return "it is no SQLite file";
  int application = 0;
  for (std::size_t i = 0; i < 4; ++i)
    application = application << 8 | static_cast<unsigned char>(header[kApplicationAt + i]);
  return application == kTablesApplication ? "" : "it is a SQLite file of something else";
}

}  // namespace hammer_loads
