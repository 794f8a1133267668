"""Loads of a crank-rocker hydraulic hammer, with NumPy arrays in and out.

    import hammer_loads_py as hl
    hammer = hl.Hammer.from_yaml("my_hammer.yaml")
    loads = hammer.wrenches(angle, speed)       # a dictionary of arrays: force_x, force_z, torque_y

SI units. Results are named as the fields of the messages; help() of each call states units and frames.
Wrong input raises ValueError in the words of the commands, one line for each problem. Loops run without Python's
lock, so that threads share the work.
"""
import math
import os
import sqlite3
import stat
import urllib.parse

import numpy as np

from . import _native
from ._native import Boom, Hammer, support_impulse

__all__ = ["Boom", "Hammer", "count_cycles", "read_database", "support_impulse"]

_WRENCH = ["force_x", "force_z", "torque_y"]
_PINS = ["drive_torque"] + [f"R{pair}_{axis}" for pair in ("01", "12", "23", "03") for axis in "xz"]
_DATABASES = (0x484C5242, 0x484C4C31, 0x484C5246)  # application_id of process_bag --db, a ledger, the fleet
_LARGEST_ANGLE = 4e8  # [rad]
_PATIENCE = 5.0  # [s] until another user of a database gives it back


def _array(name, value):
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {repr(value)[:60]}, must be a number or an array of numbers") from None


def _number(name, value, unit, least=-math.inf, most=math.inf):
    """Above 0 where that is the least."""
    if _array(name, value).ndim > 0:
        raise ValueError(f"{name}: {repr(value)[:60]}, must be a number")
    value = float(value)
    rule = "a finite number"
    if least > -math.inf:
        rule += " > 0" if least == 0.0 else f" >= {least}"
    if most < math.inf:
        rule += f" and <= {most}"
    if not (math.isfinite(value) and (value > 0.0 if least == 0.0 else value >= least) and value <= most):
        raise ValueError(f"{name}: {value} {unit}, must be {rule}")
    return value


def _gravity(hammer, gravity):
    g = hammer.gravity if gravity is None else float(gravity)
    if not (math.isfinite(g) and g >= 0.0):
        raise ValueError(f"gravity: {g} m/s2, must be a finite number >= 0")
    return g


def _weight(hammer, pitch, gravity):
    """Gravity at one pitch: components along the hull's axes x and z [m/s2]."""
    if pitch is None:
        return 0.0, 0.0
    g, pitch = _gravity(hammer, gravity), _number("pitch", pitch, "rad")
    return g * math.sin(pitch), -g * math.cos(pitch)


def _wrenches(self, angle, speed, acceleration=0.0, *, pitch=None, gravity=None, level=None, pins=False):
    """Returns the loads of many states of the crank, as the command evaluate does.

    angle [rad]: crank angle, 0 at the blow, at most 4e8; just below 0 is just before a blow.
    speed [rad/s], acceleration [rad/s2]: of the crank.
    pitch [rad]: of the hull; None leaves the weight out. gravity [m/s2]: of the parameters unless given.
    level: 'pulse', 'rocker' or 'linkage'; that of the parameters unless given.
    Numbers, arrays of one shape, or arrays that NumPy broadcasts to one; a nan gives nan.

    The result has arrays force_x, force_z [N], torque_y [N m]: wrench by the links on the hull, moment about the
    rocker's pivot, axes of hammer_hull. pins=True adds drive_torque [N m] and Rij_x, Rij_z [N], the force of link i on
    link j (0 hull, 1 crank, 2 rod, 3 rocker).
    """
    given = [_array(*pair) for pair in (("angle", angle), ("speed", speed), ("acceleration", acceleration),
                                        ("pitch", 0.0 if pitch is None else pitch))]
    states = np.broadcast_arrays(*given)
    shape = states[0].shape
    angle, speed, acceleration, pitches = (np.ascontiguousarray(state).ravel() for state in states)
    if (np.abs(angle) > _LARGEST_ANGLE).any():
        raise ValueError("crank_angle: must be a number of size <= 4e8 rad")
    if pitch is None or given[3].ndim == 0:
        loads = self._loads(angle, speed, acceleration, _weight(self, pitch, gravity), level, pins)
    else:  # loads are linear in gravity: those without it and those of each of its components
        g, rest = _gravity(self, gravity), np.zeros_like(angle)
        loads = (self._loads(angle, speed, acceleration, (0.0, 0.0), level, pins) +
                 g * np.sin(pitches) * self._loads(angle, rest, rest, (1.0, 0.0), level, pins) -
                 g * np.cos(pitches) * self._loads(angle, rest, rest, (0.0, 1.0), level, pins))
    return {name: row.reshape(shape) for name, row in zip(_WRENCH + _PINS, loads)}


def _turn(self, speed=31.416, *, step_deg=1.0, pitch=None, gravity=None, level=None, pins=False):
    """Returns one revolution at constant crank speed, as the command turn_table does.

    speed [rad/s], step_deg [deg]: of the crank. pitch [rad], gravity [m/s2], level, pins: as in wrenches().
    The result has arrays crank_angle [rad], time [s], force_x, force_z [N], torque_y [N m]. The first row is just after a
    blow, the last one just before the next.
    """
    speed, step = _number("speed", speed, "rad/s", 0.0), _number("step_deg", step_deg, "deg", 1e-6, 360.0)
    angle = np.radians(np.append(np.arange(0.0, 360.0 * (1.0 - 1e-12), step), 360.0))
    states = np.append(angle[:-1], -1e-300)
    loads = _wrenches(self, states, speed, pitch=pitch, gravity=gravity, level=level, pins=pins)
    return {"crank_angle": angle, "time": angle / speed, **loads}


