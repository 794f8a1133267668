"""A test certificate: one page that says what was measured, with which uncertainty, and how that is known."""
from report.budget import budget_of
from report.markup import duration, in_unit, number, paragraph, places_of, scaled, section, table, text, utc
from report.names import without_unit
from report.overview import warnings_of
from report.page import GENERATOR
from report.problem import Problem
from report.sensor_health import health_rows, refusals_of

COVERAGE = 2  # k of the expanded uncertainty: some 95 % of a normal distribution (JCGM 100, 6.3.3)
STYLE = """
@page { size: A4; margin: 12mm }
body { font: 9pt/1.25 sans-serif; max-width: 180mm; margin: 1em auto; color: #111; background: #fff }
h1 { font-size: 15pt; margin: 0 } h2 { font-size: 11pt; margin: .9em 0 .2em }
p { margin: .3em 0 } table { border-collapse: collapse; width: 100%; font-size: 8pt }
caption { text-align: left; font-style: italic } th, td { text-align: left; padding: 1px 6px; border-bottom: 1px solid #ccc }
td.n, th.n { text-align: right } ul.plain { columns: 2; margin: .2em 0; padding-left: 1.2em }
"""


def rounded(value, uncertainty):
    """Both with the last digit of the uncertainty's two (JCGM 100, 7.2.6)."""
    if value is None or uncertainty is None or not uncertainty > 0.0:
        return number(value), number(uncertainty)
    places = places_of(uncertainty)
    return tuple(f"{round(x, places):.{max(places, 0)}f}" for x in (value, uncertainty))


def results(figures):
    rows = []
    for figure in figures:
        factor, unit = in_unit(figure.unit)
        value, expanded = rounded(scaled(figure.value, factor), scaled(COVERAGE * figure.deviation, factor))
        largest = ", ".join(f"{source} {100 * share:.0f} %" for source, share in figure.shares[:2] if share >= 0.1)
        rows.append([without_unit(figure.quantity), value, expanded, unit, largest])
    return table(f"Mean of the turns; U = k u, k = {COVERAGE}", ["Measurand", "Estimate", "U", "Unit", "Largest contributions to u\u00b2"],
                 rows)


def deviation_key(key, keys):
    """Key of a constant's standard deviation: `_deviation` before the unit."""
    parts = key.split("_")
    return next((name for at in range(len(parts), 0, -1)
                 if (name := "_".join(parts[:at] + ["deviation"] + parts[at:])) in keys), None)


def inputs(subject):
    """Input quantities with a standard uncertainty in the parameter files: evaluations of type B."""
    parameters = {row["key"]: row["value"] for _, row in subject.of_runs("SELECT key, value FROM parameters WHERE run_id = ?")}
    rows = []
    for key in sorted(parameters):
        twin = deviation_key(key, parameters)
        if twin is not None:
            rows.append([key, parameters[key], parameters[twin]])
    half = (len(rows) + 1) // 2  # two columns side by side
    both = [left + (rows[half + at] if half + at < len(rows) else ["", "", ""]) for at, left in enumerate(rows[:half])]
    return table("In the key's unit; u by the parameter files (type B)", 2 * ["Input quantity", "Estimate", "u"], both)


def checks(subject):
    rows = [row[:3] for row in health_rows(subject) if row[2]]
    words = [f"{reason}: {count}" for reason, count in refusals_of(subject)]
    return table("", ["Check", "Found", "Verdict"], rows, numbers=False) + paragraph(
        "Samples not used: " + ("; ".join(words) if words else "none") + ".")


def warnings(subject):
    found = list(warnings_of(subject))
    if not found:
        return paragraph("None.")
    return "<ul>" + "".join(f"<li>{text(words)}</li>" for words in found) + "</ul>\n"


def identity(subject):
    run = subject.runs[0]
    return paragraph(
        f"Machine {subject.label}. Recorded {utc(subject.first_ns)} to {utc(subject.last_ns)}; "
        f"{duration(subject.total('duration_s'))} of work, {number(subject.total('turns'))} turns, {number(subject.total('blows'))} blows. "
        f"Model at level {run['level']}. Input SHA-256 {run['input_sha256'][:16]}, parameters {run['parameters_sha256'][:16]}, "
        f"hammer_loads {run['version']}, revision {run['revision'][:12]}: the same bags, parameters and revision give this "
        "page to the last byte.")


METHOD = (
    "The loads are those of the crank-rocker linkage (momentum theorem over crank, rod and rocker) at the crank's angle, speed "
    "and acceleration, which a Kalman filter estimates from its readings; a blow is measured by what it does to the crank. u is "
    "combined by the law of propagation of uncertainty (JCGM 100:2008, 5.1.2): each constant of hammer and sensor contributes "
    "its standard uncertainty times the derivative of the measurand, the same in all turns, so that the mean of many turns "
    "keeps it; readings contribute what differs from turn to turn (type A). Constants are taken as uncorrelated; a rod's length "
    "follows from the other three.")


def certificate(subject, version):
    """The page's bytes: the same for the same file."""
    figures = budget_of(subject)
    if not figures:
        raise Problem(f"{subject.database.path}: holds no budget; it has no whole turn, or is of an older process_bag --db")
    parts = [("identity", "What was measured", identity(subject)), ("results", "Results", results(figures)),
             ("inputs", "Input quantities", inputs(subject)), ("checks", "What was checked", checks(subject)),
             ("warnings", "Reservations", warnings(subject)), ("method", "Method", paragraph(METHOD))]
    content = "".join(section(*part) for part in parts)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{GENERATOR}
<title>Certificate: loads of the hammer</title>
<style>{STYLE}</style>
</head>
<body>
<h1>Certificate: loads of the hammer</h1>
{content}
<footer><p>hammer_loads {text(version)}</p></footer>
</body>
</html>
""".encode("utf-8")
