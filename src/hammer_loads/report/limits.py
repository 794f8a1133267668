"""Limits that the machine exceeded, and those that it kept."""
from report.formats import NOTHING, Table, measured, moment, number

LEVELS = {1: "WARN", 2: "ERROR"}
OTHER_LEVEL = "level {}"


def alarms(subject):
    """{(name, level): rows of the table alarms}, most severe first."""
    if "alarms" not in subject.database.tables() or not subject.runs:
        return {}
    rows = subject.frame("name, level, unit, value, value_std, limit_value, since_ns, turns FROM alarms WHERE {runs}",
                         text=["name", "unit"])
    return {key: group for key, group in rows.groupby(["name", "level"])}


def farthest(group):
    return group.loc[(group.value - group.limit_value).abs().idxmax()]


def given(subject):
    """Returns True if any parameter of any run is a limit."""
    return not subject.frame("key FROM parameters WHERE {runs} AND key LIKE 'limit\\_%' ESCAPE '\\' LIMIT 1",
                             text=["key"]).empty


def lines(subject):
    """One line for each limit that was exceeded."""
    return [f"limit exceeded ({LEVELS.get(level, OTHER_LEVEL.format(level))}): {name} {measured(at.value, at.value_std)} "
            f"{at.unit}, limit {number(at.limit_value)} {at.unit}, in {number(int(group.turns.sum()))} revolutions"
            for (name, level), group in sorted(alarms(subject).items(), key=lambda item: (-item[0][1], item[0][0]))
            for at in [farthest(group)]]


def limits(subject):
    """Exceeded limits by name and level; None where no limit was given."""
    if "alarms" not in subject.database.tables() or not given(subject):
        return None
    rows = []
    for (name, level), group in alarms(subject).items():
        at = farthest(group)
        rows.append([name, LEVELS.get(level, OTHER_LEVEL.format(level)), f"{number(at.limit_value)} {at.unit}",
                     f"{measured(at.value, at.value_std)} {at.unit}", number(int(group.turns.sum())),
                     number(len(group)), moment(group.since_ns.min()) if len(group) else NOTHING])
    return Table("Limits exceeded", ["Limit", "Level", "Limit value", "Farthest beyond it", "Revolutions", "Times", "First"],
                 rows, "words figures-first")
