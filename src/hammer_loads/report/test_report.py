"""A test report, and its command: one page with results, their uncertainty, inputs, checks and method."""
from report import inputs, output
from report.blocks import Table
from report.budget import figures_in
from report.check import LOOK, refusals_of, sensor_rows
from report.command import Parser, package_version
from report.database import RECORDING, Problem
from report.formats import NOTHING, duration, in_unit, in_words, rounded, scaled, utc
from report.overview import warnings_of
from report.page import rendered
from report.subjects import subjects_of

COVERAGE = 2   # k of the expanded uncertainty: some 95 % of a normal distribution (JCGM 100, 6.3.3)
NOT_GIVEN = {"rod_stiffness_N_m", "rod_damping_ratio", "pin_play_m"}  # where the files have 0 or nothing
LISTED = 0.01  # of the variance of a measurand: a source that makes more is an input quantity


def results(figures):
    rows = []
    for figure in figures:
        factor, unit = in_unit(figure.unit)
        value, expanded = rounded(scaled(figure.value, factor), scaled(COVERAGE * figure.deviation, factor))
        largest = ", ".join(f"{source} {100 * share:.0f} %" for source, share in figure.shares[:2] if share >= 0.1)
        rows.append([in_words(figure.quantity), value, expanded, unit, largest])
    return Table(f"Mean of the revolutions; U = k u, k = {COVERAGE}",
                 ["Measurand", "Estimate", "U", "Unit", "Largest contributions to u\u00b2"], rows)


def deviation_key(key, keys):
    """Key of a constant's standard deviation: `_std` before the unit."""
    parts = key.split("_")
    return next((name for at in range(len(parts), 0, -1)
                 if (name := "_".join(parts[:at] + ["std"] + parts[at:])) in keys), None)


def input_quantities(subject, figures):
    """Sources of more than LISTED of the variance of any measurand, the largest share first."""
    rows = subject.frame("key, value FROM parameters WHERE {runs}", text=["key", "value"])
    parameters = dict(zip(rows.key, rows.value))
    largest = {}
    for figure in figures:
        for source, share in figure.shares:
            if share > max(LISTED, largest.get(source, ("", 0.0))[1]):
                largest[source] = (in_words(figure.quantity), share)
    listed = []
    for source, (quantity, share) in sorted(largest.items(), key=lambda item: (-item[1][1], item[0])):
        estimate = parameters.get(source, NOTHING)
        if source in NOT_GIVEN and estimate in (NOTHING, "0", "0.0"):
            estimate = "not given"
        listed.append([source, estimate, parameters.get(deviation_key(source, parameters), NOTHING),
                       f"{100 * share:.0f} % of u\u00b2 of {quantity}"])
    return Table("Estimate and standard uncertainty u in the key's unit, by the parameter files (type B); readings: type A",
                 ["Input quantity", "Estimate", "u", "Largest contribution"], listed)


def test_report(subject, version, site=""):
    """The page's bytes: the same for the same file."""
    figures, checks = figures_in(subject), [row for row in sensor_rows(subject) if row[2]]
    failed = [f"{name}: {found}, {status} ({meaning})" for name, found, status, meaning in checks if status == LOOK]
    return rendered(
        "test_report.html", version=version, label=subject.label, site=site, run=subject.runs[0], first=utc(subject.first_ns),
        last=utc(subject.last_ns), work=duration(subject.total("duration")), turns=subject.total("turns"),
        blows=subject.total("blows"), results=results(figures), inputs=input_quantities(subject, figures),
        checks=Table("The crank's sensor", ["Check", "Found", "Status"], [row[:3] for row in checks], "words"),
        refusals=refusals_of(subject), reservations=[*warnings_of(subject), *failed])


def parser():
    result = Parser(
        dict(metavar="FILE",
             help="bags of one machine, or a database of process_bag --db; splits of one recording count as one"),
        prog="test_report",
        description="A test report of one recording: results with their uncertainty, inputs, checks, method.",
        epilog="One page of A4; the same bags, parameters and version give the same bytes. Words and rules are those of "
               "JCGM 100:2008. Errors are one line each; exit code 1, or 2 for wrong usage.")
    result.add_argument("--html", required=True, metavar="OUT.html", help="page to write, which must not exist")
    result.add_argument("--machine", metavar="NAME", help="of a file with more than one")
    result.add_argument("--site", default="", metavar="TEXT", help="place of the measurement, printed as it is")
    result.add_argument("--force", action="store_true", help="replace a page of this package")
    return result


def the_subject(databases, machine):
    found = [s for database in databases for s in subjects_of(database, machine) if database.kind == RECORDING]
    if len(found) != 1:
        raise Problem(f"a test report is of one machine's recording, not of {len(found)}"
                      + (": " + ", ".join(s.label for s in found) if found else ""))
    return found[0]


def run(given, folder):
    output.check_file(given.html, given.force)
    content = test_report(the_subject(inputs.databases(given, folder), given.machine), package_version(), given.site)
    output.publish_file(given.html, content, given.force)
    print(f"{given.html}: {len(content) / 1e3:.0f} kB")
