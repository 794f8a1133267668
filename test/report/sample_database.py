"""Databases as process_bag --db writes them, from simple formulas of a hammer at work; for tests and for measuring.

Half-sine pulses at 5 Hz whose peak wanders slowly; each channel is a share of the pulse. The cycles are counted here by
a plain reading of ASTM E1049 (three-point counting of the whole), which shares no code with the package.
"""
import hashlib
import math
import os
import random
import sqlite3

APPLICATION_ID, VERSION = 0x484C5242, 1
SECOND = 1000000000
RATE_HZ = 5.0
PULSE = ["period", "amplitude", "angular_frequency", "start", "impulse", "turn_impulse_x",
         "turn_impulse_z", "half_sine_rms_error"]
STD = ["mean_std", "range_own_std", "range_systematic_std"]
BLOW = ["rocker_speed_before", "rocker_speed_after", "restitution", "energy", "tool_impulse_x",
        "tool_impulse_z", "support_impulse_x", "support_impulse_z", "mean_hold_down_force"]


def columns(names):
    return ", ".join(name + " REAL" for name in names)


SCHEMA = f"""
CREATE TABLE runs(run_id INTEGER PRIMARY KEY, run_key TEXT NOT NULL UNIQUE, input_sha256 TEXT NOT NULL,
  parameters_sha256 TEXT NOT NULL, machine TEXT NOT NULL, version TEXT NOT NULL, revision TEXT NOT NULL,
  parameters_yaml TEXT NOT NULL, first_stamp_ns INTEGER, last_stamp_ns INTEGER, duration REAL, level TEXT,
  samples INTEGER, published INTEGER, restarts INTEGER, turns INTEGER, blows INTEGER, backward_passes INTEGER,
  consistency REAL, timing_noise REAL, speed_noise REAL, angle_resolution REAL,
  drive_inertia REAL, drive_inertia_relative_std REAL, equivalent_cycles_per_hour REAL, blank_firings INTEGER,
  judged_blows INTEGER, blows_without_hold_down INTEGER, still_time REAL, hull_pitch REAL);
CREATE TABLE parameters(run_id INTEGER, key TEXT, value TEXT, shipped TEXT, PRIMARY KEY(run_id, key));
CREATE TABLE refusals(run_id INTEGER, reason TEXT, count INTEGER);
CREATE TABLE warnings(run_id INTEGER, place INTEGER, key TEXT, text TEXT);
CREATE TABLE turns(run_id INTEGER, turn INTEGER, stamp_ns INTEGER, {columns(PULSE)}, amplitude_std REAL,
  PRIMARY KEY(run_id, turn));
CREATE TABLE blows(run_id INTEGER, turn INTEGER, stamp_ns INTEGER, {columns(BLOW)}, energy_std REAL,
  restitution_std REAL, PRIMARY KEY(run_id, turn));
CREATE TABLE channels(run_id INTEGER, channel INTEGER, name TEXT, unit TEXT, counted INTEGER, least REAL,
  greatest REAL, classes INTEGER, samples INTEGER, skipped INTEGER, below INTEGER, above INTEGER, gaps INTEGER,
  minimum REAL, maximum REAL, {columns(STD)}, sn_knee_range REAL, sn_knee_cycles REAL, sn_slope REAL,
  sn_slope_below REAL, mean_stress_sensitivity REAL, PRIMARY KEY(run_id, channel));
CREATE TABLE turn_loads(run_id INTEGER, turn INTEGER, channel INTEGER, minimum REAL, maximum REAL, mean REAL,
  PRIMARY KEY(run_id, turn, channel)) WITHOUT ROWID;
CREATE TABLE cycles(run_id INTEGER, channel INTEGER, steps INTEGER, low INTEGER, count INTEGER,
  PRIMARY KEY(run_id, channel, steps, low)) WITHOUT ROWID;
CREATE TABLE residues(run_id INTEGER, channel INTEGER, place INTEGER, class INTEGER,
  PRIMARY KEY(run_id, channel, place)) WITHOUT ROWID;
CREATE TABLE boom_cylinders(run_id INTEGER, turn INTEGER, cylinder TEXT, joint_angle REAL, stiffness_ratio REAL,
  stiffness_ratio_std REAL, doubtful INTEGER, PRIMARY KEY(run_id, turn, cylinder));
CREATE TABLE boom_modes(run_id INTEGER, turn INTEGER, mode INTEGER, frequency REAL, frequency_std REAL,
  damping_ratio REAL, damping_ratio_std REAL, PRIMARY KEY(run_id, turn, mode));
CREATE TABLE alarms(run_id INTEGER, name TEXT, level INTEGER, unit TEXT, value REAL, value_std REAL, limit_value REAL,
  since_ns INTEGER, until_ns INTEGER, turns INTEGER, PRIMARY KEY(run_id, name, since_ns));
CREATE TABLE reference(run_id INTEGER, component TEXT, unit TEXT, samples INTEGER, rms REAL, rms_error REAL, bias REAL,
  scale REAL, correlation REAL, within_two_std REAL, PRIMARY KEY(run_id, component));
CREATE TABLE budget(run_id INTEGER, quantity TEXT, unit TEXT, value REAL, std REAL, source TEXT, share REAL);
CREATE TABLE columns(table_name TEXT, column_name TEXT, unit TEXT, description TEXT);
CREATE TABLE traces(run_id INTEGER, kind TEXT, turn INTEGER, place INTEGER, time REAL, force_x REAL,
  force_z REAL, torque_y REAL, force_z_std REAL, crank_angle REAL);
"""

