"""Two or more machines or recordings side by side."""
from collections import namedtuple

from markupsafe import Markup

from report.blocks import CURVES, Note, Table
from report.check import refusals_of
from report.conditions import MISUSE, UNKNOWN, counter
from report.formats import (NOTHING, clean, duration, in_unit, in_words, is_nothing, measured, moment, number,
                            scaled, shown, titled)
from report.over_time import curves_picture
from report.overview import blows_per_hour, total_energy, with_spread
from report.quantities import QUANTITIES
from report.subjects import Subject

MOST_RUNS = 50
MOST_SIDE_BY_SIDE = 4  # beyond: a machine is a row
MOST_POINTS = 400  # of all curves of a picture

# Figures that a warning makes doubtful, by the warning's key.
CRANK = "crank"    # everything that comes from the crank's estimate
BOOM = "boom"      # joints, cylinders, sections, stresses
COUNTS = "counts"  # how much was seen at all
ALL = {CRANK, BOOM}

# A key that is not here puts everything measured in doubt.
CONCERNS = {
    "pitch joints": {CRANK, BOOM}, "imu": {CRANK, BOOM}, "imu late": {CRANK, BOOM}, "joint states": {CRANK, BOOM},
    "boom stiffness": {BOOM}, "pressures": {BOOM}, "pressure stamps": {BOOM}, "pressure fit": {BOOM}, "rock": {BOOM},
    "boom joints": {BOOM}, "boom loads": {BOOM}, "boom vibration": {BOOM},
    "cylinder stiffness": set(), "boom damping": set(),  # found, and allowed for
    "lost messages": {COUNTS}, "publishers": ALL | {COUNTS}, "definitions": {COUNTS}, "ledger": set(),
}

# value: for the difference, None where there is none; kind: what puts it in doubt, None for what no warning affects.
Figure = namedtuple("Figure", "name shown value kind")


def doubts_of(subject):
    """{kind: first warning that concerns it}, most important first."""
    found = {}
    for row in subject.frame("key, text FROM warnings WHERE {runs} ORDER BY place", text=["key", "text"]).itertuples():
        for kind in CONCERNS.get(row.key, ALL):
            found.setdefault(kind, row.text)
    return found


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
        kind = CRANK if channel.name.startswith("hull_wrench/") else BOOM
        equivalents = channel.equivalents()
        for slope in (3.0, 5.0):
            yield Figure(titled(f"{in_words(channel.name)}, range at slope {slope:g}", unit),
                         measured(*equivalents[slope], factor), scaled(equivalents[slope][0], factor), kind)


def misuse_figures(subject):
    for name, title, _, _ in MISUSE:
        count, per_hour = counter(subject, name)
        title, _, unit = title.partition(" [")
        yield Figure(f"{title}, per hour{unit and f' [{unit}'}", UNKNOWN if count is None else number(per_hour, 3), per_hour,
                     CRANK if count else None)


def figures_of(subject, series):
    """Figures of one machine."""
    yield Figure("From (UTC)", moment(subject.first_ns, "minutes"), None, None)
    yield Figure("At work", duration(subject.total("duration")), subject.total("duration"), COUNTS)
    yield plain("Runs", len(subject.runs), None)
    yield plain("Blows", subject.total("blows"), COUNTS)
    yield plain("Blows per hour", blows_per_hour(subject), COUNTS)
    yield plain("Energy of all blows [MJ]", scaled(total_energy(subject, series), 1e-6), CRANK)
    yield from turn_figures(series)
    yield from channel_figures(subject.counted_channels())
    yield from misuse_figures(subject)
    yield plain("Consistency", subject.worst("consistency"), None, 3)
    yield plain("Jitter of the stamps [ms]", scaled(subject.worst("timing_noise"), 1e3), None, 3)
    yield plain("Refused samples", sum(count for _, count in refusals_of(subject)), None)
    yield plain("Restarts", subject.total("restarts"), None)


def by_name(figures):
    return {figure.name: figure for figure in figures}


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


def table_of_rows(caption, first, labels, columns, doubts, compared=()):
    """A row for each label. compared: beginnings of the names of figures with the difference from the first row."""
    header, rows = [first], [[label] for label in labels]
    for name in dict.fromkeys(name for figures in columns for name in figures):
        has_difference = name.startswith(compared)
        header += [name, "Diff. [%]"] if has_difference else [name]
        for row, figures, doubt in zip(rows, columns, doubts):
            row.append(marked(figures.get(name), doubt))
            if has_difference:
                row.append("" if figures is columns[0] else difference(columns[0].get(name), figures.get(name)))
    return Table(caption, header, rows)


def comparison_table(labels, columns, doubts):
    """columns: {name: Figure} of each machine. Few machines are columns beside each other, many are rows."""
    if len(labels) > MOST_SIDE_BY_SIDE:
        return table_of_rows("Machines, one a row", "Machine", labels, columns, doubts)
    header = ["Figure", labels[0], *(title for label in labels[1:] for title in (label, "Diff. [%]"))]
    rows = []
    for name in dict.fromkeys(name for figures in columns for name in figures):
        first, *others = ([marked(figures.get(name), doubt), difference(columns[0].get(name), figures.get(name))]
                          for figures, doubt in zip(columns, doubts))
        rows.append([name, first[0], *sum(others, [])])
    return Table("Machines side by side", header, rows, "numbers compare")


def run_figures(run, series):
    """Figures of a subject of one run."""
    yield plain("Blows", run.total("blows"), COUNTS)
    yield plain("Blows per hour", blows_per_hour(run), COUNTS)
    yield from turn_figures(series)


def runs_compared(subject, series):
    """Runs of one machine below each other, compared with the first; None for one run and for too many."""
    if not 2 <= len(subject.runs) <= MOST_RUNS or any(values.of_runs for values in series.values()):
        return None
    runs = [Subject(subject.database, name, [run]) for name, run in zip(subject.recordings(), subject.runs)]
    columns = [by_name(run_figures(run, {key: values.of_run(at) for key, values in series.items()}))
               for at, run in enumerate(runs)]
    return table_of_rows("Runs below each other", "Run", [run.label for run in runs], columns, list(map(doubts_of, runs)),
                         ("Blow energy [", "Peak force along the tool ["))


def overlaid(subjects, series):
    """A picture of each quantity, over the time that each machine was at work."""
    for quantity in QUANTITIES:
        curves = [(s.label, series[s.label][quantity.key]) for s in subjects]
        curves = [curve for curve in curves if len(curve[1])][:len(CURVES)]
        if max((values.points.x.max() for _, values in curves), default=0.0) > 0.0:
            yield curves_picture(f"{quantity.title} over the time of work", titled(quantity.title.lower(), quantity.unit), curves,
                                 MOST_POINTS // len(curves), margin=0.02)


def comparison(subjects, series):
    doubts, first = list(map(doubts_of, subjects)), len(CURVES)
    return [comparison_table([subject.label for subject in subjects],
                             [by_name(figures_of(subject, series[subject.label])) for subject in subjects], doubts),
            Note("Median of the revolutions, \u00b1 the standard deviation of its measurement, or the spread where that is not "
                 "known." +
                 (" ?: a warning above affects the figure." if any(doubts) else "")),
            Note("Line: mean, band: least and greatest. Runs follow each other without the time between them." +
                 (f" Curves are those of the first {first} machines with a revolution." if len(subjects) > first else "")),
            list(overlaid(subjects, series))]
