"""Checks of a recording: conditions with a status and the action, the health of the crank's sensor, and the command check."""
import json
import os
import subprocess

from report import inputs
from report.blocks import Note, Table
from report.command import Parser, Usage
from report.database import Database, Problem, one_line
from report.formats import is_nothing, number, scaled
from report.subjects import subjects_of

OK, LOOK, WRONG, UNKNOWN = "ok", "look", "wrong", "-"
# From the best to the worst.
VERDICT = {UNKNOWN: "not known", OK: "usable", LOOK: "usable, with reservations", WRONG: "do not use before the cause is removed"}

CONSISTENT = 3.0   # times the variance; a sound sensor has 0.9
JITTER_S = 1e-4    # from there on the wrench is some 0.2 % worse
REFUSED = 0.01     # of the samples
PITCH_RAD = 1.2    # as the warning of the node
BACKWARD = 3       # passages

# Keys of warnings (pipeline/warnings.cpp, ros/bag_report.cpp) by check and status.
WARNINGS = {
    "hammer file": {LOOK: ["hammer"]},
    "unit": {WRONG: ["degrees", "angle unit", "speed unit"]},
    "direction": {WRONG: ["backward"]},
    "zero": {LOOK: ["zero"], WRONG: ["zero off", "slip"]},
    "readings": {LOOK: ["count", "angle lag", "speed lag", "speed scale", "eccentricity"], WRONG: ["frozen", "crank joint"]},
    "stamps": {LOOK: ["stamps", "task", "jitter", "whole stamps", "lost messages", "publishers"]},
    "hull pitch": {LOOK: ["pitch"]},
    "joints": {LOOK: ["pitch joints", "joint states", "boom joints"]},
    "hull IMU": {LOOK: ["imu", "imu late", "imu stamps", "rock"]},
    "pressures": {LOOK: ["pressures", "pressure stamps", "pressure fit", "cylinder stiffness", "boom loads"]},
    "consistency": {WRONG: ["inconsistent before", "lost"]},
}
BY_KEY = {key: (name, status) for name, of in WARNINGS.items() for status, keys in of.items() for key in keys}
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


def worst_status(*statuses):
    return max(statuses, key=list(VERDICT).index)


def sorted_warnings(warnings):
    """{check: (status, texts)} of (key, text)."""
    found = {}
    for key, text in warnings:
        name, status = BY_KEY.get(key, OTHER)
        worst, texts = found.get(name, (OK, []))
        found[name] = worst_status(worst, status), [*texts, text]
    return found


def judged(value, limit):
    return UNKNOWN if is_nothing(value) else OK if abs(value) <= limit else LOOK


def of_blows(subject):
    """Blows against the revolutions that fit into the time of work."""
    blows, blank = subject.total("blows"), subject.total("blank_firings")
    period = subject.frame("period FROM turns WHERE {runs}").period.median()
    if not blows or is_nothing(period) or not subject.hours:
        return WRONG, "no blow was found"
    expected = 3600.0 * subject.hours / period
    text = f"{number(blows)} blows, {number(round(expected))} revolutions fit into the time of work"
    status = OK if blows > 0.8 * expected and blank < 0.1 * blows else LOOK
    return status, text + (f", {blank} blank firings" if blank else "")


def figures(subject):
    """{check: (status, finding)} by the tables."""
    database, samples, backward = subject.database, subject.total("samples"), subject.total("backward_passes")
    parameters = dict(database.rows("SELECT key, value FROM parameters WHERE key IN ('crank_zero_rad', 'hull_motion')"))
    rate = samples / (3600.0 * subject.hours) if subject.hours else None
    share = subject.total("published") / samples if samples else None
    jitter, pitch, consistency = subject.worst("timing_noise"), subject.worst("hull_pitch"), subject.worst("consistency")
    is_identified = database.value("SELECT count(*) FROM boom_modes")
    zero = parameters.get("crank_zero_rad")
    return {
        "hammer file": (OK, "given"),
        "unit": (OK, "rad and rad/s"),
        "direction": (OK if backward <= BACKWARD else WRONG, f"{backward} backward passes"),
        "zero": (OK, f"crank_zero_rad {zero}" if zero is not None else "as shipped"),
        "rate": (UNKNOWN if rate is None else OK if rate >= 190.0 else LOOK, f"{number(rate, 3)} Hz, {number(samples)} samples"),
        "readings": (judged(None if share is None else 1.0 - share, 0.1),
                     f"{number(100 * (share or 0.0), 3)} % of the samples published"),
        "stamps": (judged(jitter, JITTER_S), f"jitter {number(scaled(jitter, 1e3), 2)} ms"),
        "hull pitch": (judged(pitch, PITCH_RAD), f"{number(pitch, 3)} rad at the end"),
        "joints": (OK, "received") if not is_nothing(pitch) else (UNKNOWN, "not received"),
        "hull IMU": (OK, f"hull_motion: {parameters.get('hull_motion')}"),
        "pressures": (OK, "boom identified" if is_identified else "not needed or not used"),
        "blows": of_blows(subject),
        "consistency": (judged(consistency, CONSISTENT), f"{number(consistency, 2)} times the expected variance, 1 is right"),
    }


