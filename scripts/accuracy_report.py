#!/usr/bin/env python3
"""doc/accuracy.md, its picture and the README's excerpts from what `accuracy` and the recorded sessions' test said."""
import argparse
import json
import math
import pathlib
import platform

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

NO_DIGITS = 10.0  # where the picture shows errors above 1 and those that are no number
COLORS = {"printed": "#8a8f98", "scalar": "#1f5fa8", "batch": "#d1602b", "crank": "#3a8f5c", "pipeline": "#7a4ca0",
          "grapple": "#b08a1e"}
ELASTIC = {"elastic, a rod that gives": ("elastic average: 1e9 N/m, 0.2", "elastic")}  # machine, level of its own
EXCERPT = [("printed", "P0 with inverse trigonometry"), ("scalar", "linkage"), ("batch", "linkage"),
           ("crank", "mechanism, linkage"), ("pipeline", "linkage"), ("pipeline", "elastic, a rod that gives")]
SIDE_BY_SIDE = [("clean", "clean"), ("typical", "typical"), ("typical, after calibrate", "typical, after `calibrate`")]
SESSION_HEAD = "rms Fx | rms Fz | rms torque | peak, worst turn | turn impulse | blow instant | energy |"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def worst(row):
    """Largest relative error over the cases; NO_DIGITS where none is left."""
    errors = [case["relative"] for case in row["errors"].values()]
    return NO_DIGITS if any(error is None or error > 1 for error in errors) else max(errors)


def picture_error(row, figures):
    """What the picture shows: the worst relative error, for pulse its model error, for steps the session's."""
    if row["name"] in ELASTIC:
        return next(e["whole"]["rms"][1] for e in figures["elastic"] if (e["machine"], e["level"]) == ELASTIC[row["name"]])
    if row["group"] in ("crank", "pipeline"):
        return next(s["rms_z"] for s in figures["sessions"]
                    if s["rate_hz"] == 1000 and s["encoder_counts"] == 4096 and s["speed_measured"])
    if row["name"] == "pulse":
        return row["errors"]["regular turn"]["of_peak"]
    if row["group"] == "grapple":
        return max(case["relative"] for name, case in row["errors"].items() if name.endswith("stroke"))
    return worst(row)


def spread(places, distance):
    """Places in ascending order moved apart to a least distance, about where they were."""
    groups = []  # [sum of wished starts, count]
    for i, place in enumerate(places):
        groups.append([place, 1])
        while len(groups) > 1 and middle(groups[-2], distance) + distance > first(groups[-1], distance):
            last = groups.pop()
            groups[-1] = [groups[-1][0] + last[0], groups[-1][1] + last[1]]
    moved = []
    for group in groups:
        moved += [first(group, distance) + i * distance for i in range(group[1])]
    return moved


def first(group, distance):
    return group[0] / group[1] - distance * (group[1] - 1) / 2


def middle(group, distance):
    """Last place of a group."""
    return first(group, distance) + distance * (group[1] - 1)