def _pulse(self, speed=31.416, *, pitch=None, gravity=None, level=None):
    """Returns the force pulse of one revolution at constant crank speed, as turn_table --summary.

    speed [rad/s]: of the crank. pitch [rad], gravity [m/s2], level: as in wrenches().
    The result has the fields of message Pulse: amplitude [N], impulse, turn_impulse_x, turn_impulse_z [N s],
    angular_frequency [rad/s], start [s]; and peak_angle [rad] of the crank.
    """
    return self._pulse(_number("speed", speed, "rad/s", 0.0), _weight(self, pitch, gravity), level)


def _blow(self, crank_speed, crank_speed_after=None, *, level=None):
    """Returns the blow of a crank that passes the dead centre at a speed.

    crank_speed, crank_speed_after [rad/s]: before and after the blow; the crank keeps its speed unless the second is given.
    level: as in wrenches().
    The result has the fields of message Blow: speeds [rad/s], restitution [-], energy [J], impulses [N s]. The support
    impulse is by the rocker on the hull at its pivot.
    """
    before = _number("crank_speed", crank_speed, "rad/s", 0.0)
    after = crank_speed_after
    return self._blow(before, None if after is None else _number("crank_speed_after", after, "rad/s"), level)


Hammer.wrenches, Hammer.turn, Hammer.pulse, Hammer.blow = _wrenches, _turn, _pulse, _blow


def _boom_loads(self, joints, time, force_x, force_z, torque_y, *, compliant=True):
    """Returns what a load of the hammer does to the boom, without the weight of both.

    joints [rad]: position by joint name; a joint that is missing is at 0. The pose does not change.
    time [s], force_x, force_z [N], torque_y [N m]: load by the hammer on the hull at the origin of hammer_hull, axes of
    that frame. Time never falls; two rows of one time are both sides of a jump. The impulse of a blow is not among them.
    compliant: the joints vibrate on the oil of their cylinders, from rest at the first time; False: a rigid boom.

    The result has JOINT_torque_Nm for each joint, about its axis, positive where it drives the joint forward; and
    SECTION_force_x_N, SECTION_force_z_N, SECTION_moment_y_Nm for each section, by what is beyond the cut on what is
    before it, axes of the cut.
    """
    names = ("time", "force_x", "force_z", "torque_y")
    rows = np.broadcast_arrays(*(_array(*pair) for pair in zip(names, (time, force_x, force_z, torque_y))))
    shape = rows[0].shape
    rows = np.array([row.ravel() for row in rows])
    if not (np.isfinite(rows).all() and (np.diff(rows[0]) >= 0.0).all()):
        raise ValueError("time: must never fall; force_x, force_z, torque_y: must be finite")
    keys = [joint + "_torque_Nm" for joint in self.joints] + [
        section + ending for section in self.sections for ending in ("_force_x_N", "_force_z_N", "_moment_y_Nm")]
    return {key: row.reshape(shape) for key, row in zip(keys, self._loads(joints, rows, compliant))}


Boom.loads = _boom_loads


def count_cycles(series, *, full_scale=None, classes=4096):
    """Counts the load cycles of a series, as the command count_cycles does.

    series: loads in their order, in any unit; nan and inf are skipped.
    full_scale: (least, greatest) load of a grid of so many classes; None counts every value as it is.
    The result has arrays range and mean [unit of the series] and count [-] after ASTM E1049, sorted by range, then mean.
    The residue counts as half cycles.
    """
    values = _array("series", series)
    if values.ndim > 1:
        raise ValueError("series: has more than one dimension, must have one")
    return dict(zip(("range", "mean", "count"), _native.count_cycles(values.ravel(), full_scale, classes)))


def _column(declared, values):
    """Column as an array, by the type that its table declares."""
    if "INT" in declared and None not in values:
        return np.array(values, dtype=np.int64)
    return np.array(values, dtype=float if "INT" in declared or "REAL" in declared else object)  # None: nan


def read_database(path):
    """Reads every table of a database of process_bag --db, of a ledger or of the fleet.

    path: of the file. The result has a dictionary of arrays for each table, by column; the table `columns` has units.
    Whole numbers are int64, or float64 where one is missing; texts are objects. A missing value is nan or None.
    """
    path = os.fspath(path)
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise ValueError(f"{path}: is no regular file")
        with open(path, "rb") as file:
            if file.read(16) != b"SQLite format 3\0":
                raise ValueError(f"{path}: is no SQLite file")
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}") from None
    database = sqlite3.connect(f"file:{urllib.parse.quote(path)}?mode=ro", uri=True, timeout=_PATIENCE,
                               isolation_level=None)
    database.text_factory = lambda text: text.decode(errors="replace")
    tables = {}
    try:
        database.execute("BEGIN")  # all of one instant
        kind, = database.execute("PRAGMA application_id").fetchone()
        if kind not in _DATABASES:
            raise ValueError(f"{path}: is another database (application_id {kind}), must be written by "
                             "process_bag --db, --ledger or the fleet")
        names = database.execute("SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%' "
                                 "ORDER BY name").fetchall()
        for name, in names:
            rows = database.execute(f"SELECT * FROM {name}").fetchall()
            tables[name] = {column: _column(declared, [row[place] for row in rows])
                            for place, column, declared, *_ in database.execute(f"PRAGMA table_info({name})")}
    except sqlite3.Error as error:
        raise ValueError(f"{path}: {error}") from None
    finally:
        database.close()
    return tables
