"""Numbers over time: statistics of all, and few enough to draw, with least and greatest kept."""
import math

PAUSE_TURNS = 4.0  # times the usual step: there was no work between two points
PAUSE_S = 2.0      # at least: a slow turn is no pause


class Segments:
    """Values of several runs: each a list of (time_s since the first stamp, least, middle, greatest)."""

    def __init__(self):
        self.runs = []
        self.of_runs = False  # a point is a run, its middle the mean of its turns
        self.deviation = None  # of the measurement of a value, median; None: not known

    def begin_run(self):
        self.runs.append([])

    def add(self, time_s, value):
        self.runs[-1].append((time_s, value, value, value))

    def add_band(self, time_s, least, middle, greatest):
        self.runs[-1].append((time_s, least, middle, greatest))

    def __len__(self):
        return sum(len(run) for run in self.runs)

    def middles(self):
        return [point[2] for run in self.runs for point in run]

    def statistics(self):
        """Least, 5 %, median, 95 %, greatest; of runs the parts between are those of their means."""
        ordered = sorted(self.middles())
        points = [point for run in self.runs for point in run]
        return ([min((p[1] for p in points), default=None)] + [quantile(ordered, part) for part in (0.05, 0.5, 0.95)] +
                [max((p[3] for p in points), default=None)])

    def spread(self):
        """Half of what holds the middle 68 %: a standard deviation that a few odd values do not change."""
        ordered = sorted(self.middles())
        if len(ordered) < 3 or self.of_runs:
            return None
        return 0.5 * (quantile(ordered, 0.8413) - quantile(ordered, 0.1587))

    def stretches(self):
        """Points of uninterrupted work: a run, cut where nothing was struck for long. Of runs each stands alone."""
        for run in self.runs:
            if self.of_runs:
                yield from ([point] for point in run)
            else:
                yield from cut_at_pauses(run)

    def thinned(self, most):
        """At most some `most` points; neighbours become one with least, mean and greatest. None where work paused."""
        together = max(1, math.ceil(len(self) / most))
        points = []
        for stretch in self.stretches():
            if points:
                points.append(None)
            points += [merged(stretch[at:at + together]) for at in range(0, len(stretch), together)]
        return points

    def on_grid(self, step_s, count):
        """Mean over each interval of time, with least and greatest; None where there is nothing."""
        cells = [[] for _ in range(count)]
        for run in self.runs:
            for point in run:
                cells[min(count - 1, max(0, int(point[0] / step_s)))].append(point)
        return [merged(cell) if cell else None for cell in cells]


def cut_at_pauses(run):
    steps = sorted(b[0] - a[0] for a, b in zip(run, run[1:]))
    pause = max(PAUSE_S, PAUSE_TURNS * (quantile(steps, 0.5) or 0.0))
    begin = 0
    for at in range(1, len(run)):
        if run[at][0] - run[at - 1][0] > pause:
            yield run[begin:at]
            begin = at
    if run:
        yield run[begin:]


def merged(points):
    return (points[0][0], min(p[1] for p in points), sum(p[2] for p in points) / len(points),
            max(p[3] for p in points))


def quantile(ordered, part):
    """Of values in rising order; None of none."""
    if not ordered:
        return None
    at = part * (len(ordered) - 1)
    low = int(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])
