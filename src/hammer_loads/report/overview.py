"""Who, when and with which parameters; and what to know first."""
from report.markup import Raw, details, duration, measured, moment, number, paragraph, table, text
from report.names import recording_of
from report.quantities import QUANTITIES

MOST_RUNS_SHOWN = 50
MOST_FAILED_SHOWN = 10


def warnings_of(subject):
    """{words: numbers of its runs}, most important first, those of several runs once."""
    found = {}
    for at, run in enumerate(subject.runs, 1):
        for row in subject.database.records("SELECT text FROM warnings WHERE run_id = ? ORDER BY place", run["run_id"]):
            found.setdefault(row["text"], []).append(at)
    if not subject.runs:
        found["no run at all: the recording holds no sample of a crank"] = []
    elif subject.total("turns") == 0:
        found["no whole turn: there is nothing about blows, pulses and turns"] = []
    impossible = subject.impossible_blows()
    if impossible:
        found[f"blows whose energy and restitution cannot be: {impossible} of {subject.total('blows')}; they are in no "
              "picture and no figure"] = []
    return found


def failed_lines(subject):
    failed = subject.failed_bags()
    lines = [f"bag {bag}: {reason}" for bag, reason in failed[:MOST_FAILED_SHOWN]]
    if len(failed) > MOST_FAILED_SHOWN:
        lines.append(f"{len(failed) - MOST_FAILED_SHOWN} more bags gave nothing")
    return lines


def warnings_list(subjects, mixed):
    """Of all subjects; bags that gave nothing on the last lines."""
    lines = [f"<li>{text(line)}</li>" for line in mixed]
    of = {id(s): f"<strong>{text(s.label)}</strong>: " if len(subjects) > 1 else "" for s in subjects}
    for subject in subjects:
        for words, runs in warnings_of(subject).items():
            where = f" (runs {', '.join(map(str, runs[:10]))}{' ...' if len(runs) > 10 else ''})" if len(
                subject.runs) > 1 and runs else ""
            lines.append(f"<li>{of[id(subject)]}{text(words)}{where}</li>")
    lines += [f"<li>{of[id(s)]}{text(line)}</li>" for s in subjects for line in failed_lines(s)]
    if not lines:
        return paragraph("No warnings.", "good")
    return "<ul class=\"warnings\">\n" + "\n".join(lines) + "\n</ul>\n"


def energy_text(joules):
    for factor, unit in ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ")):
        if joules >= factor:
            return f"{number(joules / factor)} {unit}"
    return f"{number(joules)} J"


def total_energy(subject, segments):
    """[J] over all blows with a value; None where there is none."""
    energies = segments["energy_J"]
    if not len(energies):
        return None
    if not energies.of_runs:
        return sum(energies.middles())
    return sum(subject.database.value("SELECT total FROM run_figures WHERE run_id = ? AND quantity = 'energy_J'",
                                      run["run_id"]) or 0.0 for run in subject.runs)


def blows_per_hour(subject):
    return subject.total("blows") / subject.hours if subject.hours > 0.0 else None


def with_spread(values):
    """Median and standard deviation of the measurement; where that is not known the spread from blow to blow."""
    return measured(values.statistics()[2], values.deviation if values.deviation is not None else values.spread())


def key_figures(subject, segments):
    """Medians over the turns, as large numbers."""
    energy, rate = total_energy(subject, segments), blows_per_hour(subject)
    figures = [("at work", duration(subject.total("duration_s"))), ("blows", number(subject.total("blows")))]
    if rate is not None:
        figures.append(("blows per hour of work", number(round(rate))))
    if energy is not None:
        figures.append(("energy of all blows", energy_text(energy)))
    for quantity in QUANTITIES:
        values = segments[quantity.key]
        if len(values):
            kind = "deviation" if values.deviation is not None else "spread"
            figures.append((f"{quantity.title.lower()}, median \u00b1 {kind}",
                            f"{with_spread(values)} {quantity.unit}".strip()))
    items = "".join(f"<div><dt>{text(name)}</dt><dd>{text(value)}</dd></div>" for name, value in figures)
    return f'<dl class="figures">{items}</dl>\n'


def runs_table(subject):
    shown, names = subject.runs[:MOST_RUNS_SHOWN], recording_of(subject)
    rows = [[str(at), names[run["run_id"]], moment(run["first_stamp_ns"]), moment(run["last_stamp_ns"]),
             duration(run["duration_s"]), number(run["turns"]), number(run["blows"]), run["level"] or "\u2013",
             f"{run['version']} ({run['revision'][:10]})"] for at, run in enumerate(shown, 1)]
    header = ["Run", "Recording", "From (UTC)", "To (UTC)", "At work", "Turns", "Blows", "Level", "Program"]
    content = table("Runs", header, rows, numbers=False)
    if len(shown) < len(subject.runs):
        content += paragraph(f"{len(subject.runs) - len(shown)} more runs are in the tables.")
    return content if len(shown) <= 12 else details(f"{len(subject.runs)} runs", content)


def changed_parameters(subject):
    """(key, value, shipped, runs), each combination once."""
    found = {}
    for at, run in enumerate(subject.runs, 1):
        for row in subject.database.records(
                "SELECT key, value, shipped FROM parameters WHERE run_id = ? AND value IS NOT shipped ORDER BY key",
                run["run_id"]):
            found.setdefault((row["key"], row["value"], row["shipped"]), []).append(at)
    return sorted(((*changed, runs) for changed, runs in found.items()), key=lambda row: tuple(map(str, row[:3])))


def parameters_table(subject):
    rows = [[key, value if value is not None else "\u2013", shipped if shipped is not None else "none"]
            for key, value, shipped, _ in changed_parameters(subject)]
    if not rows:
        return paragraph("Every parameter is as shipped.")
    content = table("Parameters that differ from the shipped ones", ["Parameter", "In force", "Shipped"], rows,
                    numbers=False)
    return content if len(rows) <= 12 else details(f"{len(rows)} parameters differ from the shipped ones", content)


def overview(subject, segments):
    if not subject.runs:
        return paragraph("The file holds no run.")
    return Raw(key_figures(subject, segments) + runs_table(subject) + parameters_table(subject))