# Share of the pulse, offset; the first three are counted, and so is the stress.
WRENCH = [("hull_wrench/force_x", 0.18, 0.0, 200e3), ("hull_wrench/force_z", 1.0, 0.0, 200e3),
          ("hull_wrench/torque_y", 0.05, 0.0, 50e3)]
JOINTS = ["boom_joint", "arm_joint", "hammer_joint"]
PARTS = ["hammer", "weight", "motion", "vibration", "total"]
SECTIONS = ["boom_foot", "boom_head", "arm_foot", "arm_head"]
STRESS = ("stress/boom_foot", 1.5e-3, 40.0, 400.0)


def channel_list(boom):
    """(name, share of the pulse's force, mean, half of the full scale or None where not counted)."""
    result = list(WRENCH)
    if not boom:
        return result
    for i, joint in enumerate(JOINTS):
        for j, part in enumerate(PARTS):
            result.append((f"joint_loads/{joint}/{part}_torque", (3 - i) * (0.4 + 0.2 * j), (j == 1) * 4e3, None))
        result.append((f"joint_loads/{joint}_cylinder/force", 2.0 - 0.5 * i, 5e4, None))
    for i, section in enumerate(SECTIONS):
        for field, share in (("force_x", 0.3), ("force_z", 0.9), ("torque_y", 1.7 - 0.3 * i)):
            result.append((f"section_loads/{section}/{field}", share, 2e3 * i, None))
    result.append(STRESS)
    return result


def unit_of(channel):
    return next((unit for word, unit in (("stress/", "MPa"), ("torque", "N m"), ("energy", "J")) if word in channel), "N")


def class_of(value, full_scale, classes):
    place = int((value + full_scale) / (2 * full_scale / classes))
    return min(max(place, 0), classes - 1)


def turning_points(series):
    points = []
    for value in series:
        if points and value == points[-1]:
            continue
        if len(points) >= 2 and (points[-1] - points[-2]) * (value - points[-1]) > 0:
            points[-1] = value
        else:
            points.append(value)
    return points


def count_all(series):
    """Closed cycles {(low, high): count} and residue, by taking out the smallest inner range again and again."""
    points, closed = turning_points(series), {}
    at = 0
    while at + 3 < len(points):
        a, b, c, d = points[at:at + 4]
        if min(a, d) <= min(b, c) and max(b, c) <= max(a, d):
            key = (min(b, c), max(b, c))
            closed[key] = closed.get(key, 0) + 1
            del points[at + 1:at + 3]
            at = max(0, at - 2)
        else:
            at += 1
    return closed, points


def sha(text):
    return hashlib.sha256(text.encode()).hexdigest()


