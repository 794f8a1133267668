"""Who, when and with which parameters; and what to know first."""
from report.markup import Raw, details, duration, number, paragraph, table, text, utc
from report.quantities import QUANTITIES

MOST_RUNS_SHOWN = 50
MOST_FAILED_SHOWN = 10


def warnings_of(subject):
    """{words: numbers of its runs}, most important first, those of several runs once."""
    found = {}
    for at, run in enumerate(subject.runs, 1):
        for row in subject.database.records("SELECT text FROM warnings WHERE run_id = ? ORDER BY place", run["run_id"]):
            found.setdefault(row["text"], []).append(at)
    failed = subject.failed_bags()
    for bag, reason in failed[:MOST_FAILED_SHOWN]:
        found[f"bag {bag}: {reason}"] = []
    if len(failed) > MOST_FAILED_SHOWN:
        found[f"{len(failed) - MOST_FAILED_SHOWN} more bags gave nothing"] = []
    if not subject.runs:
        found["no run at all: the recording holds no sample of a crank"] = []
    elif subject.total("turns") == 0:
        found["no whole turn: there is nothing about blows, pulses and turns"] = []
    return found


def warnings_list(subjects, mixed):
    lines = [f"<li>{text(line)}</li>" for line in mixed]
    for subject in subjects:
        name = f"<strong>{text(subject.label)}</strong>: " if len(subjects) > 1 else ""
        for words, runs in warnings_of(subject).items():
            where = f" (runs {', '.join(map(str, runs[:10]))}{' ...' if len(runs) > 10 else ''})" if len(
                subject.runs) > 1 and runs else ""
            lines.append(f"<li>{name}{text(words)}{where}</li>")
    if not lines:
        return paragraph("No warnings.", "good")
    return "<ul class=\"warnings\">\n" + "\n".join(lines) + "\n</ul>\n"


def key_figures(subject, segments):
    """Medians over the turns, as large numbers."""
    figures = [("at work", duration(subject.total("duration_s"))), ("blows", number(subject.total("blows")))]
    for quantity in QUANTITIES:
        middle = segments[quantity.key].statistics()[2]
        if middle is not None:
            figures.append((quantity.title.lower() + ", median", f"{number(middle, 3)} {quantity.unit}".strip()))
    items = "".join(f"<div><dt>{text(name)}</dt><dd>{text(value)}</dd></div>" for name, value in figures)
    return f'<dl class="figures">{items}</dl>\n'


def runs_table(subject):
    shown = subject.runs[:MOST_RUNS_SHOWN]
    rows = [[str(at), utc(run["first_stamp_ns"]), utc(run["last_stamp_ns"]), duration(run["duration_s"]), run["turns"],
             run["blows"], run["level"] or "\u2013", f"{run['version']} ({run['revision'][:10]})", run["machine"][:12],
             run["input_sha256"][:12]] for at, run in enumerate(shown, 1)]
    header = ["Run", "From (UTC)", "To (UTC)", "At work", "Turns", "Blows", "Level", "Program", "Machine", "Recording"]
    content = table("Runs; machine and recording by the beginning of their hashes", header, rows, numbers=False)
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
