"""Two or more machines or recordings side by side."""
from collections import namedtuple

from markupsafe import Markup

from report.damage import SLOPES
from report.formats import (NOTHING, Table, clean, duration, in_unit, is_nothing, measured, moment, number, scaled, shown,
                            titled)
from report.misuse import COUNTERS, UNKNOWN, counter
from report.names import recording_of, in_words
from report.over_time import time_unit
from report.overview import blows_per_hour, total_energy, with_spread
from report.pictures import CURVES, Picture
from report.quantities import QUANTITIES
from report.sensor_health import refusals_of, worst_of

MOST_RUNS = 50
MOST_SIDE_BY_SIDE = 4  # beyond: a machine is a row
GRID = 200

# Figures that a warning makes doubtful, by the warning's key.
CRANK = "crank"    # everything that comes from the crank's estimate
BOOM = "boom"      # joints, cylinders, sections, stresses
COUNTS = "counts"  # how much was seen at all
ALL = {CRANK, BOOM}

# A key that is not here puts everything measured in doubt.
CONCERNS = {
    "pitch joints": {CRANK, BOOM}, "imu": {CRANK, BOOM}, "joint states": {CRANK, BOOM},
    "boom stiffness": {BOOM}, "pressures": {BOOM}, "pressure stamps": {BOOM}, "pressure fit": {BOOM}, "rock": {BOOM},
    "boom joints": {BOOM},
    "cylinder stiffness": set(), "boom damping": set(),  # found, and allowed for
    "lost messages": {COUNTS}, "publishers": ALL | {COUNTS}, "definitions": {COUNTS}, "ledger": set(),
}

# value: for the difference, None where there is none; kind: what puts it in doubt.
Figure = namedtuple("Figure", "name shown value kind")


def doubts_of(subject, only=None):
    """{kind: first warning that concerns it}, most important first; `only`: of this run."""
    found = {}
    rows = subject.frame("key, text FROM warnings WHERE {runs} ORDER BY place", text=["key", "text"])
    for row in rows.itertuples():
        if only is None or subject.runs[row.run]["run_id"] == only["run_id"]:
            for kind in CONCERNS.get(row.key, ALL):
                found.setdefault(kind, row.text)
    return found


def kind_of(channel):
    return CRANK if channel.startswith("hull_wrench/") else BOOM


def plain(name, value, kind, digits=4):
    return Figure(name, number(value, digits), value, kind)


def turn_figures(series):
    for quantity in QUANTITIES:
        values = series[quantity.key]
        yield Figure(titled(quantity.title, quantity.unit), with_spread(values), values.statistics()[2], CRANK)
        if quantity.key in ("amplitude", "energy"):
            yield plain(titled(f"{quantity.title}, greatest", quantity.unit), values.statistics()[4], CRANK)


def channel_figures(channels):
    for channel in channels:
        factor, unit = in_unit(channel.unit)
        for slope, (value, deviation) in zip(SLOPES, channel.equivalents()):
            if slope in (3.0, 5.0):
                value, deviation = scaled(value, factor), scaled(deviation, factor)
                yield Figure(titled(f"{in_words(channel.name)}, range at slope {slope:g}", unit),
                             measured(value, deviation), value, kind_of(channel.name))


def figures_of(subject, series):
    """{name: Figure} of one machine. Figures of the sensor have no kind: no warning affects them."""
    def found():
        yield Figure("From (UTC)", moment(subject.first_ns, "minutes"), None, None)
        yield Figure("At work", duration(subject.total("duration")), subject.total("duration"), COUNTS)
        yield plain("Runs", len(subject.runs), None)
        yield plain("Blows", subject.total("blows"), COUNTS)
        yield plain("Blows per hour", blows_per_hour(subject), COUNTS)
        yield plain("Energy of all blows [MJ]", scaled(total_energy(subject, series), 1e-6), CRANK)
        yield from turn_figures(series)
        yield from channel_figures(subject.counted_channels())
        for name, title, _, _ in COUNTERS:
            count, per_hour = counter(subject, name)
            yield Figure(f"{title.replace(' [s]', '')}, per hour{' [s]' if '[s]' in title else ''}",
                         UNKNOWN if count is None else number(per_hour, 3), per_hour, CRANK if count else None)
        for name, value in (("Consistency", worst_of(subject, "consistency")),
                            ("Jitter of the stamps [ms]", scaled(worst_of(subject, "timing_noise"), 1e3)),
                            ("Refused samples", sum(count for _, count in refusals_of(subject))),
                            ("Restarts", subject.total("restarts"))):
            yield plain(name, value, None, 3)
    return {figure.name: figure for figure in found()}