class Machine:
    """Properties that differ between two machines of a fleet."""

    def __init__(self, name="mo100", peak_N=40600.0, jitter_s=2e-5, curve=True, parameters=None, misuse=(0, 0, None, None),
                 oil=None):
        self.name, self.peak_N, self.jitter_s, self.curve = name, peak_N, jitter_s, curve
        self.oil = oil or {}  # by cylinder: stiffness over the boom file's, change from run to run, doubtful
        self.misuse = misuse  # blank firing, blows judged, of these unpressed, seconds at one place
        self.parameters = {"rocker_mass_kg": ("35.2", "35.2"), "hammer": (name, "mo100"),
                           "crank_ratio": ("1.0", "1.0"), **(parameters or {})}


def turn_of(machine, turn, rng):
    """Pulse and blow of one turn: the peak wanders with the rock over minutes."""
    rock = 1.0 + 0.15 * math.sin(turn / 700.0) + rng.gauss(0.0, 0.04)
    period = 1.0 / RATE_HZ * (1.0 + rng.gauss(0.0, 0.004))
    amplitude = machine.peak_N * max(0.2, rock)
    mu = 31.4
    impulse = 2.0 * amplitude / mu
    before = -17.0 * math.sqrt(max(0.2, rock))
    restitution = 0.25 + rng.gauss(0.0, 0.02)
    energy = 0.5 * 0.737 * before * before * (1.0 - restitution ** 2)
    pulse = (period, amplitude, mu, max(0.0, period - math.pi / mu), impulse, 0.1 * impulse, 0.93 * impulse,
             0.08 + abs(rng.gauss(0.0, 0.01)))
    tool = 0.737 * -before * (1 + restitution) / 0.1975
    blow = (before, -restitution * before, restitution, energy, 0.02 * tool, tool, 0.1 * tool, -0.4 * tool,
            tool / period if turn > 1 else None)
    return pulse, blow


