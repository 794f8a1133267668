"""Blow rate, energy, restitution, peak force and hold-down over time."""
from report.histograms import histograms
from report.markup import block, details, number, paragraph, table
from report.quantities import QUANTITIES

MOST_POINTS = 600


def summary_table(segments):
    rows, of_runs = [], any(s.of_runs for s in segments.values())
    for quantity in QUANTITIES:
        values = segments[quantity.key]
        if len(values):
            unit = f" [{quantity.unit}]" if quantity.unit else ""
            rows.append([quantity.title + unit] + [number(v) for v in values.statistics()] +
                        [number(values.spread(), 2), number(values.deviation, 2), len(values)])
    if of_runs:
        return table("Over all runs: least and greatest of all turns, between them means of runs",
                     ["Quantity", "Least", "5 %", "Median", "95 %", "Greatest", "Spread", "Deviation", "Runs"], rows)
    return table("Over all turns", ["Quantity", "Least", "5 %", "Median", "95 %", "Greatest", "Spread", "Deviation",
                                    "Values"], rows) + paragraph(
        "Spread: of the values from blow to blow (half of what holds the middle 68 %). Deviation: standard, of the "
        "measurement of one value, median.", "note")


def by_time_table(segments):
    """A dozen stretches of time: the charts in numbers."""
    grids, longest = {}, max((p[0] for s in segments.values() for run in s.runs for p in run), default=0.0)
    count = 12
    step = longest / count or 1.0
    for quantity in QUANTITIES:
        grids[quantity.key] = segments[quantity.key].on_grid(step, count)
    rows = []
    for i in range(count):
        points = [grids[q.key][i] for q in QUANTITIES]
        if any(points):
            rows.append([f"{number(i * step, 3)} to {number((i + 1) * step, 3)}"] +
                        [number(p[2]) if p else "\u2013" for p in points])
    header = ["Time after the start [s]"] + [q.title + (f" [{q.unit}]" if q.unit else "") for q in QUANTITIES]
    return table("Means by time", header, rows)


def over_time(subject, segments, charts, group, most=MOST_POINTS):
    if not any(len(s) for s in segments.values()):
        return paragraph("No turn, so there is nothing over time.")
    content = str(histograms(segments, QUANTITIES))
    for quantity in QUANTITIES:
        values = segments[quantity.key]
        unit = f" [{quantity.unit}]" if quantity.unit else ""
        chart = charts.over_time(quantity.title, "", values.thinned(most), subject.first_ns,
                                 group) if len(values) else paragraph("No value in any turn.")
        content += block(quantity.title + unit, paragraph(quantity.meaning.capitalize() + ".", "note") + chart)
    return summary_table(segments) + content + details("The charts as a table", by_time_table(segments))
