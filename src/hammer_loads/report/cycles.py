"""Counted channels: load cycles on a grid, by the rule of life/four_point.h (doc/fatigue.md, 2), and what they cost, by the
formulas of life/damage.h (doc/fatigue.md, 3).

Cycles are an array of three rows: range, mean, count. A figure is (value, standard deviation); the deviation is None where
the loads have none.
"""
from functools import cached_property
import math

import numpy

SLOPES = (3.0, 4.0, 5.0, 10.0)
SUMS = ("samples", "skipped", "below", "above", "gaps")
CURVE = ("sn_knee_range", "sn_knee_cycles", "sn_slope", "sn_slope_below", "mean_stress_sensitivity")
# Standard deviations: of a sample; over the range: of a single revolution, and of constants, which does not average out.
MEANS = ("mean_std", "range_own_std", "range_systematic_std")


class Count:
    """Closed cycles {(steps, low): count} and residue (classes in time order) on a grid of equal classes: they add exactly."""

    def __init__(self, least, greatest, classes):
        self.grid = (least, greatest, classes)
        self.closed, self.residue = {}, []

    @property
    def width(self):
        least, greatest, classes = self.grid
        return (greatest - least) / classes

    def add_closed(self, cycles):
        """cycles: (steps, low, count)."""
        for steps, low, count in cycles:
            self.closed[steps, low] = self.closed.get((steps, low), 0) + count

    def join(self, residue):
        """The series goes on with what has this residue. Returns the cycles that close across the seam, which are added."""
        across = []
        for point in residue:
            push(self.residue, point, across)
        self.add_closed(across)
        return across

    def cycles(self):
        """Cycles sorted by range, then mean; the residue as half cycles."""
        halves = {cell: 2 * count for cell, count in self.closed.items()}
        for b, c in zip(self.residue, self.residue[1:]):
            cell = (abs(b - c), min(b, c))
            halves[cell] = halves.get(cell, 0) + 1
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


class Curve:
    """S-N curve of two slopes, with FKM's mean-stress sensitivity or None."""

    def __init__(self, knee_range, knee_cycles, slope, slope_below, sensitivity):
        self.knee_range, self.knee_cycles = knee_range, knee_cycles
        self.slope, self.slope_below, self.sensitivity = slope, slope_below, sensitivity

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

    def __init__(self, row, cycles_per_hour):
        """row: of a table of channels."""
        self.name, self.unit, self.cycles_per_hour = row["name"], row["unit"], cycles_per_hour
        self.count = Count(row["least"], row["greatest"], row["classes"])
        self.curve = Curve(*(row[name] for name in CURVE)) if row["sn_knee_range"] is not None else None
        self.hours, self.sums = 0.0, dict.fromkeys(SUMS, 0)
        self._weighted = dict.fromkeys(MEANS, (0.0, 0))  # by the samples, and their number

    def add(self, row, hours):
        """Adds what a row has of SUMS and MEANS."""
        self.hours += hours
        for name in SUMS:
            self.sums[name] += row[name] or 0
        for name in MEANS:
            if row.get(name) is not None and row["samples"]:
                total, weight = self._weighted[name]
                self._weighted[name] = (total + row["samples"] * row[name], weight + row["samples"])

    def join(self, later):
        """Adds a later piece on the same grid."""
        self.add({**later.sums, **{name: later.mean(name) for name in MEANS}}, later.hours)
        self.count.add_closed((*cell, count) for cell, count in later.count.closed.items())
        self.count.join(later.count.residue)

    def mean(self, name):
        """Mean of one of MEANS over what was added; None where there is none."""
        total, weight = self._weighted[name]
        return total / weight if weight else None

    def range_std(self):
        """Standard deviation of all ranges: (absolute, over the range), or None."""
        own, common, of_sample = (self.mean(name) for name in ("range_own_std", "range_systematic_std", "mean_std"))
        if own is not None and common is not None:
            return 0.0, math.hypot(own, common)
        # The two ends of a range err independently.
        return None if of_sample is None else (math.sqrt(2.0) * of_sample, 0.0)

    @cached_property
    def cycles(self):
        """Cycles of everything that was added before the first look."""
        return self.count.cycles()

    def equivalents(self):
        """Damage-equivalent ranges as figures at SLOPES; (None, None) without any time."""
        if not (self.hours > 0.0 and self.cycles_per_hour and self.cycles_per_hour > 0.0):
            return [(None, None)] * len(SLOPES)
        return [equivalent_range(self.cycles, m, self.hours * self.cycles_per_hour, self.range_std()) for m in SLOPES]

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
