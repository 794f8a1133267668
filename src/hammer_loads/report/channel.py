"""A counted channel: its load cycles, the time they took, and what they cost."""
import math

from report.damage import SLOPES, by_samples, curve_of, equivalent_range, remaining_hours
from report.rainflow import Count

TALLY = ("samples", "skipped", "below", "above", "gaps")


class Channel:
    """Over one or more runs of one machine; a piece is added with add()."""

    def __init__(self, name, unit, grid, curve, cycles_per_hour):
        self.name, self.unit, self.curve, self.cycles_per_hour = name, unit, curve, cycles_per_hour
        self.count = Count(*grid)
        self.hours = 0.0
        self.samples = self.skipped = self.below = self.above = self.gaps = 0
        self.minimum = self.maximum = None
        self._std_sum, self._deviations = 0.0, 0
        self._range_sums, self._range_weight = [0.0, 0.0], 0

    @classmethod
    def of(cls, row, cycles_per_hour):
        """From a row of a table `channels`."""
        grid = (row["least"], row["greatest"], row["classes"])
        return cls(row["name"], row["unit"], grid, curve_of(row), cycles_per_hour)

    def add_tally(self, row):
        for name in TALLY:
            setattr(self, name, getattr(self, name) + (row[name] or 0))
        if row["minimum"] is not None:
            self.minimum = row["minimum"] if self.minimum is None else min(self.minimum, row["minimum"])
            self.maximum = row["maximum"] if self.maximum is None else max(self.maximum, row["maximum"])

    def add_sums(self, row):
        """Tally and deviations of a row of a table of channels; those of older files have no deviations of ranges."""
        self.add_tally(row)
        self.add_std(row["mean_std"], row["samples"])
        self.add_range_deviations(row.get("range_own_std"), row.get("range_systematic_std"), row["samples"])

    def add_std(self, mean, samples):
        if mean is not None and samples:
            self._std_sum += mean * samples
            self._deviations += samples

    def add_range_deviations(self, own, common, weight):
        """Adds relative standard deviations of the ranges: of single revolutions, and of constants, which do not average out."""
        if own is not None and common is not None and weight:
            self._range_sums = [before + weight * part for before, part in zip(self._range_sums, (own, common))]
            self._range_weight += weight

    @property
    def range_deviations(self):
        """(own, common), mean over what was added; None each where there is none."""
        return tuple(part / self._range_weight if self._range_weight else None for part in self._range_sums)

    def _range_std(self):
        own, common = self.range_deviations
        return by_samples(self.deviation) if own is None else (0.0, math.hypot(own, common))

    @property
    def deviation(self):
        """Mean standard deviation of a sample; None where there is none."""
        return self._std_sum / self._deviations if self._deviations else None

    def equivalents(self, cycles=None):
        """Damage-equivalent ranges as (value, deviation) at SLOPES; (None, None) without any time."""
        if not (self.hours > 0.0 and self.cycles_per_hour and self.cycles_per_hour > 0.0):
            return [(None, None)] * len(SLOPES)
        cycles = self.count.ranges_and_means() if cycles is None else cycles
        deviation = self._range_std()
        return [equivalent_range(cycles, m, self.hours * self.cycles_per_hour, deviation) for m in SLOPES]

    def damage(self, cycles=None):
        """(value, deviation), or (None, None) without an S-N curve."""
        if self.curve is None:
            return None, None
        cycles = self.count.ranges_and_means() if cycles is None else cycles
        return self.curve.damage(cycles, self._range_std())

    def remaining_hours(self, damage):
        return remaining_hours(damage, self.hours) if damage[0] is not None and self.hours > 0.0 else (None, None)
