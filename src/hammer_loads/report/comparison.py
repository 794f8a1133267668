"""Two or more machines side by side."""
from report.charts import block
from report.damage import SLOPES
from report.markup import Raw, duration, in_unit, number, paragraph, scaled, table, utc
from report.quantities import QUANTITIES
from report.sensor_health import refusals_of, worst_of

MOST_CURVES = 8
MOST_SIDE_BY_SIDE = 4  # beyond: a machine is a row
GRID = 300
TIME_UNITS = [(86400.0, "days"), (3600.0, "h"), (60.0, "min"), (1.0, "s")]


def figures_of(subject, segments, channels):
    """(name, text) of one machine."""
    rows = [("From (UTC)", utc(subject.first_ns)), ("At work", duration(subject.total("duration_s"))),
            ("Runs", number(len(subject.runs))), ("Turns", number(subject.total("turns"))),
            ("Blows", number(subject.total("blows")))]
    for quantity in QUANTITIES:
        _, _, median, _, greatest = segments[quantity.key].statistics()
        unit = f" [{quantity.unit}]" if quantity.unit else ""
        rows.append((f"{quantity.title}{unit}, median", number(median)))
        if quantity.key in ("amplitude_N", "energy_J"):
            rows.append((f"{quantity.title}{unit}, greatest", number(greatest)))
    for channel in channels:
        factor, unit = in_unit(channel.unit)
        for slope, (value, _) in zip(SLOPES, channel.equivalents()):
            if slope in (3.0, 5.0):
                rows.append((f"{channel.name} [{unit}], equivalent range, slope {slope:g}",
                             number(scaled(value, factor))))
    rows += [("Consistency", number(worst_of(subject, "consistency"), 3)),
             ("Jitter of the stamps [ms]", number(scaled(worst_of(subject, "timing_noise_s"), 1e3), 3)),
             ("Refused samples", number(sum(n for _, n in refusals_of(subject)))),
             ("Restarts", number(subject.total("restarts")))]
    return rows


def comparison_table(columns):
    """`columns`: {label: [(name, text)]}."""
    names = list(dict.fromkeys(name for rows in columns.values() for name, _ in rows))
    values = {label: dict(rows) for label, rows in columns.items()}
    if len(columns) <= MOST_SIDE_BY_SIDE:
        return table("Machines side by side", ["Figure", *columns],
                     [[name] + [values[label].get(name, "\u2013") for label in columns] for name in names])
    return table("Machines, one a row", ["Machine", *names],
                 [[label] + [values[label].get(name, "\u2013") for name in names] for label in columns])


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
        # Not finer than the sparsest curve, so that none has holes.
        count = max(1, min([GRID] + [int(len(c) * longest / max(run[-1][0] for run in c.runs if run) / 2)
                                     for c in curves if len(c) > 1]))
        step = longest * (1 + 1e-9) / count
        seconds, time_unit = next(u for u in TIME_UNITS if longest >= 3 * u[0] or u[0] == 1.0)
        unit = f" [{quantity.unit}]" if quantity.unit else ""
        content += block(f"{quantity.title}{unit} over time [{time_unit}]", charts.compared(
            quantity.title, quantity.unit, [s.label for s in shown], step / seconds,
            [c.on_grid(step, count) for c in curves], "compared"))
    return content


def comparison(subjects, segments, charts):
    columns = {s.label: figures_of(s, segments[s.label], s.counted_channels()) for s in subjects}
    note = paragraph("Time since each one's start; line: mean, band: least and greatest.", "note")
    return Raw(comparison_table(columns) + note + overlaid(subjects, segments, charts))
