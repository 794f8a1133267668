#!/usr/bin/env python3
"""Tables and figures of the three papers (doc/model.md: P0, P1, P4) beside what the package gives.

    examples/papers.py                        prints every table
    examples/papers.py --pictures doc         writes the figures as doc/papers_*.png as well
    examples/papers.py --documents doc        writes the tables into doc/model.md and doc/papers.md

P0 is taken at its own constant crank speed and at work with blows of 1000 J; P1 with the rocker of the MO-100; P4 by
the command grapple_table. The session in the first table is process_bag's of a simulated machine.
"""
import argparse
import csv
import io
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import hammer_loads_py as hl
import numpy as np
import papers_impact
from markdown_table import below, beside, table
from working_turn import WHOLE, Turn

SOURCE = pathlib.Path(__file__).resolve().parents[1]
SPEED, ENERGY, POSES = 31.416, 1000.0, ((-0.35, 1.2, -0.85), (-0.5, 1.0, -0.3), (0.1, 0.9, -1.4))
PITCH_JOINTS = ("boom_joint", "arm_joint", "hammer_joint")
ANGLES = np.radians([60.0, 180.0, 300.0, 350.0])


def program(name):
    """A command of the package: of the tests, beside the module, or on the path."""
    lib = pathlib.Path(hl.__file__).resolve().parents[3]
    given = os.environ.get("HAMMER_LOADS_PROGRAMS")
    for folder in (given, lib / "hammer_loads", lib.parent / "bin", lib.parents[1] / "bin"):
        if folder and (pathlib.Path(folder) / name).is_file():
            return str(pathlib.Path(folder) / name)
    found = shutil.which(name)
    if not found:
        raise SystemExit(f"{name}: not found; source the setup file of the build (. build/devel/setup.bash)")
    return found


# P0: the hammer MO-100

def transfer(hammer, angle):
    """u and u' of P0 (4), (5): the rocker's acceleration by the crank's acceleration, and by its speed squared."""
    inertia = hammer.parameters["rocker_inertia_about_pivot_kg_m2"]
    moment = [hammer.wrenches(angle, w, e, level="rocker")["torque_y"] for w, e in ((0.0, 1.0), (1.0, 0.0))]
    return -moment[0] / inertia, -moment[1] / inertia


def inertia_forces(hammer, angle, speed):
    """P0 (1) with the right sign: along D-S, across it [N], moment about D [N m]."""
    p, (u, du) = hammer.parameters, transfer(hammer, angle)
    first = p["rocker_mass_kg"] * p["rocker_com_distance_m"]
    return first * (u * speed) ** 2, -first * du * speed ** 2, -p["rocker_inertia_about_pivot_kg_m2"] * du * speed ** 2


def printed_motion(p, phi):
    """psi, beta, u, u' as P0 (2)-(5) prints them."""
    l0, l2, l3 = (p[k + "_m"] / p["crank_length_m"] for k in ("pivot_distance", "rod_length", "rocker_length"))
    d = 1.0 + l0 ** 2 - 2.0 * l0 * np.cos(phi)
    lean = np.arctan(np.sin(phi) / (l0 - np.cos(phi)))
    psi = np.pi - lean - np.arccos((l3 ** 2 - l2 ** 2 + d) / (2.0 * l3 * np.sqrt(d)))
    beta = np.arccos((l2 ** 2 - l3 ** 2 + d) / (2.0 * l2 * np.sqrt(d))) - lean
    s, y = np.sin(phi / 2.0), np.cos(phi / 2.0)
    u = (1.0 - l0 + 2.0 * l0 * s ** 2 + (2.0 * l0 * s ** 2 + l2 * (l0 - 1.0)) * y / np.sqrt(l2 * l3 / l0 - s ** 2)) / d
    a, b = (l0 + 1.0) ** 2 / (4.0 * l0), (1.0 - l0 ** 2) / (2.0 * l0)
    c, g = l2 * (l0 - 1.0) / (2.0 * l0) + 1.0, l2 * l3 / l0 - 1.0
    root = ((g + 2.0 * (c - a)) * y ** 4 + g * (c - 3.0 * a) * y ** 2 + a * c * g) / np.sqrt((g + y ** 2) ** 3)
    return psi, beta, u, -s / (4.0 * (a - y ** 2) ** 2) * (b * y + root)


