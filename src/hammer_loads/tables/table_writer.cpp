#include "hammer_loads/tables/table_writer.h"

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
  run_id INTEGER PRIMARY KEY,         -- [-] number of the run, from 1 in the order of time
  run_key TEXT NOT NULL UNIQUE,       -- [-] SHA-256 over input, parameters, version and run_id; identifies the run in merged files
  input_sha256 TEXT NOT NULL,         -- [-] SHA-256 over the bytes of the bags in their order
  parameters_sha256 TEXT NOT NULL,    -- [-] SHA-256 over every parameter in force and the robot description
  machine TEXT NOT NULL,              -- [-] digest of the machine, as in a ledger
  version TEXT NOT NULL,              -- [-] version of the package
  revision TEXT NOT NULL,             -- [-] revision of its source
  parameters_yaml TEXT NOT NULL,      -- [-] every parameter in force, except those of log and ledger file
  first_stamp_ns INTEGER,             -- [ns] stamp of the first published sample
  last_stamp_ns INTEGER,              -- [ns] stamp of the last published sample
  duration REAL,                      -- [s] time between published samples, gaps (stale_after_s) left out
  level TEXT,                         -- [-] level of the model: pulse, rocker, linkage or elastic
  samples INTEGER,                    -- [-] number of messages on the crank's topic
  published INTEGER,                  -- [-] number of published wrenches
  restarts INTEGER,                   -- [-] number of drop-outs, jumps and backward steps of time
  turns INTEGER,                      -- [-] number of rows in turns
  blows INTEGER,                      -- [-] number of rows in blows
  backward_passes INTEGER,            -- [-] number of passages of the blow in backward direction
  consistency REAL,                   -- [-] consistency of HullLoads at the end of the run
  timing_noise REAL,                  -- [s] jitter of the stamps, estimated by the end of the run
  speed_noise REAL,                   -- [rad/s] noise of measured speeds, estimated by the end of the run
  angle_resolution REAL,              -- [rad] one count of the encoder, estimated by the end of the run
  drive_inertia REAL,                 -- [kg m2] drive inertia, estimated by the end of the run
  drive_inertia_relative_std REAL,    -- [-] standard deviation of the drive inertia over its value
  equivalent_cycles_per_hour REAL,    -- [1/h] rate of damage-equivalent ranges (life_equivalent_cycles_per_hour)
  blank_firings INTEGER,              -- [-] number of strokes past the place of the tool (doc/report.md, Misuse)
  judged_blows INTEGER,               -- [-] number of blows whose hold-down force is known from cylinder pressures
  blows_without_hold_down INTEGER,    -- [-] number of judged blows without force of the rock on the hull; NULL: not known
  still_time REAL,                    -- [s] time of hammering beyond 15 s at one place; NULL: the place of the hull is not known
  hull_pitch REAL                     -- [rad] pitch of the hull at the end of the run; 0: the tool is vertical
);
CREATE TABLE parameters(
  run_id INTEGER,  -- [-] number of the run
  key TEXT,        -- [-] key of the parameter files
  value TEXT,      -- [-] value in force, as text
  shipped TEXT,    -- [-] value in the shipped files; NULL: none there
  PRIMARY KEY(run_id, key)) WITHOUT ROWID;
CREATE TABLE refusals(
  run_id INTEGER,  -- [-] number of the run
  reason TEXT,     -- [-] reason why crank samples gave no wrench
  count INTEGER,   -- [-] number of these samples, at least 1
  PRIMARY KEY(run_id, reason)) WITHOUT ROWID;
CREATE TABLE warnings(
  run_id INTEGER,  -- [-] number of the run
  place INTEGER,   -- [-] rank, 0 for the most important
  key TEXT,        -- [-] name of the cause
  text TEXT,       -- [-] text, as on the console
  PRIMARY KEY(run_id, place)) WITHOUT ROWID;
