"""The page as a whole: one file that needs no other and no network."""
import pathlib

from report.boom_health import boom_health
from report.boom_loads import boom_loads
from report.budget import budget
from report.charts import Charts
from report.comparison import comparison, runs_compared
from report.costs import costs
from report.cycle_figures import cycle_figures
from report.database import LEDGER
from report.ledger_section import ledger_content
from report.misuse import misuse
from report.names import stem
from report.markup import paragraph, section, text
from report.over_time import MOST_POINTS, over_time
from report.overview import overview, warnings_list
from report.problem import Problem
from report.quantities import QUANTITIES
from report.sensor_health import sensor_health
from report.subjects import subjects_of
from report.turn_pictures import turn_pictures

HERE = pathlib.Path(__file__).resolve().parent
# Beside this folder where it is installed, else at the top of the source.
DYGRAPHS = next((place for place in (up / "third_party" / "dygraphs" for up in (HERE.parent, HERE.parent.parent.parent))
                 if place.is_dir()), HERE.parent / "third_party" / "dygraphs")
GENERATOR = '<meta name="generator" content="hammer_loads report">'
MOST_IN_FULL = 4  # machines; beyond, the page compares them and no more


def file_text(path):
    try:
        return pathlib.Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise Problem(f"{path}: cannot be read: {error.strerror}")


def why_page_must_stay(name):
    """A page of this package may be replaced."""
    try:
        with open(name, "rb") as file:
            return None if GENERATOR.encode() in file.read(2000) else "it is no page of this command"
    except OSError as error:
        return error.strerror


def mixed_machines(databases, subjects):
    """Lines for files with more than one machine: their cycles are never added."""
    lines = []
    for database in databases:
        count = sum(s.database is database for s in subjects)
        if count > 1 and database.kind == "recording":
            lines.append(f"{stem(database.path)}: holds {count} machines (hammer, boom or their parameters differ); "
                         "each stands alone")
    return lines


def notes(databases):
    """What a user of the command must know of the files, one line each."""
    subjects = [s for database in databases for s in subjects_of(database)]
    lines = mixed_machines(databases, subjects)
    return lines + [f"{s.label}: {'no whole turn' if s.runs else 'no run at all'}" for s in subjects
                    if not s.total("turns")]


def subject_section(at, subject, segments, charts, most_points):
    name = f"m{at}"
    channels = subject.counted_channels()
    parts = [("overview", "Who, when, which parameters", overview(subject, segments) + runs_compared(subject, segments)),
             ("work", "Work over time", over_time(subject, segments, charts, name, most_points)),
             ("turns", "Typical and worst turn", turn_pictures(subject)),
             ("loads", "Hull, boom joints and sections", boom_loads(subject, charts)),
             ("health", "Is the boom sound?", boom_health(subject, charts, most_points)),
             ("misuse", "Misuse", misuse(subject)),
             ("cycles", "Load cycles", cycle_figures(channels)),
             ("costs", "Which blows cost what", costs(subject, channels)),
             ("budget", "Where the uncertainty comes from", budget(subject)),
             ("sensor", "Is the sensor sound?", sensor_health(subject))]
    content = "".join(section(f"{name}-{key}", title, part, 3) for key, title, part in parts)
    return section(name, subject.label, content)


def distinct_labels(subjects):
    seen = {}
    for subject in subjects:
        seen[subject.label] = seen.get(subject.label, 0) + 1
        if seen[subject.label] > 1:
            subject.label += f" ({seen[subject.label]})"


def page(databases, version, only_machine=None):
    """The page's bytes: the same for the same files."""
    style = file_text(HERE / "page.css")
    script = file_text(HERE / "page.js")
    dygraphs = file_text(DYGRAPHS / "dygraph.min.js")
    dygraphs_style = file_text(DYGRAPHS / "dygraph.min.css")
    subjects = [s for database in databases for s in subjects_of(database, only_machine)]
    if all(d.kind != "fleet" for d in databases):
        distinct_labels(subjects)
    charts = Charts()
    segments = {s.label: {q.key: s.segments(q) for q in QUANTITIES} for s in subjects}
    sections = [("warnings", "Warnings", warnings_list(subjects, mixed_machines(databases, subjects)))]
    if len(subjects) > 1:
        sections.append(("compared", "Machines compared", comparison(subjects, segments, charts)))
    content = "".join(section(*entry) for entry in sections)
    links = [(name, title) for name, title, _ in sections]
    if len(subjects) <= MOST_IN_FULL:
        for at, subject in enumerate(subjects, 1):
            content += subject_section(at, subject, segments[subject.label], charts, MOST_POINTS // len(subjects))
            links.append((f"m{at}", subject.label))
    else:
        content += paragraph("Each machine in full: a page of its own.")
    for at, database in enumerate([d for d in databases if d.kind == LEDGER], 1):
        title = f"Ledger {stem(database.path)}"
        content += section(f"l{at}", title, ledger_content(database))
        links.append((f"l{at}", title))
    return assembled(content, links, charts, style, script, dygraphs, dygraphs_style, version).encode("utf-8")


def assembled(content, links, charts, style, script, dygraphs, dygraphs_style, version):
    menu = "".join(f'<li><a href="#{name}">{text(title)}</a></li>' for name, title in links)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{GENERATOR}
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Loads of the hammer</title>
<link rel="icon" href="data:,">
<style>
{dygraphs_style}
{style}</style>
</head>
<body>
<a class="skip" href="#content">To the content</a>
<header>
<h1>Loads of the hammer</h1>
<nav aria-label="Parts of the page"><ul>{menu}</ul></nav>
</header>
<main id="content">
<noscript><p class="note">The charts need JavaScript; their tables and the other pictures do not.</p></noscript>
{content}</main>
<footer><p>hammer_loads {text(version)}, report. Times are UTC, beside them the reader's local time. Charts: dygraphs, MIT licence.</p></footer>
<script type="application/json" id="charts">{charts.as_json()}</script>
<script>
{dygraphs}
</script>
<script>
{script}</script>
</body>
</html>
"""
