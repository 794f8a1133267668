"""Loads of hull, boom joints, cylinders and sections, a value per revolution each."""
import pandas

from report.formats import Table, in_unit, scaled
from report.names import in_words
from report.over_time import time_unit
from report.pictures import CURVES, Picture
from report.series import BAND, Series, time_of_work

MOST_POINTS = 200
MOST_OPEN = 2  # pictures; the others are folded


def loads_of(subject):
    """Rows of neighbouring turns together: name and unit of the channel, turns, least, middle, greatest, x."""
    if "turn_loads" not in subject.database.tables():
        return pandas.DataFrame({"name": []})
    together = max(1, -(-subject.total("turns") // MOST_POINTS))
    rows = subject.frame(
        "channels.name, coalesce(channels.unit, '') AS unit, count(*) AS turns, "
        "min(turn_loads.minimum) AS least, avg(mean) AS middle, max(turn_loads.maximum) AS greatest, min(stamp_ns) AS stamp_ns "
        "FROM turn_loads JOIN turns USING(run_id, turn) JOIN channels USING(run_id, channel) WHERE {runs} AND "
        f"turn_loads.minimum IS NOT NULL GROUP BY run_id, channel, turn / {together} ORDER BY channel, min(turn)",
        text=["name", "unit"])
    rows["x"] = time_of_work(subject, rows)
    return rows


def picture_of(group, unit, channels):
    """Channels of one kind and unit: the parts of a joint's torque, the forces of a section. channels: {name: rows}."""
    factor, shown = in_unit(unit)
    seconds, time = time_unit(max(rows.x.max() for rows in channels.values()))
    picture, keys = Picture(f"time of work [{time}]", f"load [{shown}]"), []
    for name, colour in zip(channels, CURVES):
        points = Series(channels[name].dropna(subset=["x", "middle"])).thinned(MOST_POINTS)
        picture.curve((points[BAND] * factor).assign(x=points.x / seconds), colour, len(channels))
        keys.append((f"line {colour}", name.rpartition("/")[2]))
    return picture.figure(group, keys)


def loads_table(rows):
    result = []
    for (name, unit), some in rows.groupby(["name", "unit"], sort=False):
        factor, shown = in_unit(unit)
        mean = (some.middle * some.turns).sum() / some.turns.sum()
        result.append([in_words(name), shown, *(scaled(v, factor) for v in (some.least.min(), mean, some.greatest.max())),
                       int(some.turns.sum())])
    return Table("Loads over all revolutions", ["Channel", "Unit", "Least", "Mean of revolutions", "Greatest", "Turns"], result)


def groups_of(rows):
    """{name: rows} of each picture, that of the joint with the largest range first."""
    groups, reach = {}, {}
    for (name, unit), some in rows.groupby(["name", "unit"], sort=False):
        kind = (name.rpartition("/")[0] or name, unit)
        groups.setdefault(kind, {})[name] = some
        if name.startswith("joint_loads/") and unit == "N m":
            reach[kind] = max(reach.get(kind, 0.0), some.greatest.max() - some.least.min())
    for kind in sorted(groups, key=lambda kind: kind != max(reach, key=reach.get, default=None)):
        names = list(groups[kind])
        for at in range(0, len(names), len(CURVES)):
            yield kind, {name: groups[kind][name] for name in names[at:at + len(CURVES)]}


def boom_loads(subject):
    rows = loads_of(subject)
    if not len(rows):
        return None
    pictures = [picture_of(*kind, channels) for kind, channels in groups_of(rows)]
    return {"table": loads_table(rows), "open": pictures[:MOST_OPEN], "folded": pictures[MOST_OPEN:],
            "sections": any(rows.name.str.startswith("section_loads/"))}
