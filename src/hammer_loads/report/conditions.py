"""Misuse, exceeded limits, and the computed load beside a measured one."""
from report.blocks import Note, Table
from report.formats import NOTHING, in_unit, measured, moment, number

UNKNOWN = "not known"
MISUSE = [
    ("blank_firings", "Blank firing", "the rocker went through where the tool should have been",
     "the database is of an older version"),
    ("blows_without_hold_down", "Blows without hold-down force", "the rock did not press on the hull since the blow before: a blow "
     "on the retainer, or too small a hold-down force", "needs cylinder pressures"),
    ("still_time", "Hammering at one place [s]", "beyond 15 s without the hull moving by 20 mm: no penetration",
     "needs the boom's joints and its description"),
]
LEVELS = {1: "WARN", 2: "ERROR"}


def counter(subject, name):
    """(count, per hour) over the runs that know it; (None, None) where none does."""
    known = [run for run in subject.runs if run[name] is not None]
    if not known:
        return None, None
    count, hours = sum(run[name] for run in known), sum(run["duration"] or 0.0 for run in known) / 3600.0
    return count, count / hours if hours > 0.0 else None


def misuse(subject):
    rows = []
    for name, title, meaning, missing in MISUSE:
        count, per_hour = counter(subject, name)
        if count is None:
            rows.append([title, UNKNOWN, NOTHING, missing])
            continue
        if name == "blows_without_hold_down":
            judged = sum(run["judged_blows"] or 0 for run in subject.runs if run[name] is not None)
            meaning += f"; of {number(judged)} blows whose hold-down force was measured"
        rows.append([title, number(count), number(per_hour, 3), meaning])
    return [Table("Misuse", ["What", "Count", "Per hour", "Meaning"], rows, "words figures-first"),
            Note("Per hour of work. What nothing measures is not known, which is not zero.")]


def exceeded(subject):
    """(name, level, alarm farthest beyond the limit, all of its alarms) of each limit."""
    rows = subject.frame("name, level, unit, value, value_std, limit_value, since_ns, turns FROM alarms WHERE {runs}",
                         text=["name", "unit"])
    for (name, level), alarms in rows.groupby(["name", "level"]):
        farthest = alarms.loc[(alarms.value - alarms.limit_value).abs().idxmax()]
        yield name, LEVELS.get(level, f"level {level}"), farthest, alarms


def limit_lines(subject):
    """One line for each limit that was exceeded."""
    return [f"limit exceeded ({level}): {name} {measured(at.value, at.value_std)} {at.unit}, limit {number(at.limit_value)} "
            f"{at.unit}, in {number(int(alarms.turns.sum()))} revolutions"
            for name, level, at, alarms in sorted(exceeded(subject), key=lambda found: (-found[2].level, found[0]))]


def limits(subject):
    """Exceeded limits by name and level."""
    if subject.frame("key FROM parameters WHERE {runs} AND key LIKE 'limit\\_%' ESCAPE '\\' LIMIT 1", text=["key"]).empty:
        return ["No limits were given (limits_file)."]
    rows = [[name, level, f"{number(at.limit_value)} {at.unit}", f"{measured(at.value, at.value_std)} {at.unit}",
             number(int(alarms.turns.sum())), number(len(alarms)), moment(alarms.since_ns.min())]
            for name, level, at, alarms in exceeded(subject)]
    if not rows:
        return [Note("No limit was exceeded.", "good")]
    header = ["Limit", "Level", "Limit value", "Farthest beyond it", "Revolutions", "Times", "First"]
    return [Table("Limits exceeded", header, rows, "words figures-first"),
            Note("Judged once a revolution. The value farthest beyond the limit, \u00b1 its standard deviation where that is known.")]


def reference(subject):
    """Comparison over all runs with a measured load; nothing where none has."""
    cells = []
    rows = subject.frame("component, unit, samples, rms, rms_error, bias, scale, correlation, within_two_std FROM reference "
                         "WHERE {runs} ORDER BY component", text=["component", "unit"])
    for row in rows.itertuples():
        factor, unit = in_unit(row.unit)
        cells.append([row.component, str(row.run + 1), number(int(row.samples)), f"{number(factor * row.rms)} {unit}",
                      f"{number(factor * row.rms_error, 3)} {unit}", f"{number(100.0 * row.rms_error / row.rms, 2)} %",
                      f"{number(factor * row.bias, 3)} {unit}", number(row.scale), number(row.correlation, 5),
                      f"{number(100.0 * row.within_two_std, 3)} %"])
    header = ["Component", "Run", "Samples", "Measured, rms", "Error, rms", "Error, relative", "Bias", "Scale", "Correlation",
              "Within two"]
    return cells and [
        Table("Computed and measured load", header, cells),
        Note("Computed load less the measured one at the stamps of the measured one, blows left out. Scale: slope of the computed "
             "load over the measured one. Within two: errors within two of the stated standard deviations.")]