def write_run(db, run_id, machine, seconds, first_ns, seed, boom, classes, warnings, refusals, restarts):
    rng = random.Random(seed)
    channels = channel_list(boom)
    turns = int(seconds * RATE_HZ)
    series = {i: [] for i, c in enumerate(channels) if c[3]}
    stamp, pulses, blows, loads = first_ns, [], [], []
    for turn in range(1, turns + 1):
        pulse, blow = turn_of(machine, turn, rng)
        stamp += int(pulse[0] * SECOND)
        pulses.append((run_id, turn, stamp) + pulse)
        blows.append((run_id, turn, stamp) + blow)
        for i, (_, share, mean, scale) in enumerate(channels):
            high = mean + share * pulse[1]
            low = mean - 0.25 * share * pulse[1] * (1 + rng.gauss(0.0, 0.05))
            if i in series:
                series[i] += [low, high]
            loads.append((run_id, turn, i, low, high, mean + 0.3 * share * pulse[1]))
    db.executemany(f"INSERT INTO turns VALUES({','.join('?' * (3 + len(PULSE)))},NULL)", pulses)
    db.executemany(f"INSERT INTO blows VALUES({','.join('?' * (3 + len(BLOW)))},NULL,NULL)", blows)
    db.executemany("INSERT INTO turn_loads VALUES(?,?,?,?,?,?)", loads)
    write_oil(db, run_id, machine, turns, rng)
    for i, (name, _, _, scale) in enumerate(channels):
        low, high = (min(series[i]), max(series[i])) if series.get(i) else (None, None)
        stress = name.startswith("stress/") and machine.curve
        db.execute(f"INSERT INTO channels VALUES({','.join('?' * 23)})",
                   (run_id, i, name, unit_of(name), int(bool(scale)), -scale if scale else None, scale,
                    classes if scale else None, int(1000 * seconds), 0, 0, 0, restarts, low, high,
                    0.01 * machine.peak_N if name.endswith("force_z") else None, None, None,
                    *((80.0, 1e7, 3.0, 5.0, None) if stress else (None,) * 5)))
        if not scale:
            continue
        closed, residue = count_all([class_of(v, scale, classes) for v in series[i]])
        db.executemany("INSERT INTO cycles VALUES(?,?,?,?,?)",
                       [(run_id, i, b - a, a, n) for (a, b), n in sorted(closed.items())])
        db.executemany("INSERT INTO residues VALUES(?,?,?,?)", [(run_id, i, p, c) for p, c in enumerate(residue)])
    for kind, turn in (("typical", turns // 2), ("worst", turns // 3)):
        if turn >= 1:
            write_trace(db, run_id, kind, turn, pulses[turn - 1][3:], rng)
    text = "".join(f"{key}: {value}\n" for key, (value, _) in sorted(machine.parameters.items()))
    source = sha(f"bag {machine.name} {seed} {seconds} {first_ns}")
    db.execute(f"INSERT INTO runs VALUES({','.join('?' * 30)})",
               (run_id, sha(source + sha(text) + "0.1.0" + str(run_id)), source, sha(text),
                sha("machine " + machine.name), "0.1.0", "abc1234", text, first_ns, stamp, stamp / SECOND -
                first_ns / SECOND, "linkage", int(1000 * seconds) + 9, int(1000 * seconds), restarts, len(pulses),
                len(blows), 0, 0.9, machine.jitter_s, None, 1.5e-3, 0.29, 0.02, 3600.0, *machine.misuse, 0.35))
    db.executemany("INSERT INTO parameters VALUES(?,?,?,?)",
                   [(run_id, k, v, s) for k, (v, s) in sorted(machine.parameters.items())])
    db.executemany("INSERT INTO refusals VALUES(?,?,?)", [(run_id, r, n) for r, n in refusals.items()])
    db.executemany("INSERT INTO warnings VALUES(?,?,?,?)",
                   [(run_id, i, key, line) for i, (key, line) in enumerate(warnings)])
    return stamp


def write_oil(db, run_id, machine, turns, rng):
    """Writes the rows of a watched boom: every revolution a value near the last one, and its modes."""
    for name, (stiffness, change, doubtful) in machine.oil.items():
        db.executemany("INSERT INTO boom_cylinders VALUES(?,?,?,?,?,?,?)",
                       [(run_id, turn, name, -0.5, stiffness + change * (run_id - 1) + rng.gauss(0.0, 0.002), 0.01, doubtful)
                        for turn in range(1, turns + 1)])
    for mode in range(1, len(machine.oil) + 1):
        db.executemany("INSERT INTO boom_modes VALUES(?,?,?,?,?,?,?)",
                       [(run_id, turn, mode, 4.0 * mode + 0.01 * (turn % 10), 0.1, 0.05, 0.005) for turn in range(1, turns + 1)])


def write_trace(db, run_id, kind, turn, pulse, rng):
    period, amplitude, mu, start = pulse[:4]
    for place in range(int(period * 1000)):
        t = place / 1000.0
        force = amplitude * math.sin(mu * (t - start)) if t > start else -0.06 * amplitude
        db.execute("INSERT INTO traces VALUES(?,?,?,?,?,?,?,?,?,?)",
                   (run_id, kind, turn, place, t, 0.2 * force, force, 0.05 * force + 30.0,
                    0.01 * amplitude * (1 + 2 * t / period), 2 * math.pi * t / period))


def make(path, machine=None, seconds=60.0, first_ns=1700000000 * SECOND, seed=1, boom=True, classes=1024, runs=1,
         warnings=(), refusals=None, restarts=0):
    """Writes a database; returns the stamp of its last blow [ns]."""
    machine = machine or Machine()
    if os.path.exists(path):
        os.unlink(path)
    db = sqlite3.connect(str(path), isolation_level=None)
    db.execute("PRAGMA journal_mode = OFF")
    db.execute("PRAGMA synchronous = OFF")
    db.executescript(SCHEMA)
    db.execute("BEGIN")  # not before: executescript ends a transaction, and then every row is one
    stamp = first_ns
    for run_id in range(1, runs + 1):
        stamp = write_run(db, run_id, machine, seconds, stamp, seed + run_id, boom, classes, warnings,
                          refusals or {}, restarts) + 30 * SECOND
    db.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    db.execute(f"PRAGMA user_version = {VERSION}")
    if db.in_transaction:
        db.execute("COMMIT")
    db.close()
    return stamp
