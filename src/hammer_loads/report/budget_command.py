"""Command line of budget."""
import csv
import json
import sys
import tempfile

from report.budget import budget_of
from report.command import Parser, add_bag_options, databases, guarded
from report.database import LEDGER, Database
from report.problem import Problem
from report.subjects import subjects_of

TEXT, JSON, CSV = "text", "json", "csv"
LEAST_SHOWN = 5e-4


def parser():
    result = Parser(
        prog="budget", description="Where the uncertainty of a machine's figures comes from, and what to measure next.",
        epilog="Shares are those of the variance and sum to 1 (JCGM 100, 5.1.2). Deviations are those of one turn's "
               "figures. Errors are one line each; exit code 1, or 2 for wrong usage.")
    result.add_argument("files", nargs="+", metavar="FILE",
                        help="bags, or a database of process_bag --db; splits of one recording count as one")
    kind = result.add_mutually_exclusive_group()
    for name in (JSON, CSV):
        kind.add_argument(f"--{name}", dest="kind", action="store_const", const=name, default=TEXT,
                          help=f"print {name.upper()}")
    add_bag_options(result)
    return result


def found(database):
    """(machine, figures) of each machine in a file."""
    if database.kind == LEDGER:
        raise Problem(f"{database.path}: is a ledger, which keeps no sources; give the bags or process_bag --db")
    budgets = [(subject.label, budget_of(subject)) for subject in subjects_of(database)]
    if not any(figures for _, figures in budgets):
        raise Problem(f"{database.path}: holds no budget; it has no whole turn, or is of an older process_bag --db")
    return budgets


def shown(shares):
    """Lines; one for all that would be 0.0 %."""
    seen = [one for one in shares if one[1] >= LEAST_SHOWN]
    few = [f"  {100.0 * share:5.1f} %  {source}" for source, share in seen]
    rest = len(shares) - len(seen)
    return few + [f"  {100.0 * sum(share for _, share in shares[len(seen):]):5.1f} %  {rest} more"] * (rest > 0)


def as_text(budgets):
    lines = []
    for machine, figures in budgets:
        lines.append(f"{machine}: standard deviations of one turn, by source")
        for f in figures:
            lines.append(f"{f.quantity}: {f.value:.5g} +- {f.deviation:.2g}; {f.halved:.2g} with the largest source halved")
            lines += shown(f.shares)
    return "\n".join(lines) + "\n"


def as_json(budgets):
    return json.dumps({"machines": [
        {"machine": machine,
         "figures": [{"quantity": f.quantity, "unit": f.unit, "value": f.value, "deviation": f.deviation,
                      "deviation_with_largest_halved": f.halved,
                      "sources": [{"source": source, "share": share} for source, share in f.shares]} for f in figures]}
        for machine, figures in budgets]}, indent=2) + "\n"


def write_csv(budgets, stream):
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["machine", "quantity", "value", "deviation", "deviation_with_largest_halved", "source", "share"])
    for machine, figures in budgets:
        for f in figures:
            for source, share in f.shares:
                writer.writerow([machine, f.quantity, f.value, f.deviation, f.halved, source, share])


def run(given):
    with tempfile.TemporaryDirectory(prefix="hammer_loads_budget") as folder:
        budgets = [budget for path in databases(given, folder) for budget in found(Database(path))]
    if given.kind == CSV:
        write_csv(budgets, sys.stdout)
    else:
        sys.stdout.write(as_json(budgets) if given.kind == JSON else as_text(budgets))


def main(arguments):
    """Exit code."""
    options = parser()
    return guarded(run, options.parse_args(arguments), options)
