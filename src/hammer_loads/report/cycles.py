"""Counted channels: load cycles on a grid, by the rule of life/four_point.h (doc/fatigue.md, 2), and what they cost, by the
formulas of life/damage.h (doc/fatigue.md, 3).

Cycles are an array of three rows: range, mean, count. A figure is (value, standard deviation); the deviation is None where
the loads have none.
"""
from collections import Counter, namedtuple
from functools import cached_property
import math

import numpy

SLOPES = (3.0, 4.0, 5.0, 10.0)
SUMS = ("samples", "skipped", "below", "above", "gaps")
CURVE = ("sn_knee_range", "sn_knee_cycles", "sn_slope", "sn_slope_below", "mean_stress_sensitivity")
# Standard deviations: of a sample; over the range: of a single revolution, and of constants, which does not average out.
MEANS = ("mean_std", "range_own_std", "range_systematic_std")

# Sums over runs, in the SQL of SQLite and PostgreSQL. Means are weighted by the samples of the runs that have them.
IDENTITY = ("identity", "name", "least", "greatest", "classes")
OF_CHANNEL = "FROM runs r JOIN channels c USING(run_id) "
SAME = "r.machine = ? AND c.name = ? AND c.least = ? AND c.greatest = ? AND c.classes = ?"
SUMMED = {
    "hours": "sum(r.duration) / 3600", "equivalent_cycles_per_hour": "max(r.equivalent_cycles_per_hour)",
    "minimum": "min(c.minimum)", "maximum": "max(c.maximum)", **{name: f"CAST(sum(c.{name}) AS BIGINT)" for name in SUMS},
    **{name: f"CAST(sum(c.{name} * c.samples) AS DOUBLE PRECISION) / "
             f"nullif(sum(CASE WHEN c.{name} IS NULL THEN 0 ELSE c.samples END), 0)" for name in MEANS}}
CHANNELS = (f"SELECT r.machine, c.name, c.least, c.greatest, c.classes, {', '.join(SUMMED.values())} {OF_CHANNEL} "
            "WHERE {0} AND c.counted = 1 GROUP BY r.machine, c.name, c.least, c.greatest, c.classes "
            "ORDER BY r.machine, min(c.channel)")
LATEST = (f"SELECT c.unit, {', '.join('c.' + name for name in CURVE)} {OF_CHANNEL} WHERE {{0}} AND {SAME} "
          "ORDER BY r.first_stamp_ns DESC LIMIT 1")
CYCLES = (f"SELECT y.steps, y.low, CAST(sum(y.count) AS BIGINT) {OF_CHANNEL} JOIN cycles y USING(run_id, channel) "
          f"WHERE {{0}} AND {SAME} GROUP BY y.steps, y.low")
RESIDUES = (f"SELECT s.class {OF_CHANNEL} JOIN residues s USING(run_id, channel) WHERE {{0}} AND {SAME} "
            "ORDER BY r.first_stamp_ns, r.run_key, s.place")


class Count:
    """Closed cycles {(steps, low): count} and residue (classes in time order) on a grid of equal classes: they add exactly."""

    def __init__(self, least, greatest, classes):
        self.grid = (least, greatest, classes)
        self.closed, self.residue = Counter(), []

    @property
    def width(self):
        least, greatest, classes = self.grid
        return (greatest - least) / classes

    def add_closed(self, cycles):
        """cycles: (steps, low, count)."""
        for steps, low, count in cycles:
            self.closed[steps, low] += count

    def join(self, residue):
        """The series goes on with what has this residue. Returns the cycles that close across the seam, which are added."""
        across = []
        for point in residue:
            push(self.residue, point, across)
        self.add_closed(across)
        return across

    def cycles(self):
        """Cycles sorted by range, then mean; the residue as half cycles."""
        halves = Counter({cell: 2 * count for cell, count in self.closed.items()})
        halves.update((abs(b - c), min(b, c)) for b, c in zip(self.residue, self.residue[1:]))
        steps, low = numpy.array(sorted(halves), dtype=float).reshape(-1, 2).T
        counts = numpy.array([halves[cell] for cell in sorted(halves)], dtype=float)
        return numpy.array([steps * self.width, self.grid[0] + (low + 0.5 * steps + 0.5) * self.width, 0.5 * counts])


def push(points, point, closed):
    """Four-point rule: of A, B, C, D the pair (B, C) is a cycle when both lie within A and D."""
    if points and points[-1] == point:
        return
    if len(points) >= 2 and (points[-2] < points[-1]) == (points[-1] < point):
        points[-1] = point
    else:
        points.append(point)
    while len(points) >= 4:
        a, b, c, d = points[-4:]
        if not (min(a, d) <= min(b, c) and max(b, c) <= max(a, d)):
            return
        closed.append((abs(b - c), min(b, c), 1))
        del points[-3:-1]


def figure_of(value, by_absolute, by_relative, deviation):
    """deviation: of all ranges, (absolute, over the range), or None."""
    return float(value), None if deviation is None else math.hypot(by_absolute * deviation[0], by_relative * deviation[1])