def check_rows(subject):
    """[name, status, finding, action] of a recording."""
    warned = sorted_warnings(subject.database.rows("SELECT key, text FROM warnings ORDER BY place"))
    rows = []
    for name, (status, finding) in figures(subject).items():
        stated, words = warned.get(name, (OK, []))
        status = worst_status(status, stated)
        remedy = REMEDY.get(name, "") if status in (LOOK, WRONG) and not words else ""
        rows.append([name, status, words[0] if words else finding, remedy])
    return rows


def verdict(rows):
    return VERDICT[worst_status(*(row[1] for row in rows))]


def refusals_of(subject):
    """(reason, samples), the most first."""
    rows = subject.frame("reason, count AS samples FROM refusals WHERE {runs}", text=["reason"])
    counts = rows.groupby("reason").samples.sum().astype(int)
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def sensor_rows(subject):
    """[figure, value, status, meaning]; no status where there is nothing to judge."""
    consistency, jitter, pitch = subject.worst("consistency"), subject.worst("timing_noise"), subject.worst("hull_pitch")
    samples, refused = subject.total("samples"), sum(count for _, count in refusals_of(subject))
    restarts, backward = subject.total("restarts"), subject.total("backward_passes")
    return [
        ["Consistency", number(consistency, 3), judged(consistency, CONSISTENT),
         "surprise over what the filter expects; 1 is right, beyond 3 sensor or hammer file are wrong"],
        ["Jitter of the stamps", f"{number(scaled(jitter, 1e3), 3)} ms", judged(jitter, JITTER_S),
         "beyond 0.1 ms the wrench is some 0.2 % worse"],
        ["Refused samples", f"{refused} of {samples}", judged(refused / samples if samples else None, REFUSED), "by reason below"],
        ["Restarts", number(restarts), judged(restarts, len(subject.runs)),
         "drop-outs, jumps, time running back; one a run is its start"],
        ["Passages backward", number(backward), judged(backward, BACKWARD),
         "more than a few: crank_direction has the wrong sign"],
        ["Hull pitch", f"{number(pitch, 3)} rad", judged(pitch, PITCH_RAD),
         "largest at the end of a run; at work beyond 1.2 rad a sign or an offset of a boom joint is wrong"],
        ["Resolution of the angle", f"{number(scaled(subject.worst('angle_resolution'), 1e3), 3)} mrad", "",
         "step between two readings"],
        ["Noise of the speed", f"{number(subject.worst('speed_noise'), 3)} rad/s", "", "where the speed is measured"],
        ["Drive inertia", f"{number(subject.worst('drive_inertia'), 3)} kg m\u00b2",
         "", f"relative deviation {number(subject.worst('drive_inertia_relative_std'), 2)}"],
    ]


def sensor_health(subject):
    if not subject.runs:
        return ["The file holds no run."]
    refusals = refusals_of(subject)
    return [Note("Of several runs the worst.") if len(subject.runs) > 1 else None,
            Table("The crank's sensor", ["Figure", "Value", "Status", "Meaning"], sensor_rows(subject), "words"),
            Table("Refused samples by reason", ["Reason", "Samples"], refusals) if refusals else "No sample was refused."]


def refused_rows(lines):
    """Rows of a recording that process_bag refused; lines: of its stderr, warnings with their keys."""
    keyed = [line.split("\t", 1) for line in lines if "\t" in line]
    rows = [[name, status, words[0], REMEDY.get(name, "")] for name, (status, words) in sorted_warnings(keyed).items()]
    if all(row[1] != WRONG for row in rows):
        problems = [one_line(line) for line in lines if "\t" not in line]
        rows.append(["recording", WRONG, problems[0] if problems else "no result", "see process_bag IN.bag"])
    return rows


def rows_of(splits, options, folder):
    database = os.path.join(folder, f"{len(os.listdir(folder))}.sqlite")
    done = inputs.process(splits, ["--keys", *options], database, stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    return refused_rows(done.stderr.splitlines()) if done.returncode else check_rows(subjects_of(Database(database))[0])


def as_text(name, rows):
    lines = [f"{name}: {verdict(rows)}"]
    for check, status, finding, action in rows:
        lines.append(f"  {status:5} {check:11} {finding}" + (f" -> {action}" if action else ""))
    return "\n".join(lines)


def as_json(found):
    return json.dumps({"recordings": [
        {"recording": name, "verdict": verdict(rows),
         "checks": [dict(zip(("check", "status", "finding", "action"), row)) for row in rows]} for name, rows in found]}, indent=2)


def run(given, folder):
    if others := [name for name in given.files if not inputs.is_bag(name)]:
        raise Usage(f"{others[0]}: must be a bag")
    found = [(splits[0], rows_of(splits, inputs.bag_options(given), folder)) for splits in inputs.recordings(given.files)]
    print(as_json(found) if given.json else "\n".join(as_text(name, rows) for name, rows in found))
    if wrong := [name for name, rows in found if any(row[1] == WRONG for row in rows)]:
        raise Problem(f"{', '.join(wrong)}: do not use before the cause is removed")


def parser():
    result = Parser(
        dict(metavar="IN.bag", help="bags; splits of one recording count as one"),
        prog="check", description="Whether recordings can be used: a line for each thing that must be right, and what to do.",
        epilog="Status: ok, look (usable, read the line), wrong (do not use), - (not known). Exit code 1 where a line is wrong.")
    result.add_argument("--json", action="store_true", help="print JSON")
    return result
