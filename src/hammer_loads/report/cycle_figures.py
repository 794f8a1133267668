"""Load cycles: range-mean matrix, damage-equivalent loads, damage."""
import math

from matplotlib.ticker import FuncFormatter
import numpy

from report.damage import SLOPES
from report.formats import Table, in_unit, number, scaled
from report.names import in_words
from report.pictures import COLOURS, Picture

CELLS = 24  # of a matrix, each way
SHARED = (3.0, 5.0, 10.0)  # slopes of the shares of the damage by range


def with_std(figure, factor=1.0):
    value, deviation = figure
    shown = number(scaled(value, factor))
    return shown if deviation is None or value is None else f"{shown} \u00b1 {number(scaled(deviation, factor), 2)}"


def equivalents_table(channels):
    """Equivalent ranges and damage, for recordings and ledgers."""
    rows = []
    for channel in channels:
        cycles = channel.count.ranges_and_means()
        factor, unit = in_unit(channel.unit)
        damage = channel.damage(cycles)
        rows.append([in_words(channel.name), unit, *(with_std(f, factor) for f in channel.equivalents(cycles)),
                     scaled(cycles[-1][0] if cycles else 0.0, factor), number(sum(n for _, _, n in cycles), 6),
                     with_std(damage), with_std(channel.remaining_hours(damage)),
                     f"{channel.below + channel.above}, {channel.skipped}, {channel.gaps}"])
    header = ["Channel", "Unit", *(f"Range, slope\u00a0{m:g}" for m in SLOPES), "Largest range", "Cycles", "Damage",
              "Hours left", "Saturated, skipped, gaps"]
    return Table("Damage-equivalent loads", header, rows)


def of_whole_classes(extent, width):
    """Size of a cell so that CELLS of them cover the extent, a multiple of a class: each holds as many classes."""
    return max(1, math.ceil(extent * (1 - 1e-9) / (CELLS * width))) * width


def matrix_picture(ranges, means, counts, width, unit, title):
    """Half cycles count half; the strength of the colour is logarithmic."""
    low = means.min() - 0.25 * width
    mean_size = of_whole_classes(means.max() + 0.25 * width - low, 0.5 * width)
    range_size = of_whole_classes(ranges.max() + 0.5 * width, width)
    cells = {}
    for mean, reach, n in zip(((means - low) / mean_size).astype(int), (ranges / range_size).astype(int), counts):
        key = (min(CELLS - 1, mean), min(CELLS - 1, reach))
        cells[key] = cells.get(key, 0.0) + n
    picture = Picture(f"mean [{unit}]", f"range [{unit}]")
    most = math.log(1.0 + max(cells.values()))
    picture.boxes([(low + i * mean_size, low + (i + 1) * mean_size, j * range_size, (j + 1) * range_size) for i, j in cells],
                  "first", [0.12 + 0.88 * math.log(1.0 + n) / most for n in cells.values()])
    picture.axes.set_ylim(bottom=0.0)
    return picture.figure(f"{title}: cycles by range and mean; the stronger the colour, the more (logarithmic)")


def by_range(ranges, counts, width):
    """Edges of stretches of range; in each the cycles, and the shares of the damage at SHARED."""
    size = of_whole_classes(ranges.max() + 0.5 * width, width)
    edges = numpy.arange(2 + int(ranges.max() / size)) * size
    place = (ranges / size).astype(int)
    tallies = [numpy.bincount(place, counts * (ranges / ranges.max()) ** slope, len(edges) - 1) for slope in (0.0, *SHARED)]
    return edges, tallies[0], [tally / tally.sum() for tally in tallies[1:]]


def histogram_picture(edges, counts, share, unit, title):
    picture = Picture(f"range [{unit}]", "cycles, logarithmic")
    picture.axes.bar(edges[:-1], counts, numpy.diff(edges), align="edge", color=COLOURS["first"], alpha=0.75)
    picture.axes.set_yscale("symlog", linthresh=1.0)
    picture.axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    picture.axes.set_ylim(0.0, 2.0 * counts.max())
    picture.line(0.5 * (edges[:-1] + edges[1:]), 0.97 * share / share.max(), "second",
                 transform=picture.axes.get_xaxis_transform())  # y: part of the height
    return picture.figure(f"{title}: cycles by range", [
        ("box first", "cycles"), ("line second", "share of the damage at slope 5, its largest at the top")])


def channel_pictures(channel):
    """Pictures and their table; None for a channel without cycles."""
    cycles = channel.count.ranges_and_means()
    if not cycles:
        return None
    factor, unit = in_unit(channel.unit)
    title, width = in_words(channel.name), channel.count.width * factor
    ranges, means, counts = numpy.array(cycles).T * [[factor], [factor], [1.0]]
    edges, tally, shares = by_range(ranges, counts, width)
    rows = [[f"{number(low)} to {number(high)}", number(n, 6), *(number(100 * s, 3) for s in of_slopes)]
            for low, high, n, *of_slopes in zip(edges, edges[1:], tally, *shares) if n > 0.0]
    header = [f"Range [{unit}]", "Cycles", "Damage at slope 3 [%]", "at slope 5 [%]", "at slope 10 [%]"]
    return {"pictures": [matrix_picture(ranges, means, counts, width, unit, title),
                         histogram_picture(edges, tally, shares[SHARED.index(5.0)], unit, title)],
            "name": title, "table": Table("Cycles by range", header, rows)}


def cycle_figures(channels):
    """Table and pictures; those of the force along the tool come first."""
    ordered = sorted(channels, key=lambda c: not c.name.endswith("force_z"))
    drawn = list(filter(None, map(channel_pictures, ordered)))
    return {"table": equivalents_table(channels), "open": drawn[:1], "folded": drawn[1:],
            "per_hour": next((c.cycles_per_hour for c in channels if c.cycles_per_hour), None)}
