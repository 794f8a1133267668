#!/usr/bin/env python3
"""doc/accuracy.md, doc/blow.png and the README's excerpt from `accuracy` and the recorded sessions' test."""
import argparse
import json
import pathlib
import platform

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

SIDE_BY_SIDE = [("clean", "clean"), ("typical", "typical"), ("typical, after calibrate", "typical, after `calibrate`")]
SESSION_HEAD = "rms Fx | rms Fz | rms torque | peak, worst turn | turn impulse | blow instant | energy |"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def draw_blow(blow, path):
    """Force z around a blow: the truth and the levels' results, with bands of two deviations."""
    figure, axes = plt.subplots(figsize=(9.5, 5.0), dpi=110)
    most = 0.0
    for level, color, marker in (("linkage", "#d1602b", "s"), ("elastic", "#1f5fa8", "o")):
        time, force, deviation = (blow[level][key] for key in ("time_ms", "force_z", "deviation_N"))
        low, high = ([(f + sign * 2.0 * d) / 1e3 for f, d in zip(force, deviation)] for sign in (-1, 1))
        most = max(most, max(high), -min(low))
        axes.fill_between(time, low, high, color=color, alpha=0.18, linewidth=0, label=f"{level}: two deviations")
        axes.plot(time, [f / 1e3 for f in force], marker, color=color, markersize=3.5, label=f"{level}: published")
    axes.plot(blow["truth"]["time_ms"], [f / 1e3 for f in blow["truth"]["force_z"]], color="#202020", linewidth=1.0,
              label="truth")
    axes.set(xlabel="time from the first touch of the tool [ms]", ylabel="force z on the hull [kN]",
             ylim=(-1.05 * most, 1.05 * most), xlim=(blow["truth"]["time_ms"][0], blow["truth"]["time_ms"][-1]))
    axes.grid(axis="y", color="#ececec")
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(frameon=False, fontsize=9, ncol=5, loc="upper center", bbox_to_anchor=(0.5, -0.12), columnspacing=1.2)
    figure.tight_layout()
    figure.savefig(path)


def recorded_table(recorded):
    shipped = [line for line in recorded.strip().splitlines() if " 0 % |" in line]
    lines = ["Recorded sessions with clean sensors (`test/data`), as shipped, from 3 s after the start to 3 s before",
             "the end; root-mean-square errors are of the peak of each quantity, all others the worst of all revolutions:",
             "", f"| session | drive inertia wrong by | {SESSION_HEAD}", "|---" * 9 + "|"] + shipped
    return "\n".join(lines) + "\n"


def machines_excerpt(machines):
    """Clean and typical side by side; Fz over its peak."""
    rows = {(row["machine"], row["rate_hz"]): row for row in machines}

    def line(text, rate, value):
        return f"| {text} | " + " | ".join(value(rows[name, rate]) for name, _ in SIDE_BY_SIDE) + " |"

    lines = ["| | " + " | ".join(title for _, title in SIDE_BY_SIDE) + " |", "|---" * (len(SIDE_BY_SIDE) + 1) + "|"]
    rate = 1000
    lines += [line(f"error of Fz, rms of the peak, {rate} Hz", rate, lambda row: f"{100 * row['rms_z']:.2f} %"),
              line("worst sample", rate, lambda row: f"{100 * row['worst_z']:.1f} %"),
              line("errors within two standard deviations", rate, lambda row: f"{100 * row['covered_z']:.0f} %"),
              line("instant of the blow, worst", rate, lambda row: f"{1e3 * row['blow_time_s']:.2f} ms"),
              line("blows missed, false", rate, lambda row: f"{row['missed_blows']}, {row['false_blows']}")]
    return "\n".join(lines) + "\n"


LIFE = [("oil as in the file", "none", "oil as in the boom file, no sensor on the boom"),
        ("bulk modulus 30 % lower", "none", "oil 30 % softer, no sensor on the boom"),
        ("bulk modulus 30 % lower", "IMU", "oil 30 % softer, IMU"),
        ("bulk modulus 30 % lower", "both", "oil 30 % softer, IMU and cylinder pressures"),
        ("pressed on rock, crank typical", "both", "pressed on rock, typical crank sensor, IMU and cylinder pressures")]


def life_excerpt(boom):
    """Rows by which fatigue is judged."""
    rows = {(row["machine"], row["sensors"]): row for row in boom}
    lines = ["| machine | force on the hull | joint torque | bending |", "|---|---|---|---|"]
    lines += ["| " + text + " | " + " | ".join(f"{100 * rows[machine, sensors][key]['error']:+.1f} %"
                                               for key in ("life_force", "life_torque", "life_section")) + " |"
              for machine, sensors, text in LIFE]
    return "\n".join(lines) + "\n"


BUDGETED = [("blow/energy", "energy of a blow", 1.0, "J"),
            ("pulse/turn_impulse_z", "impulse of a revolution, z", 1.0, "N s"),
            ("equivalent_range_3/hull_wrench/force_z", "damage-equivalent load of Fz, slope 3", 1e-3, "kN")]


def budget_excerpt(machine):
    """Uncertainty budget of a recording's figures."""
    figures = {figure["quantity"]: figure for figure in machine["figures"]}
    lines = ["| result | value | standard deviation | standard deviation with the largest source halved | largest parts of the variance |", "|---|---|---|---|---|"]
    for quantity, text, factor, unit in BUDGETED:
        figure = figures[quantity]
        of_unit = [f"{factor * figure[key]:.{digits}g} {unit}"
                   for key, digits in (("value", 4), ("std", 2), ("std_with_largest_halved", 2))]
        sources = ", ".join(f"`{one['source']}` {100 * one['share']:.0f} %" for one in figure["sources"][:3])
        lines.append(f"| {text} | " + " | ".join(of_unit) + f" | {sources} |")
    return "\n".join(lines) + "\n"


def replace(path, marker, text):
    """Text between <!-- marker --> and <!-- /marker -->."""
    begin, end = f"<!-- {marker} -->\n", f"<!-- /{marker} -->"
    head, rest = path.read_text().split(begin)
    path.write_text(head + begin + text + end + rest.split(end)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("work", type=pathlib.Path, help="directory with sessions(.json) and budget.json, perhaps recorded")
    parser.add_argument("root", type=pathlib.Path, help="of the source")
    arguments = parser.parse_args()
    work, root = arguments.work, arguments.root
    figures = json.loads((work / "sessions.json").read_text())
    replace(root / "doc" / "accuracy.md", "sessions", (work / "sessions").read_text())
    replace(root / "README.md", "machines", machines_excerpt(figures["machines"]))
    replace(root / "doc" / "accuracy.md", "life", life_excerpt(figures["boom"]))
    draw_blow(figures["blow"], root / "doc" / "blow.png")
    machine, = json.loads((work / "budget.json").read_text())["machines"]
    replace(root / "doc" / "accuracy.md", "budget", budget_excerpt(machine))
    if (work / "recorded").exists():
        replace(root / "doc" / "accuracy.md", "recorded", recorded_table((work / "recorded").read_text()))


if __name__ == "__main__":
    main()
