"""Two or more machines or recordings side by side."""
from collections import namedtuple

from report.damage import SLOPES
from report.doubt import COUNTS, CRANK, doubts_of, kind_of
from report.markup import Raw, block, cell, details, duration, in_unit, measured, moment, number, paragraph, scaled, table, text
from report.misuse import COUNTERS, counter
from report.names import recording_of, without_unit
from report.overview import blows_per_hour, total_energy, with_spread
from report.quantities import QUANTITIES
from report.sensor_health import refusals_of, worst_of
from report.series import Segments

MOST_CURVES = 8
MOST_RUNS = 50
MOST_SIDE_BY_SIDE = 4  # beyond: a machine is a row
GRID = 300
TIME_UNITS = [(86400.0, "days"), (3600.0, "h"), (60.0, "min"), (1.0, "s")]
DOUBTFUL = "?"

# value: for the difference, None where there is none; kind: what puts it in doubt.
Figure = namedtuple("Figure", "name shown value kind")


def plain(name, value, kind):
    return Figure(name, number(value), value, kind)


def turn_figures(segments):
    for quantity in (q for q in QUANTITIES if q.key in segments):
        values = segments[quantity.key]
        unit = f" [{quantity.unit}]" if quantity.unit else ""
        yield Figure(f"{quantity.title}{unit}", with_spread(values), values.statistics()[2], CRANK)
        if quantity.key in ("amplitude_N", "energy_J"):
            yield plain(f"{quantity.title}, greatest{unit}", values.statistics()[4], CRANK)


def channel_figures(channels):
    for channel in channels:
        factor, unit = in_unit(channel.unit)
        for slope, (value, deviation) in zip(SLOPES, channel.equivalents()):
            if slope in (3.0, 5.0):
                yield Figure(f"{without_unit(channel.name)}, range at slope {slope:g} [{unit}]",
                             measured(scaled(value, factor), scaled(deviation, factor)), scaled(value, factor),
                             kind_of(channel.name))


def figures_of(subject, segments, channels):
    """Of one machine."""
    energy = total_energy(subject, segments)
    yield Figure("From (UTC)", moment(subject.first_ns, "minutes"), None, None)
    yield Figure("At work", duration(subject.total("duration_s")), subject.total("duration_s"), COUNTS)
    yield plain("Runs", len(subject.runs), None)
    yield plain("Blows", subject.total("blows"), COUNTS)
    yield plain("Blows per hour", blows_per_hour(subject), COUNTS)
    yield plain("Energy of all blows [MJ]", scaled(energy, 1e-6), CRANK)
    yield from turn_figures(segments)
    yield from channel_figures(channels)
    for name, title, _, _ in COUNTERS:
        count, per_hour = counter(subject, name)
        yield Figure(f"{title.replace(' [s]', '')}, per hour{' [s]' if '[s]' in title else ''}",
                     "not known" if count is None else number(per_hour, 3), per_hour, CRANK if count else None)
    for name, value in (("Consistency", worst_of(subject, "consistency")),
                        ("Jitter of the stamps [ms]", scaled(worst_of(subject, "timing_noise_s"), 1e3)),
                        ("Refused samples", sum(n for _, n in refusals_of(subject))),
                        ("Restarts", subject.total("restarts"))):
        yield Figure(name, number(value, 3), None, None)  # of the sensor: a difference says nothing


def difference(first, other):
    """In %; nothing where there is no percentage."""
    if first is None or other is None or not first.value or other.value is None:
        return ""
    percent = 100.0 * (other.value - first.value) / abs(first.value)
    return f"{'+' if percent > 0.0 else ''}{number(percent, 2)}" if abs(percent) >= 0.05 else "0"


def marked(figure, doubts):
    """A cell's text, with the mark and its reason where a warning concerns it."""
    if figure is None:
        return "\u2013"
    reason = doubts.get(figure.kind)
    mark = f' <abbr class="doubt" title="{text(reason)}">{DOUBTFUL}</abbr>' if reason else ""
    return Raw(f"{cell(figure.shown)}{mark}")


def side_by_side(labels, columns, doubts, names):
    header, rows = ["Figure", labels[0]], []
    for label in labels[1:]:
        header += [label, "Diff. [%]"]
    for name in names:
        first = columns[labels[0]].get(name)
        row = [name, marked(first, doubts[labels[0]])]
        for label in labels[1:]:
            other = columns[label].get(name)
            row += [marked(other, doubts[label]), difference(first, other)]
        rows.append(row)
    return table("Machines side by side", header, rows, kind="numbers compare")