def difference(first, other):
    """Percentage; empty where there is none."""
    if first is None or other is None or not first.value or is_nothing(first.value) or is_nothing(other.value):
        return ""
    percent = 100.0 * (other.value - first.value) / abs(first.value)
    return f"{'+' if percent > 0.0 else ''}{number(percent, 2)}" if abs(percent) >= 0.05 else "0"


def marked(figure, doubts):
    """Cell of a figure, with a mark and the reason where a warning concerns it."""
    if figure is None:
        return NOTHING
    reason = doubts.get(figure.kind)
    mark = Markup(' <abbr class="doubt" title="{}">?</abbr>').format(clean(reason)) if reason else ""
    return Markup("{}{}").format(shown(figure.shown), mark)


def comparison_table(subjects, columns, doubts):
    """`columns`: {name: Figure} of each subject. Few machines are columns beside each other, many are rows."""
    labels, names = [s.label for s in subjects], list(dict.fromkeys(name for figures in columns for name in figures))
    if len(subjects) > MOST_SIDE_BY_SIDE:
        return Table("Machines, one a row", ["Machine", *names],
                     [[label, *(marked(figures.get(name), doubt) for name in names)]
                      for label, figures, doubt in zip(labels, columns, doubts)])
    header, rows = ["Figure", labels[0]], []
    for label in labels[1:]:
        header += [label, "Diff. [%]"]
    for name in names:
        row = [name, marked(columns[0].get(name), doubts[0])]
        for figures, doubt in zip(columns[1:], doubts[1:]):
            row += [marked(figures.get(name), doubt), difference(columns[0].get(name), figures.get(name))]
        rows.append(row)
    return Table("Machines side by side", header, rows, "numbers compare")


def run_figures(run, series, at):
    """{name: Figure} of one run, whose place is `at`."""
    hours = (run["duration"] or 0.0) / 3600.0
    figures = [plain("Blows", run["blows"], COUNTS),
               plain("Blows per hour", run["blows"] / hours if hours > 0.0 and run["blows"] else None, COUNTS),
               *turn_figures({key: values.of_run(at) for key, values in series.items()})]
    return {figure.name: figure for figure in figures}


def runs_compared(subject, series):
    """Runs of one machine below each other, compared with the first; None for one run and for too many."""
    if not 2 <= len(subject.runs) <= MOST_RUNS or any(values.of_runs for values in series.values()):
        return None
    names = recording_of(subject)
    figures_of_runs = [run_figures(run, series, at) for at, run in enumerate(subject.runs)]
    first, header, rows = figures_of_runs[0], ["Run"], []
    compared = [title for title in first if title.startswith(("Blow energy [", "Peak force along the tool ["))]
    for title in first:
        header += [title, "Diff. [%]"] if title in compared else [title]
    for run, figures in zip(subject.runs, figures_of_runs):
        doubts, row = doubts_of(subject, run), [names[run["run_id"]]]
        for title in first:
            row.append(marked(figures[title], doubts))
            if title in compared:
                row.append("" if figures is first else difference(first[title], figures[title]))
        rows.append(row)
    return Table("Runs below each other", header, rows)


def overlaid(subjects, series):
    """A picture of each quantity, over the time that each machine was at work."""
    pictures = []
    for quantity in QUANTITIES:
        curves = [(s.label, series[s.label][quantity.key]) for s in subjects]
        curves = [curve for curve in curves if len(curve[1])][:len(CURVES)]
        longest = max((values.points.x.max() for _, values in curves), default=0.0)
        if not longest > 0.0:
            continue
        # Not finer than the sparsest curve, so that a hole is a pause.
        count = max(1, min([GRID] + [int(len(values) * longest / values.points.x.max() / 2) for _, values in curves
                                     if values.points.x.max() > 0.0]))
        seconds, unit = time_unit(longest)
        picture, keys = Picture(f"time of work [{unit}]", titled(quantity.title.lower(), quantity.unit)), []
        for colour, (label, values) in zip(CURVES, curves):
            few_runs = values.of_runs and len(values) <= GRID
            cells = values.points if few_runs else values.on_grid(longest * (1 + 1e-9) / count, count)
            picture.curve(cells.assign(x=cells.x / seconds), colour, len(curves))
            keys.append((f"line {colour}", label))
        picture.axes.margins(x=0.02)
        pictures.append(picture.figure(f"{quantity.title} over the time of work", keys))
    return pictures


def comparison(subjects, series):
    doubts = [doubts_of(subject) for subject in subjects]
    table = comparison_table(subjects, [figures_of(subject, series[subject.label]) for subject in subjects], doubts)
    return {"table": table, "doubts": any(doubts), "pictures": overlaid(subjects, series),
            "curves": len(CURVES) if len(subjects) > len(CURVES) else None}