def draw(figures, path):
    points = sorted((math.log10(row["ns"]), math.log10(picture_error(row, figures)), row)
                    for row in figures["costs"] if row["errors"] or row["group"] in ("crank", "pipeline"))
    figure, axes = plt.subplots(figsize=(9.5, 6.5), dpi=110)
    for x, y, row in points:
        axes.plot(10**x, 10**y, "o", color=COLORS[row["group"]], markersize=7)
    for above, band in ((-9.6, [p for p in points if p[1] < -8]), (2.2, [p for p in points if p[1] >= -8])):
        for place, (x, y, row) in zip(spread([p[0] for p in band], 0.115), band):
            axes.annotate(row["name"], xy=(10**x, 10**y), xytext=(10**place, 10**above), rotation=60, fontsize=8,
                          color=COLORS[row["group"]], ha="left", va="bottom", rotation_mode="anchor",
                          arrowprops={"arrowstyle": "-", "color": "#c8c8c8", "linewidth": 0.6, "shrinkB": 4})
    axes.set(xscale="log", yscale="log", xlim=(1, 3e4), ylim=(1e-16, 1e7), xlabel="time per evaluation or sample [ns]",
             ylabel="worst error")
    decades = range(-16, 1, 2)
    axes.set_yticks([10.0**e for e in decades] + [NO_DIGITS],
                    [f"1e{e}" if e else "1" for e in decades] + ["no digit left"])
    axes.set_xticks([1, 10, 100, 1000, 10000], ["1", "10", "100", "1000", "10 000"])
    axes.minorticks_off()
    axes.grid(axis="y", color="#ececec")
    axes.set_axisbelow(True)
    axes.spines["left"].set_bounds(1e-16, NO_DIGITS)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for group, color in COLORS.items():
        axes.plot([], [], "o", color=color, label=group)
    axes.legend(loc=(0.6, 0.03), frameon=False, fontsize=9)
    figure.tight_layout()
    figure.savefig(path)