def comparison_table(subjects, columns):
    """`columns`: {label: {name: Figure}}."""
    labels = [s.label for s in subjects]
    doubts = {s.label: doubts_of(s) for s in subjects}
    names = list(dict.fromkeys(name for figures in columns.values() for name in figures))
    if len(labels) <= MOST_SIDE_BY_SIDE:
        content = side_by_side(labels, columns, doubts, names)
    else:
        content = table("Machines, one a row", ["Machine", *names],
                        [[label] + [marked(columns[label].get(name), doubts[label]) for name in names]
                         for label in labels])
    note = "Of turns the median, \u00b1 the standard deviation of its measurement, or the spread where that is not known."
    if any(doubts.values()):
        note += f" {DOUBTFUL}: a warning above puts the figure in doubt."
    return content + paragraph(note, "note")


def run_figures(run, segments, at):
    """Of one run among a subject's: {name: Figure}."""
    hours = (run["duration_s"] or 0.0) / 3600.0
    figures = [plain("Blows", run["blows"], COUNTS),
               plain("Blows per hour", run["blows"] / hours if hours > 0.0 and run["blows"] else None, COUNTS)]
    for quantity in QUANTITIES:
        values = Segments()
        values.runs, values.deviation = [segments[quantity.key].runs[at]], segments[quantity.key].deviation
        figures += list(turn_figures({quantity.key: values}))
    return {figure.name: figure for figure in figures}


def runs_compared(subject, segments):
    """The runs of one machine below each other, the first as the measure; nothing of one run or of too many."""
    if not 2 <= len(subject.runs) <= MOST_RUNS or any(s.of_runs for s in segments.values()):
        return ""
    names = recording_of(subject)
    of_runs = [(names[run["run_id"]], run_figures(run, segments, at), doubts_of(subject, run))
               for at, run in enumerate(subject.runs)]
    titles, first, rows = list(of_runs[0][1]), of_runs[0][1], []
    compared = [title for title in titles if title.startswith(("Blow energy [", "Peak force ["))]
    header = ["Run"]
    for title in titles:
        header += [title, "Diff. [%]"] if title in compared else [title]
    for name, figures, doubts in of_runs:
        row = [name]
        for title in titles:
            row.append(marked(figures[title], doubts))
            if title in compared:
                row.append("" if figures is first else difference(first[title], figures[title]))
        rows.append(row)
    content = table("Runs below each other", header, rows)
    return content if len(rows) <= 12 else details(f"{len(rows)} runs below each other", content)


def overlaid(subjects, segments, charts):
    shown = [s for s in subjects if any(len(v) for v in segments[s.label].values())][:MOST_CURVES]
    content = ""
    if len(shown) < len(subjects):
        content += paragraph(f"Curves of {len(shown)} of {len(subjects)} machines: the first {MOST_CURVES} with a turn.",
                             "note")
    for quantity in QUANTITIES:
        curves = [segments[s.label][quantity.key] for s in shown]
        longest = max((p[0] for c in curves for run in c.runs for p in run), default=0.0)
        if not longest > 0.0:
            continue
        # Not finer than the sparsest curve, so that a hole is a pause.
        count = max(1, min([GRID] + [int(len(c) * longest / max(run[-1][0] for run in c.runs if run) / 2)
                                     for c in curves if len(c) > 1]))
        step = longest * (1 + 1e-9) / count
        seconds, time_unit = next(u for u in TIME_UNITS if longest >= 3 * u[0] or u[0] == 1.0)
        unit = f" [{quantity.unit}]" if quantity.unit else ""
        content += block(f"{quantity.title}{unit} over time [{time_unit}]", charts.compared(
            quantity.title, "", [s.label for s in shown], step / seconds,
            [c.on_grid(step, count) for c in curves], "compared"))
    return content


def comparison(subjects, segments, charts):
    columns = {s.label: {f.name: f for f in figures_of(s, segments[s.label], s.counted_channels())} for s in subjects}
    note = paragraph("Time since each one's start; line: mean, band: least and greatest.", "note")
    return Raw(comparison_table(subjects, columns) + note + overlaid(subjects, segments, charts))
