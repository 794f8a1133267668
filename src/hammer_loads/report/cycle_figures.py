"""Load cycles: range-mean matrix, damage-equivalent loads, damage."""
import math

from report.damage import SLOPES
from report.markup import Raw, details, in_unit, number, paragraph, scaled, table
from report.names import without_unit
from report.svg import Axes, figure

CELLS = 24  # of a matrix, each way


def with_deviation(figure_, factor=1.0):
    value, deviation = figure_
    shown = number(scaled(value, factor))
    return shown if deviation is None or value is None else f"{shown} \u00b1 {number(scaled(deviation, factor), 2)}"


def equivalents_table(channels):
    """Also for ledgers."""
    rows = []
    for channel in channels:
        cycles = channel.count.ranges_and_means()
        factor, unit = in_unit(channel.unit)
        damage = channel.damage(cycles)
        rows.append([without_unit(channel.name), unit] + [with_deviation(f, factor) for f in channel.equivalents(cycles)] +
                    [number(scaled(cycles[-1][0] if cycles else 0.0, factor)), number(sum(n for _, _, n in cycles), 6),
                     with_deviation(damage), with_deviation(channel.remaining_hours(damage)),
                     f"{channel.below + channel.above}, {channel.skipped}, {channel.gaps}"])
    header = (["Channel", "Unit"] + [f"Range, slope\u00a0{m:g}" for m in SLOPES] +
              ["Largest range", "Cycles", "Damage", "Hours left", "Saturated, skipped, gaps"])
    return table("Damage-equivalent loads", header, rows)


def of_whole_classes(extent, width):
    """Size of a cell so that CELLS of them cover the extent, a multiple of a class: each holds as many classes."""
    return max(1, math.ceil(extent * (1 - 1e-9) / (CELLS * width))) * width


def matrix(cycles, width):
    """{(mean's cell, range's cell): count}, least mean, size of a mean's cell, size of a range's cell."""
    low = min(m for _, m, _ in cycles) - 0.25 * width
    mean_size = of_whole_classes(max(m for _, m, _ in cycles) + 0.25 * width - low, 0.5 * width)
    range_size = of_whole_classes(cycles[-1][0] + 0.5 * width, width)
    cells = {}
    for r, mean, n in cycles:
        key = (min(CELLS - 1, int((mean - low) / mean_size)), min(CELLS - 1, int(r / range_size)))
        cells[key] = cells.get(key, 0.0) + n
    return cells, low, mean_size, range_size


def matrix_picture(cycles, width, unit, title):
    cells, low, mean_width, range_width = matrix(cycles, width)
    across = 1 + max(i for i, _ in cells)
    up = 1 + max(j for _, j in cells)
    axes = Axes((low, low + across * mean_width), (0.0, up * range_width), f"mean [{unit}]", f"range [{unit}]")
    most = math.log(1.0 + max(cells.values()))
    for (i, j), n in sorted(cells.items()):
        axes.box(low + i * mean_width, low + (i + 1) * mean_width, j * range_width, (j + 1) * range_width, "heat",
                 0.12 + 0.88 * math.log(1.0 + n) / most,
                 f"{number(n)} cycles, range {number(j * range_width)} to {number((j + 1) * range_width)}")
    return axes.drawn(title)


def by_range(cycles, width):
    """(from, to, cycles, share of the damage at slopes 3, 5, 10) of each stretch of range."""
    size = of_whole_classes(cycles[-1][0] + 0.5 * width, width)
    count = 1 + int(cycles[-1][0] / size)
    rows = [[j * size, (j + 1) * size, 0.0, 0.0, 0.0, 0.0] for j in range(count)]
    for r, _, n in cycles:
        row = rows[min(count - 1, int(r / size))]
        row[2] += n
        for at, slope in ((3, 3.0), (4, 5.0), (5, 10.0)):
            row[at] += n * (r / cycles[-1][0]) ** slope
    for at in (3, 4, 5):
        total = sum(row[at] for row in rows)
        for row in rows:
            row[at] /= total
    return rows


def histogram_picture(rows, unit, title):
    """Cycles by range on a logarithmic scale, with the share of the damage at slope 5."""
    most = max(math.log10(1.0 + row[2]) for row in rows) * 1.05
    labels = [(math.log10(1.0 + 10 ** p), f"{10 ** p:g}") for p in range(int(most) + 1)]
    axes = Axes((0.0, rows[-1][1]), (0.0, most), f"range [{unit}]", "cycles, logarithmic", y_labels=labels)
    for low, high, n, *_ in rows:
        if n > 0.0:
            axes.box(low, high, 0.0, math.log10(1.0 + n), "bar", title=f"{number(n)} cycles")
    share = max(row[4] for row in rows)
    axes.line([(0.5 * (row[0] + row[1]), row[4] / share * most * 0.97) for row in rows], "second")
    return axes.drawn(title)


def channel_pictures(channel):
    cycles = channel.count.ranges_and_means()
    factor, unit = in_unit(channel.unit)
    name = without_unit(channel.name)
    cycles = [(r * factor, m * factor, n) for r, m, n in cycles]
    if not cycles:
        return paragraph(f"{name}: no cycle.")
    width = channel.count.width * factor
    rows = by_range(cycles, width)
    pictures = figure(matrix_picture(cycles, width, unit, f"{name}: cycles by range and mean"),
                      f"{name}: cycles by range and mean; the stronger the colour, the more (logarithmic)")
    pictures += figure(histogram_picture(rows, unit, f"{name}: cycles by range"),
                       f"{name}: cycles by range",
                       [("bar", "cycles"), ("line second", "share of the damage at slope 5, its largest at the top")])
    shown = [[f"{number(low)} to {number(high)}", number(n, 6)] + [number(100 * s, 3) for s in shares]
             for low, high, n, *shares in rows if n > 0.0]
    header = [f"Range [{unit}]", "Cycles", "Damage at slope 3 [%]", "at slope 5 [%]", "at slope 10 [%]"]
    return f'<div class="pair">{pictures}</div>\n' + details(f"{name} by range as a table",
                                                           table("Cycles by range", header, shown))


def explanation(channels):
    rate = next((c.cycles_per_hour for c in channels if c.cycles_per_hour), None)
    return paragraph(
        f"Ranges that, {number(rate)} times an hour, do the damage of all cycles on a material of this slope "
        "(3: welded steel, 5: below its knee, 10: composites). Cycles of ASTM E1049, the residue as half cycles. "
        "Deviations: of the loads, all ranges erring alike.", "note")


def cycle_figures(channels):
    if not channels:
        return paragraph("No channel was counted.")
    main = next((c for c in channels if c.name.endswith("force_z_N")), channels[0])
    others = [c for c in channels if c is not main]
    rest = "".join(channel_pictures(channel) for channel in others)
    return Raw(explanation(channels) + equivalents_table(channels) + channel_pictures(main) +
               (details(f"Pictures of {len(others)} more channels", rest) if others else ""))