def equivalent_range(cycles, slope, equivalent_cycles, deviation=None):
    """Range that does the same damage in this number of cycles; 0 without cycles. deviation: as for figure_of()."""
    ranges, _, counts = cycles
    largest = ranges.max(initial=0.0)
    if largest == 0.0:
        return 0.0, None if deviation is None else 0.0
    total = (counts * (ranges / largest) ** slope).sum()
    derivative = (counts * (ranges / largest) ** (slope - 1.0)).sum()
    value = largest * (total / equivalent_cycles) ** (1.0 / slope)
    return figure_of(value, value * derivative / (total * largest), value, deviation)


def at_alternating(amplitude, mean, sensitivity):
    """FKM: amplitude at R = -1 that does the same damage, and its derivative by the amplitude."""
    beyond = (1.0 + sensitivity) / (1.0 + sensitivity / 3.0)
    regions = [mean < -amplitude, mean <= amplitude, mean < 3.0 * amplitude]
    slant = numpy.select(regions, [1.0 - sensitivity, 1.0, beyond], beyond * (1.0 + sensitivity))
    by_mean = numpy.select(regions, [0.0, sensitivity, beyond * sensitivity / 3.0], 0.0)
    return slant * amplitude + by_mean * mean, slant


class Curve(namedtuple("Curve", "knee_range knee_cycles slope slope_below sensitivity")):
    """S-N curve of two slopes, with FKM's mean-stress sensitivity or None."""

    def of_each(self, ranges, means):
        """Damage of one cycle of each range and mean, and its derivative by the range."""
        amplitudes, slant = 0.5 * ranges, numpy.ones_like(ranges)
        if self.sensitivity is not None:
            amplitudes, slant = at_alternating(amplitudes, means, self.sensitivity)
        counts = amplitudes > 0.0
        at = 2.0 * numpy.where(counts, amplitudes, 1.0)
        slopes = numpy.where(at >= self.knee_range, self.slope, self.slope_below)
        each = counts * (at / self.knee_range) ** slopes / self.knee_cycles
        return each, each * slopes / at * slant

    def damage(self, cycles, deviation=None):
        """Part of the life that is used. deviation: as for figure_of()."""
        ranges, means, counts = cycles
        each, slope = self.of_each(ranges, means)
        return figure_of((counts * each).sum(), (counts * slope).sum(), (counts * slope * ranges).sum(), deviation)


class Channel:
    """Cycles of a channel over one or more runs of one machine, the time they took, and what they cost."""

    def __init__(self, row, closed, residue):
        """row: sums of IDENTITY, SUMMED, CURVE and the unit; closed: rows (steps, low, count); residue: rows (class,)."""
        self.row, self.name, self.unit = row, row["name"], row["unit"]
        self.hours, self.cycles_per_hour = row["hours"] or 0.0, row["equivalent_cycles_per_hour"]
        self.curve = Curve(*(row[name] for name in CURVE)) if row["sn_knee_range"] is not None else None
        self.count = Count(row["least"], row["greatest"], row["classes"])
        self.count.add_closed(closed)
        self.count.join(level for level, in residue)

    def range_std(self):
        """Standard deviation of all ranges: (absolute, over the range), or None."""
        of_sample, own, common = (self.row[name] for name in MEANS)
        if own is not None and common is not None:
            return 0.0, math.hypot(own, common)
        # The two ends of a range err independently.
        return None if of_sample is None else (math.sqrt(2.0) * of_sample, 0.0)

    @cached_property
    def cycles(self):
        """Cycles of everything that was counted before the first look."""
        return self.count.cycles()

    def equivalents(self):
        """{slope: damage-equivalent range} as figures at SLOPES; (None, None) without any time."""
        equivalent_cycles = self.hours * (self.cycles_per_hour or 0.0)
        if not equivalent_cycles > 0.0:
            return dict.fromkeys(SLOPES, (None, None))
        return {m: equivalent_range(self.cycles, m, equivalent_cycles, self.range_std()) for m in SLOPES}

    def damage(self):
        """Figure, or (None, None) without an S-N curve."""
        return (None, None) if self.curve is None else self.curve.damage(self.cycles, self.range_std())

    def remaining_hours(self):
        """Figure of the hours until the damage is 1 at the rate so far."""
        value, deviation = self.damage()
        if value is None or not self.hours > 0.0:
            return None, None
        if not value > 0.0:
            return math.inf, None
        life = self.hours / value
        return max(0.0, life - self.hours), None if deviation is None else life / value * deviation


def channels_of(database, condition, *values):
    """Counted channels over the runs r that meet the condition: pieces add exactly, in the order of time. Another machine
    or grid is another channel. database: a recording or a merged file."""
    for sums in list(database.rows(CHANNELS.format(condition), *values)):
        same = (*values, *sums[:len(IDENTITY)])
        latest = next(iter(database.rows(LATEST.format(condition), *same)))
        row = dict(zip([*IDENTITY, *SUMMED, "unit", *CURVE], [*sums, *latest]))
        yield Channel(row, database.rows(CYCLES.format(condition), *same), database.rows(RESIDUES.format(condition), *same))
