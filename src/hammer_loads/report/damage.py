"""What counted cycles cost. The same formulas as life/damage.h; doc/fatigue.md, 3.

A figure is (value, standard deviation); the deviation is None where the loads have none. `cycles`: (range, mean, count).
"""
import math

SLOPES = (3.0, 4.0, 5.0, 10.0)


def by_samples(load_deviation):
    """Deviation of all ranges, (absolute, over the range), by that of a sample: a range's two ends err independently."""
    return None if load_deviation is None else (math.sqrt(2.0) * load_deviation, 0.0)


def figure_of(value, by_absolute, by_relative, deviation):
    """deviation: of all ranges, (absolute, over the range), or None."""
    return value, None if deviation is None else math.hypot(by_absolute * deviation[0], by_relative * deviation[1])


def equivalent_range(cycles, slope, equivalent_cycles, deviation=None):
    """Range that does the same damage in this number of cycles; 0 without cycles. deviation: as for figure_of()."""
    largest = max((r for r, _, _ in cycles), default=0.0)
    if largest == 0.0:
        return 0.0, None if deviation is None else 0.0
    total = sum(n * (r / largest) ** slope for r, _, n in cycles)
    derivative = sum(n * (r / largest) ** (slope - 1.0) for r, _, n in cycles)
    value = largest * (total / equivalent_cycles) ** (1.0 / slope)
    return figure_of(value, value * derivative / (total * largest), value, deviation)


def at_alternating(amplitude, mean, sensitivity):
    """FKM: amplitude at R = -1 that does the same damage, and its derivative by the amplitude."""
    beyond = (1.0 + sensitivity) / (1.0 + sensitivity / 3.0)
    if mean < -amplitude:
        return amplitude * (1.0 - sensitivity), 1.0 - sensitivity
    if mean <= amplitude:
        return amplitude + sensitivity * mean, 1.0
    if mean < 3.0 * amplitude:
        return beyond * (amplitude + sensitivity / 3.0 * mean), beyond
    return beyond * (1.0 + sensitivity) * amplitude, beyond * (1.0 + sensitivity)


class Curve:
    """S-N curve of two slopes, with FKM's mean-stress sensitivity or None."""

    def __init__(self, knee_range, knee_cycles, slope, slope_below, sensitivity):
        self.knee_range, self.knee_cycles = knee_range, knee_cycles
        self.slope, self.slope_below, self.sensitivity = slope, slope_below, sensitivity

    def damage(self, cycles, deviation=None):
        """Part of the life that is used. deviation: as for figure_of()."""
        total = by_absolute = by_relative = 0.0
        for r, mean, n in cycles:
            amplitude, slant = 0.5 * r, 1.0
            if self.sensitivity is not None:
                amplitude, slant = at_alternating(amplitude, mean, self.sensitivity)
            if not amplitude > 0.0:
                continue
            at = 2.0 * amplitude
            m = self.slope if at >= self.knee_range else self.slope_below
            each = (at / self.knee_range) ** m / self.knee_cycles
            total += n * each
            by_absolute += n * each * m / at * slant
            by_relative += n * each * m / at * slant * r
        return figure_of(total, by_absolute, by_relative, deviation)


def curve_of(row):
    """From the columns of a `channels` table; None without a curve."""
    if row["sn_knee_range_MPa"] is None:
        return None
    return Curve(row["sn_knee_range_MPa"], row["sn_knee_cycles"], row["sn_slope"], row["sn_slope_below"],
                 row["mean_stress_sensitivity"])


def remaining_hours(damage, hours):
    """Until the damage is 1 at the rate so far."""
    value, deviation = damage
    if not value > 0.0:
        return math.inf, None
    life = hours / value
    return max(0.0, life - hours), None if deviation is None else life / value * deviation