def draw_blow(blow, path):
    """Force z around a blow: the truth and what the levels say, with bands of two deviations."""
    figure, axes = plt.subplots(figsize=(9.5, 5.0), dpi=110)
    most = 0.0
    for level, color, marker in (("linkage", "#d1602b", "s"), ("elastic", "#1f5fa8", "o")):
        time, force, deviation = (blow[level][key] for key in ("time_ms", "force_z_N", "deviation_N"))
        low, high = ([(f + sign * 2.0 * d) / 1e3 for f, d in zip(force, deviation)] for sign in (-1, 1))
        most = max(most, max(high), -min(low))
        axes.fill_between(time, low, high, color=color, alpha=0.18, linewidth=0, label=f"{level}: two deviations")
        axes.plot(time, [f / 1e3 for f in force], marker, color=color, markersize=3.5, label=f"{level}: published")
    axes.plot(blow["truth"]["time_ms"], [f / 1e3 for f in blow["truth"]["force_z_N"]], color="#202020", linewidth=1.0,
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


def cost_line(row):
    error = "see below" if row["group"] in ("crank", "pipeline") else f"{worst(row):.0e}"
    if row["name"] == "pulse":
        error = f"{100 * row['errors']['regular turn']['of_peak']:.0f} % of the peak (model)"
    elif error == f"{NO_DIGITS:.0e}":
        error = "no digit left"
    return f"| {row['group']} | {row['name']} | {row['ns']:.3g} | {row['per_second'] / 1e6:.3g} million | {error} |"


def excerpt(figures):
    costs = {(row["group"], row["name"]): row for row in figures["costs"]}
    lines = ["Cost on one core, and worst relative error over all hard cases:", "",
             "| | way to the loads | ns | per second | worst error |", "|---|---|---|---|---|"]
    lines += [cost_line(costs[key]) for key in EXCERPT if key in costs]
    return "\n".join(lines) + "\n"


def recorded_table(recorded):
    shipped = [line for line in recorded.strip().splitlines() if " 0 % |" in line]
    lines = ["Recorded sessions with clean sensors (`test/data`), as shipped, from 3 s after the start to 3 s before",
             "the end; root-mean-square errors are of the peak of each quantity, all others the worst of all turns:",
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
              line("errors within two stated deviations", rate, lambda row: f"{100 * row['covered_z']:.0f} %"),
              line("instant of the blow, worst", rate, lambda row: f"{1e3 * row['blow_time_s']:.2f} ms"),
              line("blows missed, false", rate, lambda row: f"{row['missed_blows']}, {row['false_blows']}")]
    return "\n".join(lines) + "\n"


def drawings_excerpt(drawings):
    """What a machine's drawing leaves open."""
    lines = ["", "Of 50 machines drawn from the deviations that a hammer file has where it gives none (2 % of mass and inertia, a",
             "millimetre of the centre, 0.3 mm of lengths, half of what crank and rod weigh), with a clean sensor",
             "and a rod that is known to be rigid:", "",
             "| | error, rms | said | within two deviations |", "|---|---|---|---|"]
    lines += [f"| {row['quantity']} | {100 * row['rms']:.1f} % | {100 * row['said']:.1f} % | {100 * row['covered']:.0f} % |"
              for row in drawings]
    return "\n".join(lines) + "\n"


LIFE = [("oil as in the file", "none", "as the boom file has it, no sensor on the boom"),
        ("bulk modulus 30 % lower", "none", "oil 30 % softer than the file, no sensor on the boom"),
        ("bulk modulus 30 % lower", "IMU", "the same with an IMU on the hull"),
        ("bulk modulus 30 % lower", "both", "the same with an IMU and cylinder pressures"),
        ("pressed on rock, crank typical", "both", "hull pressed on rock, typical crank sensor, both")]


def life_excerpt(boom):
    """What fatigue is judged by."""
    rows = {(row["machine"], row["sensors"]): row for row in boom}
    lines = ["| machine | force on the hull | joint torque | bending |", "|---|---|---|---|"]
    lines += ["| " + text + " | " + " | ".join(f"{100 * rows[machine, sensors][key]['error']:+.1f} %"
                                               for key in ("life_force", "life_torque", "life_section")) + " |"
              for machine, sensors, text in LIFE]
    lines += ["| towers, simulated; measured; corrected in the field | | | 5 to 10 %; 10 to 15 %; below 5 % |"]
    return "\n".join(lines) + "\n"


BUDGETED = [("blow/energy_J", "energy of a blow", 1.0, "J"),
            ("pulse/turn_impulse_z_Ns", "impulse of a turn, z", 1.0, "N s"),
            ("equivalent_range_3/hull_wrench/force_z_N", "damage-equivalent range of Fz, slope 3", 1e-3, "kN")]


def budget_excerpt(machine):
    """Where the uncertainty of a recording's figures comes from."""
    figures = {figure["quantity"]: figure for figure in machine["figures"]}
    lines = ["| | value | standard deviation | with the largest source halved | most of the variance |", "|---|---|---|---|---|"]
    for quantity, text, factor, unit in BUDGETED:
        figure = figures[quantity]
        of_unit = [f"{factor * figure[key]:.{digits}g} {unit}"
                   for key, digits in (("value", 4), ("deviation", 2), ("deviation_with_largest_halved", 2))]
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
    parser.add_argument("work", type=pathlib.Path, help="directory with sessions(.json) and budget.json, perhaps costs(.json) and recorded")
    parser.add_argument("root", type=pathlib.Path, help="of the source")
    arguments = parser.parse_args()
    work, root = arguments.work, arguments.root
    figures = json.loads((work / "sessions.json").read_text())
    replace(root / "doc" / "accuracy.md", "sessions", (work / "sessions").read_text())
    replace(root / "README.md", "machines", machines_excerpt(figures["machines"]) + drawings_excerpt(figures["drawings"]))
    replace(root / "README.md", "life", life_excerpt(figures["boom"]))
    draw_blow(figures["blow"], root / "doc" / "blow.png")
    machine, = json.loads((work / "budget.json").read_text())["machines"]
    replace(root / "README.md", "budget", budget_excerpt(machine))
    if not (work / "costs.json").exists():
        return
    figures.update(json.loads((work / "costs.json").read_text()))
    draw(figures, root / "doc" / "accuracy.png")
    tables = f"Measured on: {processor()}, one thread.\n\n" + (work / "costs").read_text()
    replace(root / "doc" / "accuracy.md", "tables", tables)
    replace(root / "README.md", "accuracy", excerpt(figures))
    replace(root / "doc" / "accuracy.md", "recorded", recorded_table((work / "recorded").read_text()))


if __name__ == "__main__":
    main()
