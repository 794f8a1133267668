"""How often which energy and which peak: bars over the values of all blows."""
import math

from report.markup import Raw, details, number, table
from report.svg import Axes, figure, ticks

SHOWN = ("energy_J", "amplitude_N")
MOST_BARS = 24


def bins(values):
    """(width, {index: count}) with round edges at multiples of the width; a single value is one bar."""
    low, high = min(values), max(values)
    edges = ticks(low, high, MOST_BARS) if high > low else []
    width = edges[1] - edges[0] if len(edges) > 1 else (abs(low) * 0.01 or 1.0)
    counts = {}
    for value in values:
        at = math.floor(value / width + 1e-9)
        counts[at] = counts.get(at, 0) + 1
    return width, counts


def picture(title, unit, values):
    width, counts = bins(values)
    low, high = min(counts), max(counts) + 1
    most = max(counts.values())
    axes = Axes((low * width, high * width), (0.0, 1.05 * most), f"{title.lower()} [{unit}]", "blows")
    for at, count in sorted(counts.items()):
        axes.box(at * width, (at + 1) * width, 0.0, count, "bar",
                 title=f"{count} blows, {number(at * width)} to {number((at + 1) * width)} {unit}")
    rows = [[f"{number(at * width)} to {number((at + 1) * width)}", count, number(100.0 * count / len(values), 3)]
            for at, count in sorted(counts.items())]
    return (figure(axes.drawn(f"Blows by {title.lower()}"), f"{title} of {number(len(values))} blows"),
            details(f"Blows by {title.lower()} as a table",
                    table(f"Blows by {title.lower()}", [f"{title} [{unit}]", "Blows", "Share [%]"], rows)))


def histograms(segments, quantities):
    """Of values of turns: where the file has figures of runs alone there is nothing to count."""
    pictures, tables = "", ""
    for quantity in quantities:
        values = segments[quantity.key]
        if quantity.key in SHOWN and len(values) and not values.of_runs:
            drawn, as_table = picture(quantity.title, quantity.unit, values.middles())
            pictures += drawn
            tables += as_table
    return Raw(f'<div class="pair">{pictures}</div>\n{tables}' if pictures else "")
