"""Uncertainty budget of a machine's figures, and the quantity to measure next (JCGM 100, 5): section and command."""
from collections import Counter, namedtuple
import json
import math

import pandas

from report import inputs
from report.blocks import CURVES, Bars, Table
from report.command import Parser
from report.database import LEDGER, Problem
from report.formats import in_unit, in_words, measured, number
from report.subjects import subjects_of

REST = "the rest"
LEAST_SHOWN = 5e-4


class Figure(namedtuple("Figure", "quantity unit value deviation shares")):
    """Value and standard deviation in the quantity's unit; shares of the variance by source, largest first."""

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
    shares = (variances / total).sort_values(ascending=False, kind="mergesort").items() if total > 0.0 else [(REST, 1.0)]
    value = float((runs.turns * runs.value.fillna(0.0)).sum() / turns)
    return Figure(quantity, runs.unit.iloc[0], value, math.sqrt(total), list(shares))


def bars(figures):
    """(name, parts as (class, source, share)) of each figure, and the keys: the largest sources over all have a colour."""
    order = Counter()
    for figure in figures:
        order.update(dict(figure.shares))
    colours = {source: colour for colour, (source, _) in zip(CURVES, order.most_common(len(CURVES) - 1))}
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
    return [in_words(figure.quantity), unit, measured(figure.value, figure.deviation, factor),
            number(relative * figure.deviation, 2), f"{source} ({100 * share:.0f} %)", number(relative * figure.halved, 2)]


def budget(subject):
    figures = budget_of(subject)
    if not figures:
        return ["This file keeps no budget: process_bag --db of this version writes one."]
    header = ["Figure", "Unit", "Value", "Deviation [%]", "Largest source", "With it halved [%]"]
    return ["Standard deviations of one revolution's figures; measure next what makes most of one. Errors of constants are "
            "equal in all revolutions: more hours do not lower them.",
            Table("Uncertainty budget", header, list(map(budget_row, figures))), Bars("Shares of the variance", *bars(figures))]


def parser():
    result = Parser(
        dict(metavar="FILE", help="bags, or a database of process_bag --db; splits of one recording count as one"),
        prog="budget", description="Where the uncertainty of a machine's figures comes from, and what to measure next.",
        epilog="Shares are those of the variance and sum to 1 (JCGM 100, 5.1.2). Deviations are those of one revolution's "
               "figures. Errors are one line each; exit code 1, or 2 for wrong usage.")
    kind = result.add_mutually_exclusive_group()
    kind.add_argument("--json", dest="text_of", action="store_const", const=as_json, default=as_text, help="print JSON")
    kind.add_argument("--csv", dest="text_of", action="store_const", const=as_csv, help="print CSV")
    return result


def figures_in(subject):
    """Figures of a machine; refuses a file without."""
    if figures := budget_of(subject):
        return figures
    raise Problem(f"{subject.database.path}: holds no budget; it has no whole revolution, or is of an older process_bag --db")


def budgets_of(database):
    """(machine, figures) of each machine in a file."""
    if database.kind == LEDGER:
        raise Problem(f"{database.path}: is a ledger, which keeps no sources; give the bags or process_bag --db")
    return [(subject.label, figures_in(subject)) for subject in subjects_of(database)]


def share_lines(shares):
    """Lines; one for all that would be 0.0 %."""
    seen = [one for one in shares if one[1] >= LEAST_SHOWN]
    rest = [share for _, share in shares[len(seen):]]
    return [f"  {100.0 * share:5.1f} %  {source}"
            for source, share in seen + ([(f"{len(rest)} more", sum(rest))] if rest else [])]


def as_text(budgets):
    for machine, figures in budgets:
        yield f"{machine}: standard deviations of one revolution, by source"
        for f in figures:
            unit = f" {f.unit}" if f.unit != "-" else ""
            yield (f"{in_words(f.quantity)}: {f.value:.5g} +- {f.deviation:.2g}{unit}; "
                   f"{f.halved:.2g}{unit} with the largest source halved")
            yield from share_lines(f.shares)


def as_json(budgets):
    yield json.dumps({"machines": [
        {"machine": machine,
         "figures": [{"quantity": f.quantity, "unit": f.unit, "value": f.value, "std": f.deviation,
                      "std_with_largest_halved": f.halved,
                      "sources": [{"source": source, "share": share} for source, share in f.shares]} for f in figures]}
        for machine, figures in budgets]}, indent=2)


def as_csv(budgets):
    header = ["machine", "quantity", "unit", "value", "std", "std_with_largest_halved", "source", "share"]
    rows = [(machine, f.quantity, f.unit, f.value, f.deviation, f.halved, *share)
            for machine, figures in budgets for f in figures for share in f.shares]
    yield pandas.DataFrame(rows, columns=header).to_csv(index=False).rstrip("\n")


def run(given, folder):
    budgets = [budget for database in inputs.databases(given, folder) for budget in budgets_of(database)]
    print("\n".join(given.text_of(budgets)))
