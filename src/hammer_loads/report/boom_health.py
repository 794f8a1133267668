"""The boom's oil and vibration as its sensors show them: air, worn pins and cracks come as a change over months."""
from collections import namedtuple
import math

from report.markup import Raw, measured, number, paragraph, table
from report.series import Segments

CHANGED = 3.0  # deviations: once in three hundred comparisons by chance
MOST = 0.5     # of a run's turns

# Means of a run: stiffness over that of the boom file, its deviation, share of turns whose damping no oil makes.
OfRun = namedtuple("OfRun", "stamp_ns turns stiffness deviation doubtful")
OF_TURNS = ("SELECT cylinder, count(*) AS turns, avg(stiffness_ratio) AS stiffness, avg(stiffness_ratio_deviation) AS "
            "deviation, avg(doubtful) AS doubtful FROM boom_cylinders WHERE run_id = ? GROUP BY cylinder ORDER BY cylinder")
OF_RUNS = ("SELECT cylinder, turns, stiffness_ratio AS stiffness, stiffness_ratio_deviation AS deviation, doubtful "
           "FROM run_cylinders WHERE run_id = ? ORDER BY cylinder")
MODES = ("SELECT mode, count(*), min(frequency_Hz), avg(frequency_Hz), max(frequency_Hz), avg(damping_ratio), "
         "avg(damping_ratio_deviation) FROM boom_modes WHERE run_id = ? GROUP BY mode ORDER BY mode")


def cylinders_of(subject):
    """Figures of its runs in the order of time, by cylinder."""
    tables = subject.database.tables()
    sql = OF_RUNS if "run_cylinders" in tables else OF_TURNS if "boom_cylinders" in tables else None
    found = {}
    for run, row in subject.of_runs(sql) if sql else []:
        if row["stiffness"] is not None:
            found.setdefault(row["cylinder"], []).append(
                OfRun(run["first_stamp_ns"], row["turns"], row["stiffness"], row["deviation"], row["doubtful"]))
    return found


def verdict(runs):
    """Of the last run against the first."""
    first, last = runs[0], runs[-1]
    if max(first.doubtful, last.doubtful) > MOST:
        return "doubtful: something else than oil damps the boom"
    if len(runs) < 2:
        return "one run: nothing to compare"
    spread = math.hypot(first.deviation or 0.0, last.deviation or 0.0)
    if abs(last.stiffness - first.stiffness) <= CHANGED * spread:
        return "as before"
    return "softer" if last.stiffness < first.stiffness else "stiffer"


def cylinder_table(found):
    rows = []
    for name, runs in sorted(found.items()):
        first, last = runs[0], runs[-1]
        change = 100.0 * (last.stiffness / first.stiffness - 1.0) if len(runs) > 1 and first.stiffness else None
        rows.append([name, measured(first.stiffness, first.deviation), measured(last.stiffness, last.deviation),
                     "\u2013" if change is None else f"{change:+.1f} %", len(runs), verdict(runs)])
    return table("Stiffness of the oil over that of the boom file, mean of a run",
                 ["Cylinder", "First run", "Last run", "Change", "Runs", "Verdict"], rows, kind="words figures-first")


def mode_table(subject):
    """Of the last run: frequencies depend on the pose."""
    if "boom_modes" not in subject.database.tables() or not subject.runs:
        return ""
    rows = [[f"{mode}", f"{number(least, 3)} to {number(most, 3)}", number(mean, 3), measured(damping, deviation),
             turns] for mode, turns, least, mean, most, damping, deviation in
            subject.database.rows(MODES, subject.runs[-1]["run_id"])]
    return table("Modes of the last run, over its poses", ["Mode", "Frequency [Hz]", "Mean [Hz]", "Damping ratio", "Turns"],
                 rows) if rows else ""


def chart_of(runs, subject):
    """A point a run; a line between them: what it shows changes slowly."""
    segments = Segments()
    segments.begin_run()
    for run in runs:
        spread = run.deviation or 0.0
        segments.add_band(((run.stamp_ns or 0) - (subject.first_ns or 0)) * 1e-9, run.stiffness - spread, run.stiffness,
                          run.stiffness + spread)
    return segments


def boom_health(subject, charts, most):
    found = cylinders_of(subject)
    if not found:
        return paragraph("Not known: it needs boom_stiffness: identified, a boom file and hull_imu or cylinder_pressures.")
    content = paragraph("Every blow is an impulse that is known: how the boom swings after it shows its oil. The ratio does "
                        "not depend on the pose; what the boom file has wrong of masses is the same in every run.", "note")
    content += cylinder_table(found) + mode_table(subject)
    for name, runs in sorted(found.items()):
        if len(runs) > 1:
            content += charts.over_time(f"{name}: stiffness over the boom file's", "", chart_of(runs, subject).thinned(most),
                                        subject.first_ns, "health")
    return Raw(content)