CREATE TABLE channels(
  run_id INTEGER,                -- [-] number of the run
  channel INTEGER,               -- [-] number of the channel, from 0
  name TEXT,                     -- [-] topic/field, topic/name/field, or stress/NAME of a hot spot
  unit TEXT,                     -- [-] unit of the channel
  counted INTEGER,               -- [-] 1: its cycles are counted; 0: the following columns are NULL
  least REAL,                    -- [channel] lower end of the full scale
  greatest REAL,                 -- [channel] upper end of the full scale
  classes INTEGER,               -- [-] number of classes of the full scale
  samples INTEGER,               -- [-] values counted, extremes between samples included
  skipped INTEGER,               -- [-] values left out: not a number
  below INTEGER,                 -- [-] values below the full scale, counted in the lowest class
  above INTEGER,                 -- [-] values above the full scale, counted in the highest class
  gaps INTEGER,                  -- [-] places where samples are missing
  minimum REAL,                  -- [channel] minimum of the values
  maximum REAL,                  -- [channel] maximum of the values
  mean_std REAL,                 -- [channel] mean standard deviation of a sample
  range_own_std REAL,            -- [-] relative standard deviation of a turn's range, part that is new in each turn; NULL: not known
  range_systematic_std REAL,     -- [-] relative standard deviation of ranges, part of constants, equal in all turns; NULL: not known
  sn_knee_range REAL,            -- [MPa] range at the knee of the S-N curve of a hot spot; NULL without a curve
  sn_knee_cycles REAL,           -- [-] cycles at the knee
  sn_slope REAL,                 -- [-] slope above the knee range
  sn_slope_below REAL,           -- [-] slope below the knee range
  mean_stress_sensitivity REAL,  -- [-] mean-stress sensitivity M of FKM; NULL: mean stress is not considered
  PRIMARY KEY(run_id, channel)) WITHOUT ROWID;
CREATE TABLE turn_loads(
  run_id INTEGER,               -- [-] number of the run
  turn INTEGER,                 -- [-] number of the turn, as in turns
  channel INTEGER,              -- [-] number of the channel, as in channels
  minimum REAL,                 -- [channel] minimum in the turn
  maximum REAL,                 -- [channel] maximum in the turn
  mean REAL,                    -- [channel] mean over the time of the turn
  minimum_std REAL,             -- [channel] total standard deviation of the minimum
  maximum_std REAL,             -- [channel] total standard deviation of the maximum
  minimum_systematic_std REAL,  -- [channel] systematic part, by constants
  maximum_systematic_std REAL,  -- [channel] systematic part, by constants
  PRIMARY KEY(run_id, turn, channel)) WITHOUT ROWID;
CREATE TABLE cycles(
  run_id INTEGER,   -- [-] number of the run
  channel INTEGER,  -- [-] number of the channel, as in channels
  steps INTEGER,    -- [-] range in classes
  low INTEGER,      -- [-] lower class
  count INTEGER,    -- [-] number of these cycles
  PRIMARY KEY(run_id, channel, steps, low)) WITHOUT ROWID;
CREATE TABLE residues(
  run_id INTEGER,   -- [-] number of the run
  channel INTEGER,  -- [-] number of the channel, as in channels
  place INTEGER,    -- [-] place in time order, from 0
  class INTEGER,    -- [-] class of the turning point
  PRIMARY KEY(run_id, channel, place)) WITHOUT ROWID;
CREATE TABLE boom_cylinders(
  run_id INTEGER,            -- [-] number of the run
  turn INTEGER,              -- [-] number of the turn, as in turns
  cylinder TEXT,             -- [-] name of the cylinder in the boom file
  joint_angle REAL,          -- [rad] angle of its joint
  stiffness_ratio REAL,      -- [-] stiffness of its oil over that of the boom file, equal at every pose
  stiffness_ratio_std REAL,  -- [-] standard deviation; errors of the boom file's masses, equal in every run, are not in it
  doubtful INTEGER,          -- [-] 1: more than oil damps the boom (a warning states the cause), the ratio is uncertain
  PRIMARY KEY(run_id, turn, cylinder)) WITHOUT ROWID;
CREATE TABLE boom_modes(
  run_id INTEGER,          -- [-] number of the run
  turn INTEGER,            -- [-] number of the turn, as in turns
  mode INTEGER,            -- [-] number of the mode, from 1, lowest first
  frequency REAL,          -- [Hz] natural frequency at the pose
  frequency_std REAL,      -- [Hz] standard deviation
  damping_ratio REAL,      -- [-] damping ratio of the mode
  damping_ratio_std REAL,  -- [-] standard deviation
  PRIMARY KEY(run_id, turn, mode)) WITHOUT ROWID;
CREATE TABLE budget(
  run_id INTEGER,  -- [-] number of the run
  quantity TEXT,   -- [-] message/field, or equivalent_range_3/CHANNEL
  unit TEXT,       -- [-] unit of the quantity
  value REAL,      -- [quantity] mean over the run
  std REAL,        -- [quantity] standard deviation
  source TEXT,     -- [-] key of a parameter, readings, or what a level neglects
  share REAL,      -- [-] share of the source in the variance
  PRIMARY KEY(run_id, quantity, source)) WITHOUT ROWID;
