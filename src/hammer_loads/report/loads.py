"""Pictures of loads: the typical and the worst revolution; hull, boom joints, cylinders and sections by revolution."""
import numpy

from report.blocks import CURVES, Details, Note, Table, folded
from report.formats import in_unit, in_words, number, utc
from report.over_time import curves_picture
from report.pictures import Picture
from report.series import BAND, Series, time_of_work

KINDS = [("typical", "Typical revolution"), ("worst", "Worst revolution")]
FORCES = ["force_x", "force_z", "force_z_std", "torque_y"]
MOST_ROWS = 20
KEYS = [("line first", "along the tool, Fz"), ("band first", "\u00b1 one standard deviation"),
        ("line third", "half-sine pulse"), ("line second", "across, Fx")]
MOST_POINTS = 200
MOST_OPEN = 2  # pictures of channels; the others are folded


def trace_of(subject, kind):
    """Samples of the run with the strongest (worst) or the most turns (typical); none where there is none."""
    rows = subject.frame("turn, time, force_x, force_z, force_z_std, torque_y FROM traces "
                         "WHERE {runs} AND kind = ? ORDER BY place", kind)
    peaks = rows.force_z.abs().groupby(rows.run).max().dropna()
    if not len(peaks):
        return rows[:0]
    rank = peaks if kind == "worst" else peaks.index.map(lambda run: subject.runs[run]["turns"])
    return rows[rows.run == peaks.index[int(numpy.argmax(rank))]]


def force_picture(rows, pulse, caption):
    """pulse: row of the table turns, None where there is none."""
    picture = Picture("time since the blow before [ms]", "force on the hull [kN]")
    times, force_z, deviation = rows.time * 1e3, rows.force_z * 1e-3, rows.force_z_std * 1e-3
    picture.band(times, force_z - deviation, force_z + deviation, "first")
    picture.line(times, rows.force_x * 1e-3, "second", linewidth=1.2)
    period = (pulse or {}).get("period") or rows.time.max()
    if pulse and None not in (pulse["amplitude"], pulse["angular_frequency"], pulse["start"]):
        at = numpy.linspace(0.0, period, 200)
        half_sine = pulse["amplitude"] * numpy.sin(pulse["angular_frequency"] * (at - pulse["start"]))
        picture.line(at * 1e3, numpy.where(at >= pulse["start"], half_sine, 0.0) * 1e-3, "third", linestyle="--")
    picture.line(times, force_z, "first")
    picture.axes.set_xlim(0.0, period * 1e3 or 1.0)
    return picture.figure(caption, KEYS)


def turn_table(title, rows):
    some = rows[::max(1, len(rows) // MOST_ROWS)]
    cells = (some[["time", *FORCES]] * [1e3, *([1e-3] * len(FORCES))]).values.tolist()
    return Table(f"Samples of the {title.lower()}", ["Time [ms]", "Fx [kN]", "Fz [kN]", "deviation of Fz [kN]", "moment [kN m]"],
                 cells)


def caption_of(title, turn, pulse):
    caption = f"{title}, number {turn}"
    if not pulse or None in (pulse["amplitude"], pulse["half_sine_rms_error"]):
        return caption
    return (f"{caption}, ends {utc(pulse['stamp_ns'])} UTC: peak {number(pulse['amplitude'] * 1e-3)} kN along the tool, "
            f"half-sine's error {number(100 * pulse['half_sine_rms_error'], 2)} % rms")


def turn_pictures(subject):
    """(picture, table) of each kind that the file holds."""
    result = []
    for kind, title in KINDS if "traces" in subject.database.tables() else []:
        rows = trace_of(subject, kind)
        if len(rows):
            run, turn = subject.runs[rows.run.iloc[0]], int(rows.turn.iloc[0])
            pulse = next(iter(subject.database.records("SELECT * FROM turns WHERE run_id = ? AND turn = ?", run["run_id"], turn)),
                         None)
            result.append((force_picture(rows, pulse, caption_of(title, turn, pulse)), turn_table(title, rows)))
    return result


def loads_of(subject):
    """Rows of neighbouring turns together, in the unit shown: name and unit of the channel, turns, least, middle, greatest, x."""
    together = max(1, -(-subject.total("turns") // MOST_POINTS))
    rows = subject.frame(
        "channels.name, coalesce(channels.unit, '') AS unit, count(*) AS turns, "
        "min(turn_loads.minimum) AS least, avg(mean) AS middle, max(turn_loads.maximum) AS greatest, min(stamp_ns) AS stamp_ns "
        "FROM turn_loads JOIN turns USING(run_id, turn) JOIN channels USING(run_id, channel) WHERE {runs} AND "
        f"turn_loads.minimum IS NOT NULL GROUP BY run_id, channel, turn / {together} ORDER BY channel, min(turn)",
        text=["name", "unit"])
    shown = rows.unit.map(in_unit)
    rows[BAND] = rows[BAND].mul(shown.str[0], axis="index")
    return rows.assign(unit=shown.str[1], x=time_of_work(subject, rows))


def picture_of(group, unit, channels):
    """Channels of one kind and unit: the parts of a joint's torque, the forces of a section. channels: {name: rows}."""
    curves = [(name.rpartition("/")[2], Series(rows.dropna(subset=["x", "middle"]))) for name, rows in channels.items()]
    return curves_picture(group, f"load [{unit}]", curves, MOST_POINTS)


def loads_table(rows):
    result = []
    for (name, unit), some in rows.groupby(["name", "unit"], sort=False):
        mean = (some.middle * some.turns).sum() / some.turns.sum()
        result.append([in_words(name), unit, some.least.min(), mean, some.greatest.max(), int(some.turns.sum())])
    return Table("Loads over all revolutions", ["Channel", "Unit", "Least", "Mean of revolutions", "Greatest", "Turns"], result)


def groups_of(rows):
    """{name: rows} of each picture, that of the joint with the largest range first."""
    groups, reach = {}, {}
    for (name, unit), some in rows.groupby(["name", "unit"], sort=False):
        kind = (name.rpartition("/")[0] or name, unit)
        groups.setdefault(kind, {})[name] = some
        if name.startswith("joint_loads/") and unit == "kN m":
            reach[kind] = max(reach.get(kind, 0.0), some.greatest.max() - some.least.min())
    for kind in sorted(groups, key=lambda kind: kind != max(reach, key=reach.get, default=None)):
        names = list(groups[kind])
        for at in range(0, len(names), len(CURVES)):
            yield kind, {name: groups[kind][name] for name in names[at:at + len(CURVES)]}


def boom_loads(subject):
    rows = loads_of(subject) if "turn_loads" in subject.database.tables() else ()
    if not len(rows):
        return ["The file holds no loads per revolution."]
    pictures = [picture_of(*kind, channels) for kind, channels in groups_of(rows)]
    more = pictures[MOST_OPEN:]
    return [Note("Line: mean of the revolutions; band: least and greatest within them, kept where revolutions are put together."),
            pictures[:MOST_OPEN], Details(f"Pictures of {len(more)} more groups of channels", [more]) if more else None,
            folded(loads_table(rows), 8, "channels as a table"),
            None if any(rows.name.str.startswith("section_loads/")) else
            "No sections: the boom file names none, or there was no robot description."]
