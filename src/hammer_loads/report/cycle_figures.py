"""Load cycles: range-mean matrix, damage-equivalent loads, damage."""
import math

from matplotlib.ticker import FuncFormatter
import numpy

from report.blocks import Details, Note, Table
from report.cycles import SLOPES
from report.formats import in_unit, in_words, measured, number
from report.pictures import Picture

CELLS = 24  # of a matrix, each way
SHARED = (3.0, 5.0, 10.0)  # slopes of the shares of the damage by range


def equivalents_table(channels):
    """Equivalent ranges and damage, for recordings and ledgers."""
    rows = []
    for channel in channels:
        factor, unit = in_unit(channel.unit)
        ranges, _, counts = channel.cycles
        below, above, skipped, gaps = (channel.row[name] or 0 for name in ("below", "above", "skipped", "gaps"))
        rows.append([in_words(channel.name), unit, *(measured(*figure, factor) for figure in channel.equivalents().values()),
                     ranges.max(initial=0.0) * factor, number(counts.sum(), 6), measured(*channel.damage()),
                     measured(*channel.remaining_hours()), f"{below + above}, {skipped}, {gaps}"])
    header = ["Channel", "Unit", *(f"Range, slope\u00a0{m:g}" for m in SLOPES), "Largest range", "Cycles", "Damage",
              "Hours left", "Saturated, skipped, gaps"]
    return Table("Damage-equivalent loads", header, rows)


def edges_of(low, high, width):
    """Edges of at most CELLS cells of a multiple of the width: each holds as many classes. Ranges lie on edges of classes; a
    quarter of the width more keeps them clear of rounding."""
    size = max(1, math.ceil((high - low) * (1 - 1e-9) / (CELLS * width))) * width
    return low + size * numpy.arange(math.ceil((high - low) * (1 - 1e-9) / size) + 1)


def matrix_picture(ranges, means, counts, width, unit, title):
    """Half cycles count half; the strength of the colour is logarithmic."""
    mean_edges = edges_of(means.min() - 0.25 * width, means.max() + 0.25 * width, 0.5 * width)
    range_edges = edges_of(0.0, ranges.max() + 0.5 * width, width)
    cells = numpy.histogram2d(means, ranges + 0.25 * width, [mean_edges, range_edges], weights=counts)[0]
    picture = Picture(f"mean [{unit}]", f"range [{unit}]")
    boxes = [(mean_edges[i], mean_edges[i + 1], range_edges[j], range_edges[j + 1]) for i, j in numpy.argwhere(cells > 0.0)]
    picture.boxes(boxes, "first", 0.12 + 0.88 * numpy.log1p(cells[cells > 0.0]) / math.log1p(cells.max()))
    picture.axes.set_ylim(bottom=0.0)
    return picture.figure(f"{title}: cycles by range and mean; the stronger the colour, the more (logarithmic)")


def histogram_picture(edges, counts, share, unit, title):
    picture = Picture(f"range [{unit}]", "cycles, logarithmic")
    picture.bars(edges, counts)
    picture.axes.set_yscale("symlog", linthresh=1.0)
    picture.axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    picture.axes.set_ylim(0.0, 2.0 * counts.max())
    picture.line(0.5 * (edges[:-1] + edges[1:]), 0.97 * share / share.max(), "second",
                 transform=picture.axes.get_xaxis_transform())  # y: part of the height
    return picture.figure(f"{title}: cycles by range", [
        ("box first", "cycles"), ("line second", "share of the damage at slope 5, its largest at the top")])


def channel_pictures(channel):
    """Pictures and their table; nothing for a channel without cycles."""
    if not channel.cycles.size:
        return []
    factor, unit = in_unit(channel.unit)
    title, width = in_words(channel.name), channel.count.width * factor
    ranges, means, counts = channel.cycles * [[factor], [factor], [1.0]]
    edges = edges_of(0.0, ranges.max() + 0.5 * width, width)
    tally, *damages = (numpy.histogram(ranges + 0.25 * width, edges, weights=counts * (ranges / ranges.max()) ** slope)[0]
                       for slope in (0.0, *SHARED))
    shares = [damage / damage.sum() for damage in damages]
    rows = [[f"{number(low)} to {number(high)}", number(n, 6), *(number(100 * s, 3) for s in of_slopes)]
            for low, high, n, *of_slopes in zip(edges, edges[1:], tally, *shares) if n > 0.0]
    header = [f"Range [{unit}]", "Cycles", "Damage at slope 3 [%]", "at slope 5 [%]", "at slope 10 [%]"]
    return [[matrix_picture(ranges, means, counts, width, unit, title),
             histogram_picture(edges, tally, shares[SHARED.index(5.0)], unit, title)],
            Details(f"{title} by range as a table", [Table("Cycles by range", header, rows)])]


def cycle_figures(channels):
    """Table and pictures; those of the force along the tool come first."""
    if not channels:
        return ["No channel was counted."]
    per_hour = next((c.cycles_per_hour for c in channels if c.cycles_per_hour), None)
    ordered = sorted(channels, key=lambda channel: not channel.name.endswith("force_z"))
    first, *more = list(filter(None, map(channel_pictures, ordered))) or [[]]
    return [Note(f"A damage-equivalent range, repeated {number(per_hour)} times an hour, does the damage of all cycles on a "
                 "material of this slope (3: welded steel, 5: below its knee, 10: composites). Cycles are those of ASTM E1049, "
                 "the residue as half cycles. Deviations are those of the loads, all ranges erring alike."),
            equivalents_table(channels), *first,
            Details(f"Pictures of {len(more)} more channels", sum(more, [])) if more else None]
