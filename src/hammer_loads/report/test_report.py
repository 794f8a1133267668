"""A test report, and its command: one page with results, their uncertainty, inputs, checks and method."""
import tempfile

from report import output
from report.budget import budget_of
from report.command import Parser, add_bag_options, databases, guarded, package_version
from report.database import RECORDING, Database
from report.formats import NOTHING, Table, duration, in_unit, is_nothing, number, places_of, scaled, utc
from report.names import in_words
from report.overview import warnings_of
from report.page import rendered
from report.problem import Problem
from report.sensor_health import DOUBTFUL, health_rows, refusals_of
from report.subjects import subjects_of

COVERAGE = 2   # k of the expanded uncertainty: some 95 % of a normal distribution (JCGM 100, 6.3.3)
NOT_GIVEN = {"rod_stiffness_N_m", "rod_damping_ratio", "pin_play_m"}  # where the files have 0 or nothing
LISTED = 0.01  # of the variance of a measurand: a source that makes more is an input quantity


def rounded(value, uncertainty):
    """Value and uncertainty, rounded to the second digit of the uncertainty (JCGM 100, 7.2.6)."""
    if is_nothing(value) or is_nothing(uncertainty) or not uncertainty > 0.0:
        return number(value), number(uncertainty)
    places = places_of(uncertainty)
    return tuple(f"{round(x, places):.{max(places, 0)}f}" for x in (value, uncertainty))


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


def inputs(subject, figures):
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
    figures = budget_of(subject)
    if not figures:
        raise Problem(f"{subject.database.path}: holds no budget; it has no whole revolution, or is of an older process_bag --db")
    checks = [row for row in health_rows(subject) if row[2]]
    return rendered(
        "test_report.html", version=version, label=subject.label, site=site, run=subject.runs[0], first=utc(subject.first_ns),
        last=utc(subject.last_ns), work=duration(subject.total("duration")), turns=subject.total("turns"),
        blows=subject.total("blows"), results=results(figures), inputs=inputs(subject, figures),
        checks=Table("The crank's sensor", ["Check", "Found", "Verdict"], [row[:3] for row in checks], "words"),
        refusals=refusals_of(subject),
        reservations=[*warnings_of(subject), *(f"{name}: {found}, {verdict} ({meaning})"
                                               for name, found, verdict, meaning in checks if verdict == DOUBTFUL)])


def parser():
    result = Parser(
        prog="test_report",
        description="A test report of one recording: results with their uncertainty, inputs, checks, method.",
        epilog="One page of A4; the same bags, parameters and version give the same bytes. Words and rules are those of "
               "JCGM 100:2008. Errors are one line each; exit code 1, or 2 for wrong usage.")
    result.add_argument("files", nargs="+", metavar="FILE",
                        help="bags of one machine, or a database of process_bag --db; splits of one recording count as one")
    result.add_argument("--html", required=True, metavar="OUT.html", help="page to write, which must not exist")
    result.add_argument("--machine", metavar="NAME", help="of a file with more than one")
    result.add_argument("--site", default="", metavar="TEXT", help="place of the measurement, printed as it is")
    result.add_argument("--force", action="store_true", help="replace a page of this package")
    add_bag_options(result)
    return result


def the_subject(paths, machine):
    found = [s for path in paths for s in subjects_of(Database(path), machine) if s.database.kind == RECORDING]
    if len(found) != 1:
        raise Problem(f"a test report is of one machine's recording, not of {len(found)}"
                      + (": " + ", ".join(s.label for s in found) if found else ""))
    return found[0]


def run(given):
    output.check_file(given.html, given.files, given.force, output.why_page_must_stay)
    with tempfile.TemporaryDirectory(prefix="hammer_loads_test_report") as folder:
        content = test_report(the_subject(databases(given, folder), given.machine), package_version(),
                              given.site)
    output.publish_file(given.html, content, given.force)
    print(f"{given.html}: {len(content) / 1e3:.0f} kB")


def main(arguments):
    """Exit code."""
    options = parser()
    return guarded(run, options.parse_args(arguments), options)