CREATE TABLE reference(
  run_id INTEGER,       -- [-] number of the run
  component TEXT,       -- [-] force_x, force_z or torque_y, as in hull_wrench
  unit TEXT,            -- [-] unit of the component
  samples INTEGER,      -- [-] number of measured loads that were compared
  rms REAL,             -- [component] root mean square of the measured load
  rms_error REAL,       -- [component] root mean square of the error, computed less measured
  bias REAL,            -- [component] mean of the error
  scale REAL,           -- [-] slope of the computed load over the measured one, by least squares
  correlation REAL,     -- [-] Pearson correlation of both
  within_two_std REAL,  -- [-] fraction of the errors within two stated standard deviations
  PRIMARY KEY(run_id, component)) WITHOUT ROWID;
CREATE TABLE alarms(
  run_id INTEGER,    -- [-] number of the run
  name TEXT,         -- [-] name of the limit, as in Alarm
  level INTEGER,     -- [-] 1: WARN, 2: ERROR
  unit TEXT,         -- [-] unit of the limit
  value REAL,        -- [limit] value farthest beyond the limit
  value_std REAL,    -- [limit] standard deviation of the value; NULL: not known
  limit_value REAL,  -- [limit] limit that was exceeded
  since_ns INTEGER,  -- [ns] stamp of the blow that ended the first revolution of this level
  until_ns INTEGER,  -- [ns] stamp of the blow that ended the last revolution of this level
  turns INTEGER,     -- [-] number of judged revolutions from the first to the last
  PRIMARY KEY(run_id, name, since_ns)) WITHOUT ROWID;
CREATE TABLE traces(
  run_id INTEGER,    -- [-] number of the run
  kind TEXT,         -- [-] typical or worst
  turn INTEGER,      -- [-] number of the turn, as in turns
  place INTEGER,     -- [-] place in time order, from 0
  time REAL,         -- [s] time after the blow that begins the turn
  force_x REAL,      -- [N] force_x of HullLoads
  force_z REAL,      -- [N] force_z of HullLoads
  torque_y REAL,     -- [N m] torque_y of HullLoads
  force_z_std REAL,  -- [N] standard deviation of force_z
  crank_angle REAL,  -- [rad] crank angle
  PRIMARY KEY(run_id, kind, place)) WITHOUT ROWID;
)";

std::string turnTable(const std::string& name, const std::vector<TableColumn>& columns) {
  std::string sql = "CREATE TABLE " + name +
                    "(\n  run_id INTEGER,  -- [-] number of the run\n"
                    "  turn INTEGER,  -- [-] number of the blow that ends the turn, 1 for the first of the run\n"
                    "  stamp_ns INTEGER,  -- [ns] stamp of that blow\n";
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const TableColumn& column = columns[i];
    sql += "  " + column.name + (column.is_integer ? " INTEGER" : " REAL") + ",  -- [" + column.unit + "] " +
           column.description + '\n';
  }
  return sql + "  PRIMARY KEY(run_id, turn)) WITHOUT ROWID;\n";
}

/// Everything up to the first row, with a comment for each column (life::describeColumns).
std::string beginTablesSql(const std::vector<TableColumn>& turn, const std::vector<TableColumn>& blow) {
  return std::string(kBegin) + "BEGIN;\nPRAGMA application_id = " + std::to_string(kTablesApplication) +
         ";\nPRAGMA user_version = " + std::to_string(kTablesVersion) + ";\n" + kTables + turnTable("turns", turn) +
         turnTable("blows", blow) + life::kColumnsTable;
}

}  // namespace

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

TableWriter::TableWriter(const std::string& file, const std::vector<TableColumn>& turn,
                         const std::vector<TableColumn>& blow)
    : database_(file, life::Database::Use::kWrite, 0) {
  const std::string schema = beginTablesSql(turn, blow);
  database_.run(schema);
  life::describeColumns(schema, database_);
}

TableWriter::Statement& TableWriter::insertInto(const std::string& table, std::size_t values) {
  const auto known = inserts_.find(table);
  if (known != inserts_.end()) return known->second;
  std::string sql = "INSERT INTO " + table + " VALUES(?";
  for (std::size_t i = 1; i < values; ++i) sql += ", ?";
  return inserts_.try_emplace(table, database_, sql + ')').first->second;
}

void TableWriter::addTurn(const std::string& table, std::int64_t run, std::int64_t stamp,
                          const std::vector<double>& values) {
  Statement& insert = insertInto(table, values.size() + 2);
  insert.reset();
  int place = 0;
  insert.bind(++place, run);
  insert.bind(++place, values.front());
  insert.bind(++place, stamp);
  for (std::size_t i = 1; i < values.size(); ++i) insert.bind(++place, values[i]);
  insert.step();
}

void TableWriter::finish() {
  inserts_.clear();
  database_.run("COMMIT");
}

}  // namespace hammer_loads
