"""Counts of load cycles on a grid: they add exactly. The same rule as life/four_point.h; doc/fatigue.md, 2."""


class Count:
    """Closed cycles {(steps, low): count} and residue (classes in time order) on a grid of equal classes."""

    def __init__(self, least, greatest, classes):
        self.least, self.greatest, self.classes = least, greatest, classes
        self.closed, self.residue = {}, []

    @property
    def width(self):
        return (self.greatest - self.least) / self.classes

    def grid(self):
        return (self.least, self.greatest, self.classes)

    def add_closed(self, cycles):
        """`cycles`: (steps, low, count)."""
        for steps, low, count in cycles:
            self.closed[steps, low] = self.closed.get((steps, low), 0) + count

    def join(self, residue):
        """The series goes on with what has this residue."""
        joined, closed = joined_residues(self.residue, residue)
        self.residue = joined
        self.add_closed(closed)

    def ranges_and_means(self):
        """(range, mean, count) sorted by range, then mean; the residue as half cycles."""
        halves = {cell: 2 * count for cell, count in self.closed.items()}
        for b, c in zip(self.residue, self.residue[1:]):
            cell = (abs(b - c), min(b, c))
            halves[cell] = halves.get(cell, 0) + 1
        width = self.width
        return [(steps * width, self.least + (low + 0.5 * steps + 0.5) * width, 0.5 * count)
                for (steps, low), count in sorted(halves.items())]


def joined_residues(first, later):
    """(residue, cycles that close across the seam as (steps, low, 1))."""
    points, closed = [], []
    for series in (first, later):
        for point in series:
            push(points, point, closed)
    return points, closed


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