def motion_table(hammer):
    """P0 (2)-(5) beside the package: psi from the direction of the inertia force, beta from that of the rod's."""
    normal, across, _ = inertia_forces(hammer, ANGLES, SPEED)
    at = hammer.wrenches(ANGLES, SPEED, level="rocker", pins=True)
    psi = -np.angle((at["force_x"] + 1j * at["force_z"]) / (-normal + 1j * across))
    rod = np.exp(1j * np.radians(hammer.parameters["rocker_com_angle_deg"])) / -(at["R12_x"] + 1j * at["R12_z"])
    ours = [np.degrees(psi), np.degrees(np.angle(rod)), *transfer(hammer, ANGLES)]
    paper = printed_motion(hammer.parameters, ANGLES)
    paper = [np.degrees(paper[0]), np.degrees(paper[1]), *paper[2:]]
    names = ("psi [deg], (2)", "beta [deg], (3)", "u, (4)", "u', (5)")
    return table(["crank angle", *(f"{a:.0f} deg" for a in np.degrees(ANGLES)), "largest difference"],
                 [[n, *(f"{v:.6f}" for v in o), below(abs(o - q).max(), 1e-10)] for n, o, q in zip(names, ours, paper)])


def reactions(hammer, angle, speed, about_com):
    """R12, R03 normal and tangential, Rx, Ry by P0 (9)-(14) [N]; about_com: the moment about S in (8), not about D."""
    p = hammer.parameters
    psi, beta, _, du = printed_motion(p, angle)
    normal, across, moment = inertia_forces(hammer, angle, speed)
    ls, l3, alpha = p["rocker_com_distance_m"], p["rocker_length_m"], np.radians(p["rocker_com_angle_deg"])
    if about_com:
        moment = moment + p["rocker_mass_kg"] * ls ** 2 * du * speed ** 2
    sine = np.sin(psi - beta)
    tangential = moment / l3 + across * (ls / l3 - np.cos(alpha)) - normal * np.sin(alpha)
    along = (normal * np.sin(psi + alpha - beta) + across * np.cos(psi + alpha - beta)
             + tangential * np.cos(psi - beta)) / sine
    rod = (moment + across * ls) / (l3 * sine)
    return [rod, along, tangential,
            rod * np.cos(alpha - beta) - along * np.cos(psi - alpha) - tangential * np.sin(psi - alpha),
            rod * np.sin(alpha - beta) + along * np.sin(psi - alpha) - tangential * np.cos(psi - alpha)]


def reaction_table(hammer, angle=np.radians(350.0)):
    at = hammer.wrenches(angle, SPEED, level="rocker", pins=True)
    psi, beta, _, _ = printed_motion(hammer.parameters, angle)
    turn = np.radians(hammer.parameters["rocker_com_angle_deg"])
    rod = (at["R12_x"] + 1j * at["R12_z"]) * -np.exp(1j * (beta - turn))
    pivot = (at["R03_x"] + 1j * at["R03_z"]) * np.exp(1j * (psi - turn))
    ours = [rod.real, pivot.real, pivot.imag, at["force_x"], at["force_z"]]
    names = ("R12, (11)", "R03 normal, (10)", "R03 tangential, (9)", "Rx, (13)", "Ry, (14)")
    columns = zip(names, ours, reactions(hammer, angle, SPEED, False), reactions(hammer, angle, SPEED, True))
    return table(["at 350 deg [N]", "package", "P0, (8) as printed", "P0, (8) about S", "difference"],
                 [[n, f"{o:.1f}", beside(q, o), f"{r:.1f}", below(abs(r - o), 1e-6)] for n, o, q, r in columns])


