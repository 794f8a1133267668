"""Values over the time of work: statistics of all, and few enough to draw, with least and greatest kept."""
import numpy
import pandas

from report.quantities import value_of

PAUSE_TURNS = 4.0  # times the usual step: there was no work between two points
PAUSE_S = 2.0      # at least: a slow turn is no pause
BAND = ["least", "middle", "greatest"]


class Series:
    """points: `run` (its place among the machine's), `x` (time of work [s]) and BAND; a value alone is all three."""

    def __init__(self, points, deviation=None, of_runs=False):
        self.points = points
        self.deviation = deviation  # of the measurement of a value, median; None: not known
        self.of_runs = of_runs      # a point is a run, its middle the mean of its turns

    def __len__(self):
        return len(self.points)

    def statistics(self):
        """Least, 5 %, median, 95 %, greatest; of runs the parts between are those of their means."""
        points = self.points
        return [points.least.min(), *points.middle.quantile([0.05, 0.5, 0.95]), points.greatest.max()]

    def spread(self):
        """Half of what holds the middle 68 %: a standard deviation that a few odd values do not change."""
        if len(self) < 3 or self.of_runs:
            return None
        low, high = self.points.middle.quantile([0.1587, 0.8413])
        return 0.5 * (high - low)

    def of_run(self, run):
        return Series(self.points[self.points.run == run], self.deviation, self.of_runs)

    def _begins(self, together):
        """Marks of the values at which stretches of uninterrupted work begin; so many values of runs stand alone."""
        if self.of_runs:
            return pandas.Series(numpy.arange(len(self)) % together == 0)
        steps = self.points.groupby("run").x.diff()
        usual = steps.groupby(self.points.run).transform("median").fillna(0.0)
        return steps.isna() | (steps > numpy.maximum(PAUSE_S, PAUSE_TURNS * usual))

    def thinned(self, most):
        """At most some `most` points; neighbours become one with least, mean and greatest. No number where work paused."""
        if not len(self):
            return self.points
        together = -(-len(self) // most)
        stretch = self._begins(together).cumsum().to_numpy()
        is_first = self.points.groupby(stretch).cumcount() % together == 0
        place = is_first.cumsum().to_numpy() + stretch  # a pause takes a place of its own
        merged = self.points.groupby(place).agg({"x": "first", "least": "min", "middle": "mean", "greatest": "max"})
        return merged.reindex(range(place[0], place[-1] + 1))


def time_of_work(subject, rows):
    """[s] of rows with `run` and `stamp_ns`: runs follow each other without the time between them."""
    spans = pandas.DataFrame([(run["first_stamp_ns"] or 0, run["last_stamp_ns"] or 0) for run in subject.runs],
                             columns=["first", "last"], dtype=float)
    lasted = (spans["last"] - spans["first"]).clip(lower=0.0)
    since = lasted.cumsum() - lasted - spans["first"]
    return (rows.stamp_ns + rows.run.map(since)) * 1e-9


def series_of(subject, quantity):
    """Values of turns in the unit shown, or of runs where the file has no rows of turns."""
    of_runs = not subject.has_rows(quantity.table)
    if of_runs:
        rows = subject.frame("(first_stamp_ns + last_stamp_ns) / 2 AS stamp_ns, least, mean AS middle, greatest, "
                             "NULL AS deviation FROM run_figures JOIN runs USING(run_id) WHERE {runs} AND quantity = ?",
                             quantity.key)
    else:
        value = value_of(quantity)
        rows = subject.frame(f"stamp_ns, {value} AS least, {value} AS middle, {value} AS greatest, "
                             f"{quantity.deviation or 'NULL'} AS deviation FROM {quantity.table} WHERE {{runs}} ORDER BY turn")
    rows = rows.dropna(subset=["stamp_ns", "middle"])
    points = pandas.DataFrame({"run": rows.run, "x": time_of_work(subject, rows), **(rows[BAND] * quantity.factor)})
    known = rows.deviation.dropna() * quantity.factor
    return Series(points.reset_index(drop=True), known.median() if len(known) else None, of_runs)
