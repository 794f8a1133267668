"""The boom's oil and vibration as its sensors show them: air, worn pins and cracks come as a change over months."""
import math

from report.blocks import CURVES, Note, Table
from report.database import FLEET
from report.formats import NOTHING, measured, number
from report.pictures import COLOURS, Picture
from report.quantities import CYLINDERS

CHANGED = 3.0  # deviations: once in three hundred comparisons by chance
MOST = 0.5     # of a run's turns

OF_RUNS = ("cylinder, stiffness_ratio AS stiffness, stiffness_ratio_std AS deviation, doubtful FROM run_cylinders "
           "WHERE {runs} ORDER BY cylinder")
MODES = ("SELECT mode, count(*), min(frequency), avg(frequency), max(frequency), avg(damping_ratio), "
         "avg(damping_ratio_std) FROM boom_modes WHERE run_id = ? GROUP BY mode ORDER BY mode")


def cylinders_of(subject):
    """(name, rows of its runs in the order of time)."""
    rows = subject.frame(OF_RUNS if subject.database.kind == FLEET else CYLINDERS, text=["cylinder"])
    return list(rows.dropna(subset=["stiffness"]).fillna(0.0).groupby("cylinder"))


def verdict(runs):
    """Comparison of the last run with the first."""
    first, last = runs.iloc[0], runs.iloc[-1]
    if max(first.doubtful, last.doubtful) > MOST:
        return "uncertain: something else than oil damps the boom"
    if len(runs) < 2:
        return "one run: nothing to compare"
    if abs(last.stiffness - first.stiffness) <= CHANGED * math.hypot(first.deviation, last.deviation):
        return "as before"
    return "softer" if last.stiffness < first.stiffness else "stiffer"


def cylinder_table(found):
    rows = []
    for name, runs in found:
        first, last = runs.iloc[0], runs.iloc[-1]
        compared = len(runs) > 1 and first.stiffness
        change = f"{100.0 * (last.stiffness / first.stiffness - 1.0):+.1f} %" if compared else NOTHING
        rows.append([name, measured(first.stiffness, first.deviation), measured(last.stiffness, last.deviation), change,
                     len(runs), verdict(runs)])
    return Table("Stiffness of the oil over that of the boom file, mean of a run",
                 ["Cylinder", "First run", "Last run", "Change", "Runs", "Verdict"], rows, "words figures-first")


def mode_table(subject):
    """Modes of the last run alone: frequencies depend on the pose."""
    if subject.database.kind == FLEET or not subject.runs:
        return None
    rows = [[f"{mode}", f"{number(least, 3)} to {number(most, 3)}", number(mean, 3), measured(damping, deviation), turns]
            for mode, turns, least, mean, most, damping, deviation in
            subject.database.rows(MODES, subject.runs[-1]["run_id"])]
    return Table("Modes of the last run, over its poses", ["Mode", "Frequency [Hz]", "Mean [Hz]", "Damping ratio", "Turns"],
                 rows) if rows else None


def stiffness_picture(found):
    """A point a run with its standard deviation; none where no cylinder has two runs."""
    drawn = [(colour, name, runs) for colour, (name, runs) in zip(CURVES, found) if len(runs) > 1]
    if not drawn:
        return None
    picture = Picture("run", "stiffness over the boom file's")
    for colour, _, runs in drawn:
        place = runs.run.astype(float) + 1.0
        picture.line(place, runs.stiffness, colour, marker="o", markersize=4.0)
        picture.axes.vlines(place, runs.stiffness - runs.deviation, runs.stiffness + runs.deviation, color=COLOURS[colour])
    picture.axes.margins(x=0.05)
    return [picture.figure("Stiffness of the oil by run, \u00b1 one standard deviation",
                           [(f"line {colour}", name) for colour, name, _ in drawn])]


def boom_health(subject):
    found = cylinders_of(subject)
    if not found:
        return ["Not known: it needs boom_stiffness: identified, a boom file and hull_imu or cylinder_pressures."]
    return [Note("Every blow is an impulse that is known: how the boom swings after it shows its oil. The ratio does not "
                 "depend on the pose; an error of the boom file's masses is the same in every run."),
            cylinder_table(found), mode_table(subject), stiffness_picture(found)]