def session_values(bag=SOURCE / "test" / "data" / "mo100_1khz.bag"):
    """Medians over the turns of a recorded session, as the node measures them."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "session.sqlite")
        subprocess.run([program("process_bag"), str(bag), "--no-bag", "--db", path], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        tables = hl.read_database(path)
    median = {name: float(np.nanmedian(values)) for t in ("turns", "blows") for name, values in tables[t].items()
              if values.dtype.kind == "f"}
    return {"energy": median["energy"], "speed": median["crank_speed_before"], "H": median["amplitude"],
            "S": median["impulse"], "mu": median["angular_frequency"], "t1": median["start"],
            "T": median["period"], "rest": median["half_sine_rms_error"]}


def turn_values(turn):
    """What the pulse table says of a turn."""
    speed = float(turn.speed(np.array(WHOLE - 1e-13)))
    blow, least = turn.hammer.blow(speed, level=turn.level), turn.extreme(1, -1.0)
    zeros = [z for z in turn.zeros(1) if z < turn.extreme(1, 1.0)[1]]
    pushes, pulls = turn.halves_of_x()
    return {**turn.half_sine(), "speed": speed, "energy": blow["energy"], "x+": pushes, "x-": pulls,
            "xmax": turn.extreme(0, 1.0)[0], "xmin": turn.extreme(0, -1.0)[0], "zmin": least[0],
            "z-": turn.integral(lambda a: turn.loads(a)[1], *zeros[-2:])}


def pulse_table(hammer):
    printed = {"energy": 1000.0, "speed": SPEED, "H": 39895.0, "S": 2.0 * 39895.0 / 170.0, "mu": 170.0, "t1": 0.1815,
               "T": 0.2}
    turns = [turn_values(t) for t in (Turn.at_speed(hammer, SPEED), Turn.at_energy(hammer, ENERGY))]
    slow = turn_values(Turn.at_speed(hammer, turns[1]["speed"]))
    rows = (("crank speed at the blow [rad/s]", "speed", 1.0, 3), ("energy of the blow [J]", "energy", 1.0, 0),
            ("H, peak of Fz [kN]", "H", 1e-3, 3), ("its crank angle [deg]", "angle", 180.0 / np.pi, 2),
            ("Q, impulse of the last lobe [N s]", "S", 1.0, 1), ("mu [rad/s]", "mu", 1.0, 2), ("t1 [s]", "t1", 1.0, 4),
            ("T [s]", "T", 1.0, 4), ("Fz less half-sine, rms over H", "rest", 1.0, 3),
            ("least Fz [kN]", "zmin", 1e-3, 2), ("impulse of Fz < 0 before the lobe [N s]", "z-", 1.0, 1),
            ("largest Fx [kN]", "xmax", 1e-3, 2), ("least Fx [kN]", "xmin", 1e-3, 2),
            ("impulse of Fx > 0 [N s]", "x+", 1.0, 1), ("impulse of Fx < 0 [N s]", "x-", 1.0, 1))
    columns = (printed, turns[0], turns[1], slow, session_values())
    return table(["MO-100", "printed in P0", "exact, at P0's speed", "at work, 1000 J", "P0 at the blow's speed",
                  "node, session"],
                 [[n] + [f"{c[k] * unit:.{digits}f}" if k in c else "" for c in columns]
                  for n, k, unit, digits in rows])


def pulse_errors_table(hammer):
    rows = [(n, t.errors_of_pulse()) for n, t in (("at P0's constant speed", Turn.at_speed(hammer, SPEED)),
                                                   ("at work, 1000 J, links alone", Turn.at_energy(hammer, ENERGY)))]
    return table(["level `pulse` beside `rocker`, rms over the peak", "Fx", "Fz", "moment"],
                 [[n] + [f"{v:.0%}" for v in e] for n, e in rows])


def shipped_boom():
    return hl.Boom.from_yaml(SOURCE / "urdf" / "eo2621_mo100.urdf", SOURCE / "config" / "boom_eo2621.yaml")


def boom_turn(boom, turn, pose, parts, compliant, turns=40):
    """Time since the blow and loads of the boom over the last of some turns from rest.

    parts: of Fx, Fz and moment that act on it; None: the half-sine of Fz alone, as P0 has it.
    """
    angle = np.linspace(0.0, WHOLE, 721)
    steps = [turn.integral(lambda a: 1.0 + 0.0 * a, low, high, 1) for low, high in zip(angle, angle[1:])]
    time = np.concatenate(([0.0], np.cumsum(steps)))
    if parts is None:
        s = turn.half_sine()
        sine = np.where(time > s["t1"], s["H"] * np.sin(s["mu"] * (time - s["t1"])), 0.0)
        loads = np.array([0.0 * sine, sine, 0.0 * sine])
    else:
        loads = turn.loads(np.minimum(angle, WHOLE - 1e-13)) * np.array(parts)[:, None]
    times = np.cumsum(np.tile([0.0, *steps], turns))  # a step of none at each blow: both sides of the jump
    result = boom.loads(dict(zip(PITCH_JOINTS, pose)), times, *np.tile(loads, turns), compliant=compliant)
    return time, {name: values[-len(time):] for name, values in result.items()}


def boom_ranges(boom, turn, pose, parts, compliant):
    """Largest less least load over a turn, of each pitch joint and section."""
    _, result = boom_turn(boom, turn, pose, parts, compliant)
    names = [j + "_torque_Nm" for j in PITCH_JOINTS] + [s + "_moment_y_Nm" for s in boom.sections]
    return {name: float(np.ptp(result[name])) for name in names}


def boom_table(hammer):
    boom, turn, cases = shipped_boom(), Turn.at_energy(hammer, ENERGY), ((1, 1, 1), (0, 1, 1), None)
    rows = {}
    for compliant in (False, True):
        for pose in POSES:
            ranges = [boom_ranges(boom, turn, pose, parts, compliant) for parts in cases]
            for name in ranges[0]:
                rows.setdefault((name, compliant), []).append([r[name] for r in ranges])

    def cells(values):
        """Of the pose where the load without Fx is most wrong."""
        whole, without, sine = max(values, key=lambda v: abs(v[1] / v[0] - 1.0))
        return [f"{whole / 1e3:.2f}",
                *(f"{v / 1e3:.2f} ({v / whole - 1.0:+.0%})" for v in (without, sine))]

    names = [name for name, compliant in rows if not compliant]
    return table(["range over a revolution [kN m]", "rigid: all", "without Fx", "half-sine alone", "on its oil: all",
                  "without Fx", "half-sine alone"],
                 [[re.sub("_(torque|moment_y)_Nm", "", n)] + cells(rows[n, False]) + cells(rows[n, True])
                  for n in names])


# P4: the grapple

def grapple(*options):
    return subprocess.run([program("grapple_table"), "--params", str(SOURCE / "config" / "grapple_claims.yaml"),
                           *options], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout


def grapple_path(steps=400):
    """Columns of grapple_table."""
    rows = list(csv.reader(io.StringIO(grapple("--steps", str(steps)))))
    return dict(zip(rows[0], np.array(rows[1:], float).T))


def grapple_claims(_):
    found = dict(line.split(": ") for line in grapple("--summary").splitlines())
    number = {k: float(v) for k, v in found.items() if not k.endswith("kind")}
    return table(["claim of P4", "printed", "reconstruction"], [
        ["scoop height h [mm]", "70", f"{1e3 * number['scoop_height_m']:.1f} (fitted)"],
        ["straight part of the path", "some 80 %",
         f"{100 * number['straight_share_within_1_5pct']:.0f} % within 1.5 %"],
        ["deviation from the straight line", "below 3 %", f"{100 * number['deviation_whole']:.2f} % of the whole path"],
        ["opening L [mm]", "200", f"{1e3 * number['opening_m']:.0f}: not reachable with the printed lengths"]])


BLOCKS = {"pulse": pulse_table, "pulse-level": pulse_errors_table, "boom": boom_table, "motion": motion_table,
          "reactions": reaction_table, "impact": papers_impact.impact_table, "ideal": papers_impact.ideal_table,
          "grapple": grapple_claims}


def write_documents(folder, tables):
    """Each table between its marks `<!-- papers: NAME -->` and `<!-- /papers -->`."""
    for path in (pathlib.Path(folder) / "model.md", pathlib.Path(folder) / "papers.md"):
        text = path.read_text(encoding="utf-8")
        for name, block in tables.items():
            text = re.sub(f"(<!-- papers: {name} -->\n).*?(<!-- /papers -->)",
                          lambda m, b=block: m[1] + b + "\n" + m[2], text, flags=re.S)
        path.write_text(text, encoding="utf-8")


def main(arguments=None):
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--pictures", metavar="FOLDER")
    options.add_argument("--documents", metavar="FOLDER")
    given = options.parse_args(arguments)
    hammer = hl.Hammer.from_yaml()
    tables = {name: make(hammer) for name, make in BLOCKS.items()}
    for name, text in tables.items():
        print(f"{name}\n{text}\n")
    if given.documents:
        write_documents(given.documents, tables)
    if given.pictures:
        import papers_pictures
        papers_pictures.draw(hammer, pathlib.Path(given.pictures))


if __name__ == "__main__":
    main()
