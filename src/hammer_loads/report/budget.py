"""Where the uncertainty of a machine's figures comes from, and what to measure next (JCGM 100, 5)."""
import math

from report.markup import Raw, in_unit, measured, number, paragraph, scaled, table, text
from report.names import without_unit
from report.svg import coordinate

COLOURS = ("#1f5fa8", "#b4530f", "#2d7a3a", "#7b4fa3", "#a31621", "#8a7a1f", "#3a8f94")
REST = "the rest"


class Figure:
    """Value and standard deviation in the quantity's unit; shares of the variance by source, largest first."""

    def __init__(self, quantity, value, deviation, shares):
        self.quantity, self.value, self.deviation = quantity, value, deviation
        self.shares = sorted(shares.items(), key=lambda one: (-one[1], one[0]))

    @property
    def unit(self):
        return self.quantity.rsplit("_", 1)[-1] if "_" in self.quantity.rsplit("/", 1)[-1] else ""

    @property
    def halved(self):
        """The deviation if the largest source's were half."""
        return self.deviation * math.sqrt(max(0.0, 1.0 - 0.75 * self.shares[0][1]))


def budget_of(subject):
    """Figures of all runs of a machine; runs count by their turns. Nothing for files that keep no budget."""
    if "budget" not in subject.database.tables():
        return []
    parts = {}
    for run, row in subject.of_runs("SELECT quantity, value, deviation, source, share FROM budget WHERE run_id = ?"):
        part = parts.setdefault(row["quantity"], {}).setdefault(run["run_id"], [run["turns"] or 1, row, {}])
        if row["deviation"] is not None and row["share"] is not None:
            part[2][row["source"]] = row["share"] * row["deviation"] ** 2
    return [combined(quantity, list(of_runs.values())) for quantity, of_runs in parts.items()]


def combined(quantity, of_runs):
    turns = sum(part[0] for part in of_runs)
    variances = {}
    for count, _, sources in of_runs:
        for source, variance in sources.items():
            variances[source] = variances.get(source, 0.0) + variance * count / turns
    total = sum(variances.values())
    shares = {source: variance / total for source, variance in variances.items() if total > 0.0}
    value = sum(part[0] * (part[1]["value"] or 0.0) for part in of_runs) / turns
    return Figure(quantity, value, math.sqrt(total), shares or {REST: 1.0})


CHARACTER = 6.6  # width of one in a picture, in its units


def picture(figures):
    """A bar for each figure, parts by source."""
    order = {}
    for figure in figures:
        for source, share in figure.shares:
            order[source] = order.get(source, 0.0) + share
    shown = sorted(order, key=lambda source: -order[source])[:len(COLOURS) - 1]
    colour = dict(zip(shown, COLOURS))
    names = [without_unit(figure.quantity) for figure in figures]
    parts, height, width = [], 22, 440
    left = math.ceil(CHARACTER * max(map(len, names), default=0)) + 10
    for at, (name, figure) in enumerate(zip(names, figures)):
        y, x = at * height + 4, float(left)
        parts.append(f'<text x="{left - 6}" y="{y + 12}" text-anchor="end">{text(name)}</text>')
        rest = 1.0 - sum(share for source, share in figure.shares if source in colour)
        for source, share in [one for one in figure.shares if one[0] in colour] + [(REST, rest)]:
            if share <= 0.0:
                continue
            step = share * width
            parts.append(f'<rect x="{coordinate(x)}" y="{y}" width="{coordinate(step)}" height="15" '
                         f'fill="{colour.get(source, COLOURS[-1])}"><title>{text(source)}: {100 * share:.0f} %</title></rect>')
            x += step
    keys = "".join(f'<span class="key"><i style="border-color: {c}"></i>{text(source)}</span> '
                   for source, c in [*colour.items(), (REST, COLOURS[-1])])
    return Raw(f'<figure><svg viewBox="0 0 {left + width + 8} {len(figures) * height + 8}" role="img" '
               f'aria-label="Shares of the variance by source">{"".join(parts)}</svg>'
               f"<figcaption>Shares of the variance.<br>{keys}</figcaption></figure>\n")


def budget(subject):
    """Section of the page."""
    figures = budget_of(subject)
    if not figures:
        return paragraph("This file keeps no budget: process_bag --db of this version writes one.")
    rows = []
    for figure in figures:
        factor, unit = in_unit(figure.unit)
        source, share = figure.shares[0]
        relative = 100.0 * figure.deviation / abs(figure.value) if figure.value else None
        rows.append([without_unit(figure.quantity), unit,
                     measured(scaled(figure.value, factor), scaled(figure.deviation, factor)), number(relative, 2),
                     f"{source} ({100 * share:.0f} %)",
                     number(None if relative is None else relative * figure.halved / figure.deviation, 2)
                     if figure.deviation > 0.0 else number(None)])
    return (paragraph("Standard deviations of one turn's figures; what makes most of one is what to measure next. Constants "
                      "err alike in all turns: more hours do not lower them.") +
            table("Uncertainty budget", ["Figure", "Unit", "Value", "Deviation [%]", "Largest source", "With it halved [%]"],
                  rows) + picture(figures))
