"""Damage of counted cycles by the formulas of life/damage.h; doc/fatigue.md, 3.

A figure is (value, standard deviation); the deviation is None where the loads have none. `cycles`: (range, mean, count).
"""
import math

import numpy

SLOPES = (3.0, 4.0, 5.0, 10.0)


def columns_of(cycles):
    """Ranges, means and counts as arrays."""
    return numpy.array(cycles, dtype=float).reshape(-1, 3).T


def by_samples(load_std):
    """Deviation of all ranges, (absolute, over the range), by that of a sample: a range's two ends err independently."""
    return None if load_std is None else (math.sqrt(2.0) * load_std, 0.0)


def figure_of(value, by_absolute, by_relative, deviation):
    """deviation: of all ranges, (absolute, over the range), or None."""
    return float(value), None if deviation is None else math.hypot(by_absolute * deviation[0], by_relative * deviation[1])


def equivalent_range(cycles, slope, equivalent_cycles, deviation=None):
    """Range that does the same damage in this number of cycles; 0 without cycles. deviation: as for figure_of()."""
    ranges, _, counts = columns_of(cycles)
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
        ranges, means, counts = columns_of(cycles)
        each, slope = self.of_each(ranges, means)
        return figure_of((counts * each).sum(), (counts * slope).sum(), (counts * slope * ranges).sum(), deviation)


def curve_of(row):
    """Curve by the columns of a table `channels`; None where they have none."""
    if row["sn_knee_range"] is None:
        return None
    return Curve(row["sn_knee_range"], row["sn_knee_cycles"], row["sn_slope"], row["sn_slope_below"],
                 row["mean_stress_sensitivity"])


def remaining_hours(damage, hours):
    """Until the damage is 1 at the rate so far."""
    value, deviation = damage
    if not value > 0.0:
        return math.inf, None
    life = hours / value
    return max(0.0, life - hours), None if deviation is None else life / value * deviation
