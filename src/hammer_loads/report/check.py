"""Check of a recording: a line for each condition, with ok, look or wrong, and the action."""
import json
import os
import subprocess
import tempfile

from report import bags
from report.command import FAILURE, Parser, add_bag_options, bag_options, guarded
from report.database import Database
from report.formats import Table, is_nothing, number
from report.problem import Problem, one_line
from report.sensor_health import CONSISTENT, JITTER_S, PITCH_RAD, worst_of, worst_pitch
from report.subjects import subjects_of

OK, LOOK, WRONG, UNKNOWN = "ok", "look", "wrong", "-"
ORDER = (UNKNOWN, OK, LOOK, WRONG)
VERDICT = {OK: "usable", LOOK: "usable, with reservations", WRONG: "do not use before the cause is removed", UNKNOWN: "not known"}

# Check and status by the key of a warning (pipeline/warnings.cpp, ros/bag_warnings.cpp).
WARNINGS = {
    "hammer": ("hammer file", LOOK),
    "degrees": ("unit", WRONG), "angle unit": ("unit", WRONG), "speed unit": ("unit", WRONG),
    "backward": ("direction", WRONG),
    "zero": ("zero", LOOK), "zero off": ("zero", WRONG), "slip": ("zero", WRONG),
    "frozen": ("readings", WRONG), "crank joint": ("readings", WRONG), "count": ("readings", LOOK), "angle lag": ("readings", LOOK),
    "speed lag": ("readings", LOOK), "speed scale": ("readings", LOOK), "eccentricity": ("readings", LOOK),
    "stamps": ("stamps", LOOK), "task": ("stamps", LOOK), "jitter": ("stamps", LOOK), "whole stamps": ("stamps", LOOK),
    "lost messages": ("stamps", LOOK), "publishers": ("stamps", LOOK),
    "pitch": ("hull pitch", LOOK),
    "pitch joints": ("joints", LOOK), "joint states": ("joints", LOOK), "boom joints": ("joints", LOOK),
    "imu": ("hull IMU", LOOK), "imu stamps": ("hull IMU", LOOK), "rock": ("hull IMU", LOOK),
    "pressures": ("pressures", LOOK), "pressure stamps": ("pressures", LOOK), "pressure fit": ("pressures", LOOK),
    "cylinder stiffness": ("pressures", LOOK),
    "inconsistent before": ("consistency", WRONG), "lost": ("consistency", WRONG),
}
OTHER = ("consistency", LOOK)
REMEDY = {
    "unit": "publish the angle in rad and the speed in rad/s",
    "direction": "set crank_direction to the other sign",
    "rate": "sample the crank with 200 Hz or more",
    "stamps": "stamp samples at the instant of the measurement; state a constant delay as crank_latency_s",
    "hull pitch": "check pitch_signs and pitch_offset_rad with the tool upright",
    "blows": "record a minute of work; check crank_zero_rad if the hammer worked",
    "consistency": "check the hammer file and crank_zero_rad; run calibrate",
}


def sorted_warnings(warnings):
    """{check: (status, texts)} of (key, text)."""
    found = {}
    for key, text in warnings:
        name, status = WARNINGS.get(key, OTHER)
        worst, before = found.get(name, (OK, []))
        found[name] = (max(worst, status, key=ORDER.index), before + [text])
    return found


def parameter(subject, key):
    rows = list(subject.database.rows("SELECT value FROM parameters WHERE key = ? LIMIT 1", key))
    return rows[0][0] if rows else None


def judged(value, limit):
    return UNKNOWN if is_nothing(value) else OK if value <= limit else LOOK


def of_blows(subject):
    """Blows against the revolutions that fit into the time of work."""
    blows, hours = subject.total("blows"), subject.hours
    rows = subject.frame("period FROM turns WHERE {runs}")
    if not blows or rows.period.dropna().empty or not hours:
        return WRONG, "no blow was found"
    expected = 3600.0 * hours / rows.period.median()
    blank = subject.total("blank_firings")
    text = f"{number(blows)} blows, {number(round(expected))} revolutions fit into the time of work"
    return (OK if blows > 0.8 * expected and blank < 0.1 * blows else LOOK), text + (f", {blank} blank firings" if blank else "")


