"""Runs, totals and parameters of a machine, and its warnings."""
import os

from report.blocks import Figures, Table, as_tables, folded
from report.conditions import limit_lines
from report.formats import NOTHING, duration, measured, moment, number
from report.quantities import QUANTITIES

MOST_RUNS_SHOWN = 50
MOST_FAILED_SHOWN = 10
MOST_RUNS_NAMED = 10


def warnings_of(subject):
    """{words: numbers of its runs}, most important first, those of several runs once."""
    rows = subject.frame("text FROM warnings WHERE {runs} ORDER BY place", text=["text"])
    found = {words: list(runs + 1) for words, runs in rows.groupby("text", sort=False).run}
    if not subject.runs:
        found["no run at all: the recording holds no sample of a crank"] = []
    elif subject.total("turns") == 0:
        found["no whole revolution: there is nothing about blows, pulses and revolutions"] = []
    if withheld := subject.blows_without_energy():
        found[f"blows whose energy and restitution are withheld: {withheld} of {subject.total('blows')}; they are in no "
              "picture and no figure"] = []
    return {**found, **dict.fromkeys(limit_lines(subject), [])}


def failed_lines(subject):
    """A reason that begins with the bag's path is shown without it."""
    failed, lines = subject.failed_bags(), []
    for bag, reason in failed[:MOST_FAILED_SHOWN]:
        path, _, rest = (reason or "").partition(": ")
        named = rest and os.path.basename(path) == os.path.basename(bag)
        lines.append(f"bag {bag}: {rest if named else reason}")
    if len(failed) > MOST_FAILED_SHOWN:
        lines.append(f"{len(failed) - MOST_FAILED_SHOWN} more bags gave nothing")
    return lines


def warnings_list(subjects, mixed):
    """(machine, line) of all subjects; bags that gave nothing are the last lines."""
    lines, last = [("", line) for line in mixed], []
    for subject in subjects:
        name = subject.label if len(subjects) > 1 else ""
        for words, runs in warnings_of(subject).items():
            if len(subject.runs) > 1 and runs:
                listed = ", ".join(map(str, runs[:MOST_RUNS_NAMED])) + (" ..." if len(runs) > MOST_RUNS_NAMED else "")
                words = f"{words} (runs {listed})"
            lines.append((name, words))
        last += [(name, line) for line in failed_lines(subject)]
    return lines + last


def energy_text(joules):
    factor, unit = next(((f, u) for f, u in ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ")) if joules >= f), (1.0, "J"))
    return f"{number(joules / factor)} {unit}"


def total_energy(subject, series):
    """[J] over all blows with a value; None where there is none."""
    energies = series["energy"]
    if not len(energies):
        return None
    if not energies.of_runs:
        return energies.points.middle.sum()
    return subject.frame("total FROM run_figures WHERE {runs} AND quantity = 'energy'").total.sum()


def blows_per_hour(subject):
    return subject.total("blows") / subject.hours if subject.hours > 0.0 else None


def with_spread(values):
    """Median and standard deviation of the measurement; where that is not known the spread from blow to blow."""
    return measured(values.statistics()[2], values.deviation if values.deviation is not None else values.spread())


def truth_of(subject):
    """{quantity: text} of a simulated machine's true figures, where the file has them (table `truth`)."""
    if "truth" not in subject.database.tables():
        return {}
    true = dict(subject.database.rows("SELECT quantity, value FROM truth"))
    shown = [("blows", "", 1.0), *((quantity.key, quantity.unit, quantity.factor) for quantity in QUANTITIES)]
    return {key: f", true {number(true[key] * factor)} {unit}".rstrip() for key, unit, factor in shown if key in true}


def key_figures(subject, series):
    """(name, value); medians for revolutions."""
    energy, rate, true = total_energy(subject, series), blows_per_hour(subject), truth_of(subject)
    figures = [("at work", duration(subject.total("duration"))),
               ("blows", number(subject.total("blows")) + true.get("blows", ""))]
    if rate is not None:
        figures.append(("blows per hour of work", number(round(rate))))
    if energy is not None:
        figures.append(("energy of all blows", energy_text(energy)))
    for quantity in QUANTITIES:
        values = series[quantity.key]
        if len(values):
            kind = "deviation" if values.deviation is not None else "spread"
            figures.append((f"{quantity.title.lower()}, median \u00b1 {kind}",
                            f"{with_spread(values)} {quantity.unit}".strip() + true.get(quantity.key, "")))
    return figures


def runs_table(subject):
    rows = [[str(at), name, moment(run["first_stamp_ns"]), moment(run["last_stamp_ns"]),
             duration(run["duration"]), number(run["turns"]), number(run["blows"]), run["level"] or NOTHING,
             f"{run['version']} ({run['revision'][:10]})"]
            for at, (name, run) in enumerate(zip(subject.recordings(), subject.runs[:MOST_RUNS_SHOWN]), 1)]
    return Table("Runs", ["Run", "Recording", "From (UTC)", "To (UTC)", "At work", "Turns", "Blows", "Level", "Program"],
                 rows, "words")


def parameters_table(subject):
    """Parameters that differ from the shipped ones, each combination once."""
    names = ["key", "value", "shipped"]
    changed = subject.frame("key, value, shipped FROM parameters WHERE {runs} AND value IS NOT shipped", text=names)
    rows = changed.drop_duplicates(names).sort_values(names).fillna({"value": NOTHING, "shipped": "none"})
    return Table("Parameters that differ from the shipped ones", ["Parameter", "In force", "Shipped"], rows[names].values.tolist(),
                 "words")


def overview(subject, series, compared, samples):
    """compared: table of the runs, or nothing; samples: tables of the revolutions that are drawn."""
    if not subject.runs:
        return ["The file holds no run."]
    more = len(subject.runs) - MOST_RUNS_SHOWN
    return [Figures(key_figures(subject, series)), folded(runs_table(subject), 12, "runs"),
            f"{more} more runs are in the tables." if more > 0 else None,
            folded(parameters_table(subject), 12, "parameters differ from the shipped ones") or "Every parameter is as shipped.",
            folded(compared, 12, "runs below each other"), *as_tables(samples)]
