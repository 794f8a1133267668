"""Blow rate, energy, restitution, peak force and hold-down over the time of work, and how often which value came."""
from matplotlib.ticker import MaxNLocator
import numpy
import pandas

from report.blocks import CURVES, Details, Note, Table, as_tables
from report.formats import number, titled
from report.pictures import COLOURS, Picture
from report.quantities import QUANTITIES

MOST_POINTS = 400
COUNTED = ("energy", "amplitude")  # in a histogram
MOST_BARS = 24
MOST_WIDTHS = 3.0  # from the median: three standard deviations to either side are 1.5
STRETCHES = 12
MOST_MARKS = 20
TIME_UNITS = [(86400.0, "days"), (3600.0, "h"), (60.0, "min"), (1.0, "s")]


def time_unit(longest_s):
    return next(unit for unit in TIME_UNITS if longest_s >= 3.0 * unit[0] or unit[0] == 1.0)


def curves_picture(caption, y_title, curves, most, margin=0.0):
    """Curves with their bands over the time of work, at most some `most` points each. curves: (words, Series)."""
    seconds, time = time_unit(max(values.points.x.max() for _, values in curves))
    picture, keys = Picture(f"time of work [{time}]", y_title), []
    for colour, (words, values) in zip(CURVES, curves):
        points = values.thinned(most)
        points = points.dropna() if values.of_runs else points  # a line from run to run
        picture.curve(points.assign(x=points.x / seconds), colour, len(curves))
        keys.append((f"line {colour}", words))
    picture.axes.margins(x=margin)
    return picture.figure(caption, keys)


def summary_table(series, of_runs):
    rows = []
    for quantity in QUANTITIES:
        values = series[quantity.key]
        if len(values):
            rows.append([titled(quantity.title, quantity.unit), *values.statistics(), number(values.spread(), 2),
                         number(values.deviation, 2), len(values)])
    caption = "Over all runs: least and greatest of all revolutions, between them means of runs"
    return Table(caption if of_runs else "Over all revolutions",
                 ["Quantity", "Least", "5 %", "Median", "95 %", "Greatest", "Spread", "Deviation",
                  "Runs" if of_runs else "Values"], rows)


def by_time_table(series):
    """The pictures in numbers."""
    step = max((s.points.x.max() for s in series.values() if len(s)), default=0.0) / STRETCHES or 1.0
    means = pandas.DataFrame({key: values.points.middle.groupby((values.points.x // step).clip(upper=STRETCHES - 1)).mean()
                              for key, values in series.items()})
    rows = [[f"{number(at * step, 3)} to {number((at + 1) * step, 3)}", *row] for at, *row in means.itertuples()]
    return Table("Means by time", ["Time of work [s]", *(titled(q.title, q.unit) for q in QUANTITIES)], rows)


def time_picture(quantity, values, most):
    """The axis of the values is never finer than the standard deviation of their measurement, which it shows."""
    points = values.thinned(most)
    seconds, unit = time_unit(points.x.max())
    picture = Picture(f"time of work [{unit}]", titled(quantity.title.lower(), quantity.unit))
    begins = values.points.groupby("run").x.first()[1:] / seconds
    if len(begins) <= MOST_MARKS and not values.of_runs:
        for begin in begins:
            picture.axes.axvline(begin, color=COLOURS["soft"], linewidth=0.8, linestyle=":")
    keys = [("line first", "mean"), ("band first", "least to greatest")]
    if values.deviation:
        middle = values.points.middle.median()
        picture.axes.axhspan(middle - values.deviation, middle + values.deviation, facecolor=COLOURS["soft"], alpha=0.15)
        keys.append(("band soft", "median \u00b1 standard deviation of one measurement"))
    picture.curve(points.assign(x=points.x / seconds), "first")
    picture.axes.margins(x=0.03 if values.of_runs else 0.0)
    return picture.figure(f"{quantity.title}: {quantity.meaning}", keys)


def usual(values):
    """Values that do not stretch a picture: no farther from the median than some widths of the middle 68 %."""
    low, median, high = numpy.quantile(values, [0.1587, 0.5, 0.8413])
    return values[numpy.abs(values - median) <= MOST_WIDTHS * (high - low)]


def bins(values):
    """Edges at round numbers; a value on an edge is in the bin above it."""
    edges = MaxNLocator(MOST_BARS, steps=[1, 2, 2.5, 5, 10]).tick_values(values.min(), values.max())
    edges = numpy.append(edges, 2.0 * edges[-1] - edges[-2])
    kept = numpy.flatnonzero(numpy.histogram(values, edges)[0])
    return edges[kept[0]:kept[-1] + 2]


def histogram(quantity, values):
    """(picture, table). Blows of a starting or stopping machine have bins of the table, but no bars."""
    values = numpy.asarray(values)
    edges = bins(usual(values))
    counts = numpy.histogram(values[values < edges[-1]], edges)[0]
    picture = Picture(titled(quantity.title.lower(), quantity.unit), "blows")
    picture.bars(edges, counts)
    low, high = min(edges[0], numpy.floor(values.min())), max(edges[-1], numpy.nextafter(numpy.ceil(values.max()), numpy.inf))
    every = numpy.unique([low, *edges, high])
    rows = [[f"{number(low)} to {number(high)}", int(count), number(100.0 * count / len(values), 3)]
            for low, high, count in zip(every, every[1:], numpy.histogram(values, every)[0]) if count]
    outside = len(values) - int(counts.sum())
    return (picture.figure(f"{quantity.title} of {number(len(values))} blows" +
                           (f"; {outside} of them, as at start and stop, lie beyond the picture" if outside else "")),
            Table(f"Blows by {quantity.title.lower()}", [titled(quantity.title, quantity.unit), "Blows", "Share [%]"], rows))


def over_time(series, most):
    drawn = [q for q in QUANTITIES if len(series[q.key])]
    if not drawn:
        return ["There is no revolution, so there is nothing over time."]
    of_runs = any(s.of_runs for s in series.values())
    histograms = [histogram(q, series[q.key].points.middle) for q in drawn if q.key in COUNTED and not series[q.key].of_runs]
    return [summary_table(series, of_runs),
            None if of_runs else Note("Spread: of the values from blow to blow (half of what holds the middle 68 %). Deviation: "
                                      "standard, of the measurement of one value, median."),
            [time_picture(q, series[q.key], most) for q in drawn],
            Note("Nothing is drawn where there was no work; runs follow each other, a dotted line between them."),
            [picture for picture, _ in histograms], *as_tables(counts for _, counts in histograms),
            Details("The pictures over time as a table", [by_time_table(series)])]