def figures(subject):
    """{check: (status, finding)} by the tables."""
    seconds, samples = 3600.0 * subject.hours, subject.total("samples")
    rate = samples / seconds if seconds else None
    jitter, pitch, consistency = worst_of(subject, "timing_noise"), worst_pitch(subject), worst_of(subject, "consistency")
    zero, share = parameter(subject, "crank_zero_rad"), subject.total("published") / samples if samples else None
    tables = subject.database.tables()
    return {
        "hammer file": (OK, "given"),
        "unit": (OK, "rad and rad/s"),
        "direction": (OK if subject.total("backward_passes") <= 3 else WRONG, f"{subject.total('backward_passes')} backward passes"),
        "zero": (OK, f"crank_zero_rad {zero}" if zero is not None else "as shipped"),
        "rate": (UNKNOWN if rate is None else OK if rate >= 190.0 else LOOK, f"{number(rate, 3)} Hz, {number(samples)} samples"),
        "readings": (judged(None if share is None else 1.0 - share, 0.1), f"{number(100 * (share or 0.0), 3)} % of the samples published"),
        "stamps": (judged(jitter, JITTER_S), f"jitter {number(None if is_nothing(jitter) else 1e3 * jitter, 2)} ms"),
        "hull pitch": (judged(None if is_nothing(pitch) else abs(pitch), PITCH_RAD), f"{number(pitch, 3)} rad at the end"),
        "joints": (OK, "received") if not is_nothing(pitch) else (UNKNOWN, "not received"),
        "hull IMU": (OK, f"hull_motion: {parameter(subject, 'hull_motion')}"),
        "pressures": (OK, "boom identified" if "boom_modes" in tables and subject.database.value(
            "SELECT count(*) FROM boom_modes") else "not needed or not used"),
        "blows": of_blows(subject),
        "consistency": (judged(consistency, CONSISTENT), f"{number(consistency, 2)} times the expected variance, 1 is right"),
    }


def check_rows(subject):
    """[name, status, finding, action] of a recording."""
    warned = sorted_warnings(subject.database.rows("SELECT key, text FROM warnings ORDER BY place"))
    rows = []
    for name, (status, finding) in figures(subject).items():
        said, words = warned.get(name, (OK, []))
        status = max(status, said, key=ORDER.index)
        rows.append([name, status, words[0] if words else finding, REMEDY.get(name, "") if status in (LOOK, WRONG) and not words else ""])
    return rows


def refused_rows(lines):
    """Rows of a recording that process_bag refused; lines: of its stderr, warnings with their keys."""
    keyed = [line.split("\t", 1) for line in lines if "\t" in line]
    rows = [[name, status, words[0], REMEDY.get(name, "")] for name, (status, words) in sorted_warnings(keyed).items()]
    if all(row[1] != WRONG for row in rows):
        problems = [one_line(line) for line in lines if "\t" not in line]
        rows.append(["recording", WRONG, problems[0] if problems else "no result", "see process_bag IN.bag"])
    return rows


def verdict(rows):
    worst = max((row[1] for row in rows), key=ORDER.index)
    return VERDICT[worst]


def check_section(subject):
    """For the top of a machine's page."""
    rows = check_rows(subject)
    return {"verdict": verdict(rows), "table": Table("Check of the recording", ["Check", "Status", "Finding", "What to do"], rows, "words")}


def rows_of(splits, options, folder):
    database = os.path.join(folder, f"{len(os.listdir(folder))}.sqlite")
    done = bags.process(splits, ["--keys", *options], database, stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    return refused_rows(done.stderr.splitlines()) if done.returncode else check_rows(subjects_of(Database(database))[0])


def as_text(name, rows):
    lines = [f"{name}: {verdict(rows)}"]
    for check, status, finding, action in rows:
        lines.append(f"  {status:5} {check:11} {finding}" + (f" -> {action}" if action else ""))
    return "\n".join(lines)


def run(given):
    found, options = [], bag_options(given)
    with tempfile.TemporaryDirectory(prefix="hammer_loads_check") as folder:
        for splits in bags.recordings(given.files):
            found.append((splits[0], rows_of(splits, options, folder)))
    if given.json:
        print(json.dumps({"recordings": [
            {"recording": name, "verdict": verdict(rows),
             "checks": [dict(zip(("check", "status", "finding", "action"), row)) for row in rows]} for name, rows in found]}, indent=2))
    else:
        print("\n".join(as_text(name, rows) for name, rows in found))
    wrong = [name for name, rows in found if any(row[1] == WRONG for row in rows)]
    if wrong:
        raise Problem(f"{', '.join(wrong)}: do not use before the cause is removed")


def parser():
    result = Parser(
        prog="check", description="Whether recordings can be used: a line for each thing that must be right, and what to do.",
        epilog="Status: ok, look (usable, read the line), wrong (do not use), - (not known). Exit code 1 where a line is wrong.")
    result.add_argument("files", nargs="+", metavar="IN.bag", help="bags; splits of one recording count as one")
    result.add_argument("--json", action="store_true", help="print JSON")
    add_bag_options(result)
    return result


def main(arguments):
    """Exit code."""
    options = parser()
    given = options.parse_args(arguments)
    if others := [name for name in given.files if not bags.is_bag(name)]:
        options.error(f"{others[0]}: must be a bag")
    return guarded(run, given, options)
