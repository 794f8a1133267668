"""The typical and the worst revolution: force, its deviation, the half-sine pulse."""
import numpy

from report.formats import Table, number, utc
from report.pictures import Picture

KINDS = [("typical", "Typical revolution"), ("worst", "Worst revolution")]
FORCES = ["force_x", "force_z", "force_z_std"]
MOST_ROWS = 20
KEYS = [("line first", "along the tool, Fz"), ("band first", "\u00b1 one standard deviation"),
        ("line third", "half-sine pulse"), ("line second", "across, Fx")]


def trace_of(subject, kind):
    """Samples of the run with the strongest (worst) or the most turns (typical); none where there is none."""
    rows = subject.frame("turn, time, force_x, force_z, force_z_std, torque_y FROM traces "
                         "WHERE {runs} AND kind = ? ORDER BY place", kind)
    peaks = rows.force_z.abs().groupby(rows.run).max().dropna()
    if not len(peaks):
        return rows[:0]
    rank = peaks if kind == "worst" else peaks.index.map(lambda run: subject.runs[run]["turns"])
    return rows[rows.run == peaks.index[int(numpy.argmax(rank))]]


def half_sine(pulse, period, count=200):
    """(times, forces) of the pulse model."""
    times = numpy.linspace(0.0, period, count)
    since = times - pulse["start"]
    return times, numpy.where(since >= 0.0, pulse["amplitude"] * numpy.sin(pulse["angular_frequency"] * since), 0.0)


def force_picture(rows, pulse, caption):
    picture = Picture("time since the blow before [ms]", "force on the hull [kN]")
    times, force_z, deviation = rows.time * 1e3, rows.force_z * 1e-3, rows.force_z_std * 1e-3
    picture.band(times, force_z - deviation, force_z + deviation, "first")
    picture.line(times, rows.force_x * 1e-3, "second", linewidth=1.2)
    period = (pulse or {}).get("period") or rows.time.max()
    if pulse and None not in (pulse["amplitude"], pulse["angular_frequency"], pulse["start"]):
        at, force = half_sine(pulse, period)
        picture.line(at * 1e3, force * 1e-3, "third", linestyle="--")
    picture.line(times, force_z, "first")
    picture.axes.set_xlim(0.0, period * 1e3 or 1.0)
    return picture.figure(caption, KEYS)


def turn_table(title, rows):
    some = rows[::max(1, len(rows) // MOST_ROWS)]
    shown = zip(some.time * 1e3, *(some[name] * 1e-3 for name in (*FORCES, "torque_y")))
    return Table(f"Samples of the {title.lower()}", ["Time [ms]", "Fx [kN]", "Fz [kN]", "deviation of Fz [kN]", "moment [kN m]"],
                 [list(row) for row in shown])


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
            found = subject.database.records("SELECT * FROM turns WHERE run_id = ? AND turn = ?", run["run_id"], turn)
            pulse = found[0] if found else None
            result.append((force_picture(rows, pulse, caption_of(title, turn, pulse)), turn_table(title, rows)))
    return result
