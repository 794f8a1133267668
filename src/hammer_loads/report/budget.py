"""Uncertainty budget of a machine's figures, and the quantity to measure next (JCGM 100, 5): section and command."""
import csv
import json
import math
import sys
import tempfile

from report.command import Parser, add_bag_options, databases, guarded
from report.database import LEDGER, Database
from report.formats import Table, in_unit, measured, number
from report.names import in_words
from report.problem import Problem
from report.subjects import subjects_of

REST = "the rest"
COLOURS = 7  # of sources in the bars, the rest beside
TEXT, JSON, CSV = "text", "json", "csv"
LEAST_SHOWN = 5e-4


class Figure:
    """Value and standard deviation in the quantity's unit; shares of the variance by source, largest first."""

    def __init__(self, quantity, unit, value, deviation, shares):
        self.quantity, self.unit, self.value, self.deviation = quantity, unit, value, deviation
        self.shares = sorted(shares.items(), key=lambda one: (-one[1], one[0]))

    @property
    def halved(self):
        """The deviation if the largest source's were half."""
        return self.deviation * math.sqrt(max(0.0, 1.0 - 0.75 * self.shares[0][1]))


def budget_of(subject):
    """Figures of all runs of a machine; runs count by their turns. Nothing for files that keep no budget."""
    if "budget" not in subject.database.tables():
        return []
    rows = subject.frame("quantity, unit, source, value, std, share FROM budget WHERE {runs}", text=["quantity", "unit", "source"])
    turns = rows.run.map(lambda run: subject.runs[run]["turns"] or 1)
    rows = rows.assign(turns=turns, variance=turns * rows.share * rows["std"] ** 2)
    return [combined(quantity, of_quantity) for quantity, of_quantity in rows.groupby("quantity", sort=False)]


def combined(quantity, rows):
    runs = rows.drop_duplicates("run")
    turns = runs.turns.sum()
    variances = rows.dropna(subset=["variance"]).groupby("source").variance.sum() / turns
    total = variances.sum()
    shares = (variances / total).to_dict() if total > 0.0 else {REST: 1.0}
    return Figure(quantity, runs.unit.iloc[0], float((runs.turns * runs.value.fillna(0.0)).sum() / turns), math.sqrt(total), shares)


def bars(figures):
    """(name, parts as (class, source, share)) of each figure, and the keys: the largest sources over all have a colour."""
    order = {}
    for figure in figures:
        for source, share in figure.shares:
            order[source] = order.get(source, 0.0) + share
    colours = {source: f"c{at}" for at, source in enumerate(sorted(order, key=lambda source: -order[source])[:COLOURS])}
    shown = []
    for figure in figures:
        parts = [(colours[source], source, share) for source, share in figure.shares if source in colours]
        parts.append(("soft", REST, max(0.0, 1.0 - sum(part[2] for part in parts))))
        shown.append((in_words(figure.quantity), parts))
    return shown, [(f"box {colour}", source) for source, colour in [*colours.items(), (REST, "soft")]]


def budget_row(figure):
    factor, unit = in_unit(figure.unit)
    source, share = figure.shares[0]
    relative = 100.0 / abs(figure.value) if figure.value else math.nan
    return [in_words(figure.quantity), unit, measured(figure.value * factor, figure.deviation * factor),
            number(relative * figure.deviation, 2), f"{source} ({100 * share:.0f} %)", number(relative * figure.halved, 2)]


def budget(subject):
    figures = budget_of(subject)
    if not figures:
        return None
    shown, keys = bars(figures)
    return {"bars": shown, "legend": keys, "table": Table(
        "Uncertainty budget", ["Figure", "Unit", "Value", "Deviation [%]", "Largest source", "With it halved [%]"],
        [budget_row(figure) for figure in figures])}


def parser():
    result = Parser(
        prog="budget", description="Where the uncertainty of a machine's figures comes from, and what to measure next.",
        epilog="Shares are those of the variance and sum to 1 (JCGM 100, 5.1.2). Deviations are those of one revolution's "
               "figures. Errors are one line each; exit code 1, or 2 for wrong usage.")
    result.add_argument("files", nargs="+", metavar="FILE",
                        help="bags, or a database of process_bag --db; splits of one recording count as one")
    kind = result.add_mutually_exclusive_group()
    for name in (JSON, CSV):
        kind.add_argument(f"--{name}", dest="kind", action="store_const", const=name, default=TEXT,
                          help=f"print {name.upper()}")
    add_bag_options(result)
    return result


def budgets_of(database):
    """(machine, figures) of each machine in a file."""
    if database.kind == LEDGER:
        raise Problem(f"{database.path}: is a ledger, which keeps no sources; give the bags or process_bag --db")
    budgets = [(subject.label, budget_of(subject)) for subject in subjects_of(database)]
    if not any(figures for _, figures in budgets):
        raise Problem(f"{database.path}: holds no budget; it has no whole revolution, or is of an older process_bag --db")
    return budgets


def share_lines(shares):
    """Lines; one for all that would be 0.0 %."""
    seen = [one for one in shares if one[1] >= LEAST_SHOWN]
    few = [f"  {100.0 * share:5.1f} %  {source}" for source, share in seen]
    rest = len(shares) - len(seen)
    return few + [f"  {100.0 * sum(share for _, share in shares[len(seen):]):5.1f} %  {rest} more"] * (rest > 0)


def as_text(budgets):
    lines = []
    for machine, figures in budgets:
        lines.append(f"{machine}: standard deviations of one revolution, by source")
        for f in figures:
            unit = f" {f.unit}" if f.unit != "-" else ""
            lines.append(f"{in_words(f.quantity)}: {f.value:.5g} +- {f.deviation:.2g}{unit}; "
                         f"{f.halved:.2g}{unit} with the largest source halved")
            lines += share_lines(f.shares)
    return "\n".join(lines) + "\n"


def as_json(budgets):
    return json.dumps({"machines": [
        {"machine": machine,
         "figures": [{"quantity": f.quantity, "unit": f.unit, "value": f.value, "std": f.deviation,
                      "std_with_largest_halved": f.halved,
                      "sources": [{"source": source, "share": share} for source, share in f.shares]} for f in figures]}
        for machine, figures in budgets]}, indent=2) + "\n"


def write_csv(budgets, stream):
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["machine", "quantity", "unit", "value", "std", "std_with_largest_halved", "source", "share"])
    for machine, figures in budgets:
        for f in figures:
            for source, share in f.shares:
                writer.writerow([machine, f.quantity, f.unit, f.value, f.deviation, f.halved, source, share])


def run(given):
    with tempfile.TemporaryDirectory(prefix="hammer_loads_budget") as folder:
        budgets = [budget for path in databases(given, folder) for budget in budgets_of(Database(path))]
    if given.kind == CSV:
        write_csv(budgets, sys.stdout)
    else:
        sys.stdout.write(as_json(budgets) if given.kind == JSON else as_text(budgets))


def main(arguments):
    """Exit code."""
    options = parser()
    return guarded(run, options.parse_args(arguments), options)
