-- Tables of a merged file, SQLite or PostgreSQL. Rows of a run are those of process_bag --db with another run_id.
-- Parameters that many runs share are there once. NULL: not determined. Comments of the form "[unit] description" are
-- rows of the table columns; those of the columns that are copied come from the recordings.

CREATE TABLE columns(
  table_name TEXT NOT NULL,   -- [-] name of a table
  column_name TEXT NOT NULL,  -- [-] name of a column of it
  unit TEXT,                  -- [-] unit of its numbers; channel: that of the channel in the same row
  description TEXT,           -- [-] meaning of its values
  PRIMARY KEY(table_name, column_name));

CREATE TABLE bags(
  bag_id INTEGER PRIMARY KEY,  -- [-] number of the bag
  machine TEXT NOT NULL,       -- [-] name of the machine
  bag TEXT NOT NULL,           -- [-] path of the bag in the machine's folder
  input_sha256 TEXT,           -- [-] SHA-256 over the bytes of the bag
  parameters_sha256 TEXT,      -- [-] SHA-256 over every parameter in force
  status TEXT NOT NULL,        -- [-] done, failed, or twice: another bag has the same runs
  reason TEXT,                 -- [-] reason of a failure
  UNIQUE(machine, bag));

CREATE TABLE parameter_sets(parameters_sha256 TEXT PRIMARY KEY, parameters_yaml TEXT NOT NULL);
CREATE TABLE parameter_values(
  parameters_sha256 TEXT NOT NULL, version TEXT NOT NULL, key TEXT NOT NULL, value TEXT, shipped TEXT,
  PRIMARY KEY(parameters_sha256, version, key));

CREATE TABLE runs(
  run_id INTEGER PRIMARY KEY, bag_id INTEGER NOT NULL REFERENCES bags ON DELETE CASCADE, run_key TEXT NOT NULL UNIQUE,
  input_sha256 TEXT NOT NULL, parameters_sha256 TEXT NOT NULL, machine TEXT NOT NULL, version TEXT NOT NULL,
  revision TEXT NOT NULL, first_stamp_ns BIGINT, last_stamp_ns BIGINT, day TEXT, week TEXT,
  duration DOUBLE PRECISION, level TEXT, samples BIGINT, published BIGINT, restarts BIGINT, turns BIGINT,
  blows BIGINT, backward_passes BIGINT, consistency DOUBLE PRECISION, timing_noise DOUBLE PRECISION,
  speed_noise DOUBLE PRECISION, angle_resolution DOUBLE PRECISION, drive_inertia DOUBLE PRECISION,
  drive_inertia_relative_std DOUBLE PRECISION, equivalent_cycles_per_hour DOUBLE PRECISION, blank_firings BIGINT,
  judged_blows BIGINT, blows_without_hold_down BIGINT, still_time DOUBLE PRECISION, hull_pitch DOUBLE PRECISION);
CREATE INDEX runs_of_bag ON runs(bag_id);

CREATE VIEW parameters AS
  SELECT run_id, key, value, shipped FROM runs JOIN parameter_values USING(parameters_sha256, version);

CREATE TABLE refusals(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, reason TEXT NOT NULL, count BIGINT NOT NULL,
  PRIMARY KEY(run_id, reason));
CREATE TABLE warnings(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, place INTEGER NOT NULL, key TEXT, text TEXT,
  PRIMARY KEY(run_id, place));
CREATE TABLE alarms(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, name TEXT NOT NULL, level INTEGER, unit TEXT,
  value DOUBLE PRECISION, value_std DOUBLE PRECISION, limit_value DOUBLE PRECISION, since_ns BIGINT, until_ns BIGINT,
  turns BIGINT, PRIMARY KEY(run_id, name, since_ns));
CREATE TABLE reference(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, component TEXT NOT NULL, unit TEXT, samples BIGINT,
  rms DOUBLE PRECISION, rms_error DOUBLE PRECISION, bias DOUBLE PRECISION, scale DOUBLE PRECISION,
  correlation DOUBLE PRECISION, within_two_std DOUBLE PRECISION, PRIMARY KEY(run_id, component));

CREATE TABLE run_figures(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE,  -- [-] number of the run
  quantity TEXT NOT NULL,     -- [-] blow_rate [Hz], or a column of turns or blows
  count BIGINT NOT NULL,      -- [-] number of turns with a value
  least DOUBLE PRECISION,     -- [quantity] least value of a revolution
  mean DOUBLE PRECISION,      -- [quantity] mean over the revolutions
  greatest DOUBLE PRECISION,  -- [quantity] greatest value of a revolution
  total DOUBLE PRECISION,     -- [quantity] sum over the revolutions
  PRIMARY KEY(run_id, quantity));

