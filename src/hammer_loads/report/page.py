"""The page as a whole: one file that needs no other and no network."""
import pathlib

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from report.blocks import Table
from report.boom_health import boom_health
from report.budget import budget
from report.check import check_rows, sensor_health, verdict
from report.comparison import comparison, runs_compared
from report.conditions import limits, misuse, reference
from report.costs import costs
from report.cycle_figures import cycle_figures
from report.database import FLEET, LEDGER, RECORDING
from report.formats import shown, utc
from report.ledger import ledger_blocks
from report.loads import boom_loads, turn_pictures
from report.over_time import MOST_POINTS, over_time
from report.overview import overview, warnings_list
from report.pictures import with_own_ids
from report.quantities import QUANTITIES
from report.series import series_of
from report.subjects import mixed_machines, stem, subjects_of

TEMPLATES = pathlib.Path(__file__).resolve().parent / "templates"
MOST_IN_FULL = 4  # machines; beyond, the page compares them and no more


def rendered(template, **content):
    """Bytes of a template of this package. Whatever comes from a database is escaped."""
    templates = Environment(loader=FileSystemLoader(str(TEMPLATES)), autoescape=True, finalize=shown,
                            undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return with_own_ids(templates.get_template(template).render(**content)).encode("utf-8")


def machine(subject, series, most_points):
    """Content of one machine's section."""
    turns, channels, measured = turn_pictures(subject), subject.counted_channels(), reference(subject)
    rows = check_rows(subject) if subject.database.kind == RECORDING and subject.runs else None
    version = subject.runs[0]["version"] if subject.runs else None
    samples = [table for _, table in turns]
    return {
        "label": subject.label, "verdict": rows and verdict(rows),
        "recorded": f"Recorded {utc(subject.first_ns)} to {utc(subject.last_ns)} (UTC); hammer_loads {version}.",
        "top": [[picture for picture, _ in turns] or "The file holds no samples of a revolution.",
                rows and Table("Check of the recording", ["Check", "Status", "Finding", "What to do"], rows, "words")],
        "sections": [
            ("overview", "Who, when, which parameters", overview(subject, series, runs_compared(subject, series), samples)),
            ("work", "Work over time", over_time(series, most_points)),
            ("loads", "Hull, boom joints and sections", boom_loads(subject)),
            ("health", "Is the boom sound?", boom_health(subject)),
            ("misuse", "Misuse", misuse(subject)),
            ("limits", "Limits", limits(subject)),
            *([("reference", "Measured reference", measured)] if measured else []),
            ("cycles", "Load cycles", cycle_figures(channels)),
            ("costs", "Which blows cost what", costs(subject, channels)),
            ("budget", "Where the uncertainty comes from", budget(subject)),
            ("sensor", "Is the sensor sound?", sensor_health(subject))]}


def distinct_labels(subjects):
    seen = {}
    for subject in subjects:
        seen[subject.label] = seen.get(subject.label, 0) + 1
        if seen[subject.label] > 1:
            subject.label += f" ({seen[subject.label]})"


def page(databases, version, only_machine=None):
    """The page's bytes: the same for the same files."""
    subjects = [s for database in databases for s in subjects_of(database, only_machine)]
    if all(d.kind != FLEET for d in databases):  # labels of a fleet are the names of its machines
        distinct_labels(subjects)
    series = {s.label: {q.key: series_of(s, q) for q in QUANTITIES} for s in subjects}
    in_full = subjects if len(subjects) <= MOST_IN_FULL else []
    return rendered(
        "page.html", version=version,
        title=f"{subjects[0].label}, {utc(subjects[0].first_ns)[:10]}" if len(subjects) == 1 else None,
        warnings=warnings_list(subjects, mixed_machines(subjects)), whole=len(in_full) == len(subjects),
        compared=comparison(subjects, series) if len(subjects) > 1 else None,
        machines=[machine(s, series[s.label], MOST_POINTS // len(subjects)) for s in in_full],
        ledgers=[(stem(d.path), ledger_blocks(d)) for d in databases if d.kind == LEDGER])
