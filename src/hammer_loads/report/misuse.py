"""Work that wears the hammer without breaking rock, as far as it was measured."""
from report.formats import NOTHING, Table, number

UNKNOWN = "not known"
COUNTERS = [
    ("blank_firings", "Blank firing", "the rocker went through where the tool should have been",
     "the database is of an older version"),
    ("blows_without_hold_down", "Blows without hold-down force", "the rock did not press on the hull since the blow before: a blow "
     "on the retainer, or too small a hold-down force", "needs cylinder pressures"),
    ("still_time", "Hammering at one place [s]", "beyond 15 s without the hull moving by 20 mm: no penetration",
     "needs the boom's joints and its description"),
]


def counter(subject, name):
    """(count, per hour) over the runs that know it; (None, None) where none does."""
    known = [run for run in subject.runs if run.get(name) is not None]
    if not known:
        return None, None
    count, hours = sum(run[name] for run in known), sum(run["duration"] or 0.0 for run in known) / 3600.0
    return count, count / hours if hours > 0.0 else None


def misuse(subject):
    rows = []
    for name, title, meaning, missing in COUNTERS:
        count, per_hour = counter(subject, name)
        if count is None:
            rows.append([title, UNKNOWN, NOTHING, missing])
            continue
        if name == "blows_without_hold_down":
            judged = sum(run["judged_blows"] or 0 for run in subject.runs if run.get(name) is not None)
            meaning += f"; of {number(judged)} blows whose hold-down force was measured"
        rows.append([title, number(count), number(per_hour, 3), meaning])
    return Table("Misuse", ["What", "Count", "Per hour", "Meaning"], rows, "words figures-first")