CREATE TABLE run_cylinders(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE,  -- [-] number of the run
  cylinder TEXT NOT NULL,                -- [-] name of the cylinder
  turns BIGINT NOT NULL,                 -- [-] number of turns
  stiffness_ratio DOUBLE PRECISION,      -- [-] mean stiffness of its oil over that of the boom file
  stiffness_ratio_std DOUBLE PRECISION,  -- [-] mean standard deviation
  doubtful DOUBLE PRECISION,             -- [-] share of the revolutions whose damping is not that of oil
  PRIMARY KEY(run_id, cylinder));

CREATE TABLE channels(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, channel INTEGER NOT NULL, name TEXT NOT NULL,
  unit TEXT, counted INTEGER, least DOUBLE PRECISION, greatest DOUBLE PRECISION, classes INTEGER, samples BIGINT,
  skipped BIGINT, below BIGINT, above BIGINT, gaps BIGINT, minimum DOUBLE PRECISION, maximum DOUBLE PRECISION,
  mean_std DOUBLE PRECISION, range_own_std DOUBLE PRECISION, range_systematic_std DOUBLE PRECISION,
  sn_knee_range DOUBLE PRECISION, sn_knee_cycles DOUBLE PRECISION, sn_slope DOUBLE PRECISION,
  sn_slope_below DOUBLE PRECISION, mean_stress_sensitivity DOUBLE PRECISION, PRIMARY KEY(run_id, channel));
CREATE TABLE cycles(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, channel INTEGER NOT NULL, steps INTEGER NOT NULL,
  low INTEGER NOT NULL, count BIGINT NOT NULL, PRIMARY KEY(run_id, channel, steps, low));
CREATE TABLE residues(
  run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, channel INTEGER NOT NULL, place INTEGER NOT NULL,
  class INTEGER NOT NULL, PRIMARY KEY(run_id, channel, place));

-- Machines that got a bag and whose sums are still to be written.
CREATE TABLE stale_machines(
  machine TEXT PRIMARY KEY  -- [-] name of the machine
);

-- Sums of a machine over all its runs: written again for each machine that got a bag. Another hammer, boom or grid
-- (identity, least, greatest, classes) is another row. remaining_hours NULL: no end in sight, or no S-N curve.
CREATE TABLE machine_channels(
  machine_channel INTEGER PRIMARY KEY, machine TEXT NOT NULL, identity TEXT NOT NULL, name TEXT NOT NULL, unit TEXT,
  least DOUBLE PRECISION, greatest DOUBLE PRECISION, classes INTEGER, hours DOUBLE PRECISION, samples BIGINT,
  skipped BIGINT, below BIGINT, above BIGINT, gaps BIGINT, minimum DOUBLE PRECISION, maximum DOUBLE PRECISION,
  mean_std DOUBLE PRECISION, range_own_std DOUBLE PRECISION, range_systematic_std DOUBLE PRECISION,
  sn_knee_range DOUBLE PRECISION, sn_knee_cycles DOUBLE PRECISION,
  sn_slope DOUBLE PRECISION, sn_slope_below DOUBLE PRECISION, mean_stress_sensitivity DOUBLE PRECISION,
  equivalent_cycles_per_hour DOUBLE PRECISION, largest_range DOUBLE PRECISION, damage DOUBLE PRECISION,
  remaining_hours DOUBLE PRECISION);
CREATE TABLE machine_equivalents(
  machine_channel INTEGER NOT NULL REFERENCES machine_channels ON DELETE CASCADE,  -- [-] number of the channel of a machine
  slope DOUBLE PRECISION NOT NULL,    -- [-] slope of the S-N line
  equivalent_range DOUBLE PRECISION,  -- [channel] damage-equivalent range
  std DOUBLE PRECISION,               -- [channel] standard deviation
  PRIMARY KEY(machine_channel, slope));
CREATE TABLE machine_cycles(
  machine_channel INTEGER NOT NULL REFERENCES machine_channels ON DELETE CASCADE, steps INTEGER NOT NULL,
  low INTEGER NOT NULL, count BIGINT NOT NULL, PRIMARY KEY(machine_channel, steps, low));
CREATE TABLE machine_residues(
  machine_channel INTEGER NOT NULL REFERENCES machine_channels ON DELETE CASCADE, place INTEGER NOT NULL,
  class INTEGER NOT NULL, PRIMARY KEY(machine_channel, place));
