"""The typical and the worst turn: force, its deviation, the half-sine pulse."""
import math

from report.markup import Raw, details, number, paragraph, table, utc
from report.svg import Axes, figure

MOST_POINTS = 400
KINDS = [("typical", "Typical turn"), ("worst", "Worst turn")]


def trace_of(subject, kind):
    """(run, rows) of the run with the strongest (worst) or the most turns (typical); (None, []) without any."""
    best, at_best = None, None
    for run in subject.runs:
        if "traces" not in subject.database.tables():
            break
        peak = subject.database.value("SELECT max(abs(force_z_N)) FROM traces WHERE run_id = ? AND kind = ?",
                                      run["run_id"], kind)
        rank = peak if kind == "worst" else run["turns"]
        if peak is not None and (best is None or rank > best):
            best, at_best = rank, run
    if at_best is None:
        return None, []
    return at_best, subject.database.records(
        "SELECT * FROM traces WHERE run_id = ? AND kind = ? ORDER BY place", at_best["run_id"], kind)


def half_sine(pulse, period, count=200):
    """(time, force) of the pulse model."""
    amplitude, mu, start = pulse["amplitude_N"], pulse["frequency_rad_s"], pulse["start_s"]
    if None in (amplitude, mu, start):
        return []
    times = [period * i / count for i in range(count + 1)]
    return [(t, amplitude * math.sin(mu * (t - start)) if t >= start else 0.0) for t in times]


def kept_extremes(points, most):
    """Of (time, value): least and greatest of each stretch, in their order."""
    together = max(1, math.ceil(2 * len(points) / most))
    if together < 3:
        return points
    kept = []
    for at in range(0, len(points), together):
        some = [p for p in points[at:at + together] if p[1] is not None]
        kept += sorted({min(some, key=lambda p: p[1]), max(some, key=lambda p: p[1])}) if some else []
    return kept


def force_picture(rows, pulse, title):
    points = {name: [(row["time_s"], None if row[name] is None else row[name] * 1e-3) for row in rows]
              for name in ("force_x_N", "force_z_N")}
    spread = [(r["time_s"], *(None if None in (r["force_z_N"], r["force_z_deviation_N"]) else
                              (r["force_z_N"] + sign * r["force_z_deviation_N"]) * 1e-3 for sign in (-1, 1)))
              for r in rows]
    period = (pulse or {}).get("period_s") or rows[-1]["time_s"]
    pulse_points = [(t, f * 1e-3) for t, f in half_sine(pulse, period)] if pulse else []
    values = [p[1] for some in (*points.values(), pulse_points) for p in some if p[1] is not None]
    values += [v for p in spread for v in p[1:] if v is not None] + [0.0]
    margin = 0.05 * (max(values) - min(values) or 1.0)
    to_ms = lambda some: [(p[0] * 1e3, *p[1:]) for p in some]  # noqa: E731
    axes = Axes((0.0, period * 1e3 or 1.0), (min(values) - margin, max(values) + margin), "time since the blow before [ms]",
                "force on the hull [kN]")
    axes.band(to_ms(spread), "first")
    axes.line(to_ms(kept_extremes(points["force_x_N"], MOST_POINTS)), "second")
    axes.line(to_ms(pulse_points), "pulse")
    axes.line(to_ms(kept_extremes(points["force_z_N"], MOST_POINTS)), "first")
    return axes.drawn(title)


def turn_table(rows):
    step = max(1, len(rows) // 20)
    shown = [[number(r["time_s"] * 1e3), *(number(None if r[n] is None else r[n] * 1e-3) for n in
              ("force_x_N", "force_z_N", "force_z_deviation_N", "torque_y_Nm"))] for r in rows[::step]]
    return table("Samples of the turn", ["Time [ms]", "Fx [kN]", "Fz [kN]", "deviation of Fz [kN]", "moment [kN m]"], shown)


def turn_pictures(subject):
    pictures, tables = "", ""
    for kind, title in KINDS:
        run, rows = trace_of(subject, kind)
        if not rows:
            continue
        turn = rows[0]["turn"]
        found = subject.database.records("SELECT * FROM turns WHERE run_id = ? AND turn = ?", run["run_id"], turn)
        pulse = found[0] if found else None
        caption = f"{title}, number {turn}" + (f", ends {utc(pulse['stamp_ns'])} UTC: peak "
                                               f"{number(pulse['amplitude_N'] * 1e-3)} kN, half-sine's error "
                                               f"{number(100 * pulse['half_sine_rms_error'], 2)} % rms"
                                               if pulse and pulse["amplitude_N"] is not None
                                               and pulse["half_sine_rms_error"] is not None else "")
        legend = [("line first", "along the tool, Fz"), ("band first", "one standard deviation"),
                  ("line pulse", "half-sine"), ("line second", "across, Fx")]
        pictures += figure(force_picture(rows, pulse, caption), caption, legend)
        tables += details(f"{title} as a table", turn_table(rows))
    if not pictures:
        return paragraph("The file holds no turn's samples.")
    return Raw(f'<div class="pair">{pictures}</div>\n{tables}')
