#!/usr/bin/env python3
"""Table and picture of a log of the live node on a simulated machine, beside the machine's true loads and blows."""
import argparse
import pathlib
import sqlite3
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402
import rosbag  # noqa: E402

LOADS, PULSE, BLOW, CRANK = "/hammer_loads/hull_loads", "/hammer_loads/pulse", "/hammer_loads/blow", "/hammer/crank"
TURNS_SHOWN = 4
SAME_SAMPLE = 1e-6  # [s] between a stamp of the node and the true instant
FORCE_Z, FORCE_X, TRUE, HALF_SINE = "#0072b2", "#009e73", "#c3c7ce", "#d55e00"  # told apart by colour-blind readers too


def table_of(rows, names):
    return np.array(rows, dtype=float).reshape(-1, len(names)).view([(name, float) for name in names])[:, 0]


class Log:
    """Outputs of the node, times in seconds since `origin` [s]."""

    def __init__(self, bags, origin):
        loads, pulses, blows, self.crank_samples = [], [], [], 0
        for path in bags:
            with rosbag.Bag(str(path)) as bag:
                for topic, m, _ in bag.read_messages(topics=[LOADS, PULSE, BLOW, CRANK]):
                    time = m.header.stamp.secs - origin + 1e-9 * m.header.stamp.nsecs
                    if topic == LOADS:
                        loads.append((time, m.force_x, m.force_z))
                    elif topic == PULSE:
                        pulses.append((time, m.period, m.amplitude, m.angular_frequency, m.start, m.impulse))
                    elif topic == BLOW:
                        blows.append((time, m.energy, m.energy_std, m.restitution, m.mean_hold_down_force))
                    else:
                        self.crank_samples += 1
        self.loads = table_of(loads, ["time", "x", "z"])
        self.pulses = table_of(pulses, ["time", "period", "amplitude", "frequency", "start", "impulse"])
        self.blows = table_of(blows, ["time", "energy", "deviation", "restitution", "hold_down"])


class Truth:
    """Truth that simulate_hammer wrote below its truth_prefix, times as in Log."""

    def __init__(self, prefix):
        samples, blows = ([line.split(",") for line in pathlib.Path("%s_%s.csv" % (prefix, kind)).read_text().split()[1:]]
                          for kind in ("samples", "blows"))
        self.origin = int(samples[0][0].partition(".")[0])
        self.loads = table_of([self.numbers(row)[:3] for row in samples], ["time", "x", "z"])
        self.blows = table_of([self.numbers(row) for row in blows], ["time", "energy", "impulse", "before", "after"])
        self.period = np.diff(self.blows["time"])
        turns = np.searchsorted(self.loads["time"], self.blows["time"])
        self.peak = np.array([self.loads["z"][a:b].max() for a, b in zip(turns, turns[1:])])

    def numbers(self, row):
        seconds, _, rest = row[0].partition(".")
        return [int(seconds) - self.origin + float("0." + rest)] + [float(cell) for cell in row[1:]]


def figures(log, truth):
    """(title, quantity of the page or none, node, true, unit, digits), in the units of the tables."""
    def median(values):
        return float(np.nanmedian(values))
    return [
        ("blow rate, median", "blow_rate_Hz", median(1.0 / log.pulses["period"]), median(1.0 / truth.period), "Hz", 2),
        ("blow energy, median", "energy", median(log.blows["energy"]), median(truth.blows["energy"]), "J", 0),
        ("restitution, median", "restitution", median(log.blows["restitution"]),
         median(-truth.blows["after"] / truth.blows["before"]), "", 3),
        ("peak force Fz, median of revolutions", "amplitude", median(log.pulses["amplitude"]), median(truth.peak), "N", 0),
        ("hold-down force needed, median", "mean_hold_down_force", median(log.blows["hold_down"]),
         median(truth.blows["impulse"][1:] / truth.period), "N", 0),
    ]


def errors_of_samples(log, truth):
    """Differences of Fx and Fz from the true ones where both have the instant [N]."""
    at = np.clip(np.searchsorted(truth.loads["time"], log.loads["time"] - SAME_SAMPLE), 0, len(truth.loads) - 1)
    same = abs(truth.loads["time"][at] - log.loads["time"]) < 2 * SAME_SAMPLE
    return (log.loads[axis][same] - truth.loads[axis][at][same] for axis in ("x", "z"))


def report(log, truth, bags):
    rows = [("", "node", "true", "error"),
            ("blows", str(len(log.blows)), str(len(truth.blows)), "%+d" % (len(log.blows) - len(truth.blows)))]
    for title, _, node, true, unit, digits in figures(log, truth):
        rows.append((title, *("%.*f %s" % (digits, value, unit) for value in (node, true)),
                     "%+.1f %%" % (100.0 * (node / true - 1.0))))
    widths = [max(len(row[column].strip()) for row in rows) for column in range(4)]
    lines = ["%-*s  %*s  %*s  %*s" % (widths[0], row[0], *(x for i in (1, 2, 3) for x in (widths[i], row[i].strip())))
             for row in rows]
    peak = abs(truth.loads["z"]).max()
    for axis, error in zip(("Fx", "Fz"), errors_of_samples(log, truth)):
        lines.append("force %s, all samples: root mean square error %.0f N, %.2f %% of the largest Fz" % (
            axis, np.sqrt(np.mean(error**2)), 100.0 * np.sqrt(np.mean(error**2)) / peak))
    lines.append("%d crank samples logged, %d with loads" % (log.crank_samples, len(log.loads)))
    return lines + ["log: %s, %.1f MB" % (path, path.stat().st_size / 1e6) for path in bags]


def write_truth(log, truth, path):
    """Table `truth`, which `report` states beside its own figures."""
    with sqlite3.connect(str(path)) as database:
        database.execute("CREATE TABLE truth (quantity TEXT PRIMARY KEY, value REAL NOT NULL)")
        database.executemany("INSERT INTO truth VALUES (?, ?)",
                             [("blows", len(truth.blows))] + [(key, true) for _, key, _, true, _, _ in figures(log, truth)])


def style(axes, title, x, y):
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(True, linewidth=0.3)
    axes.margins(x=0.01)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def curve(axes, table, axis, begin, end, blows, **line):
    """[kN] over [s]. No line over a blow, where the force jumps."""
    part = table[(table["time"] >= begin) & (table["time"] <= end)]
    gaps = np.searchsorted(part["time"], blows[(blows > begin) & (blows < end)])
    axes.plot(np.insert(part["time"], gaps, np.nan), np.insert(part[axis], gaps, np.nan) / 1e3, **line)


def draw_turns(axes, log, truth, first):
    """From one true blow over whole revolutions to another."""
    blows = truth.blows["time"]
    shown = blows[first:first + TURNS_SHOWN + 1]
    begin, end = shown[0] - 0.02, shown[-1] + 0.02
    thick = {"color": TRUE, "linewidth": 4.0, "solid_capstyle": "round"}
    curve(axes, truth.loads, "z", begin, end, blows, label="true", **thick)
    curve(axes, truth.loads, "x", begin, end, blows, **thick)
    curve(axes, log.loads, "z", begin, end, blows, color=FORCE_Z, linewidth=1.4, label="$F_z$ along the tool")
    curve(axes, log.loads, "x", begin, end, blows, color=FORCE_X, linewidth=1.4, label="$F_x$ across the tool")
    for blow in shown:
        axes.axvline(blow, color="black", linewidth=0.8, linestyle=":", label="blow" if blow == shown[0] else None)
    style(axes, "Force of the hammer on its housing over %d revolutions" % (len(shown) - 1), "time [s]", "force [kN]")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=4, frameon=False, fontsize=9, borderaxespad=0.2)


def draw_pulse(axes, log, pulse):
    begin = pulse["time"] - pulse["period"]
    part = log.loads[(log.loads["time"] > begin) & (log.loads["time"] < pulse["time"])]
    time = 1e3 * (part["time"] - begin)
    axes.plot(time, part["z"] / 1e3, color=FORCE_Z, linewidth=1.4, label="$F_z$")
    grid = np.linspace(0.0, pulse["period"], 1001)
    sine = np.where(grid > pulse["start"], np.sin(pulse["frequency"] * (grid - pulse["start"])), 0.0)
    axes.plot(1e3 * grid, pulse["amplitude"] * sine / 1e3, color=HALF_SINE, linewidth=1.4, linestyle="--",
              label="half-sine: H = %.2f kN, S = %.0f N s" % (pulse["amplitude"] / 1e3, pulse["impulse"]))
    style(axes, "One revolution and its half-sine pulse", "time since the blow before [ms]", "force $F_z$ [kN]")
    axes.legend(loc="upper left", frameon=False, fontsize=8)


def draw_energies(axes, log, truth):
    blows = log.blows
    axes.plot(truth.blows["time"], truth.blows["energy"], "o", color=TRUE, markersize=8, label="true")
    axes.fill_between(blows["time"], blows["energy"] - 2 * blows["deviation"], blows["energy"] + 2 * blows["deviation"],
                      color=FORCE_Z, alpha=0.18, linewidth=0.0, label="two standard deviations")
    axes.plot(blows["time"], blows["energy"], ".", color=FORCE_Z, markersize=5, label="node")
    axes.set_ylim(0.0, None)
    style(axes, "Energy of each blow: %d of %d blows" % (len(blows), len(truth.blows)), "time [s]", "energy [J]")
    axes.legend(loc="lower center", frameon=False, fontsize=8, ncol=3)


def draw(log, truth, path):
    figure = plt.figure(figsize=(11, 8), constrained_layout=True)
    grid = figure.add_gridspec(2, 2)
    middle = max(0, (len(truth.blows) - TURNS_SHOWN) // 2)
    draw_turns(figure.add_subplot(grid[0, :]), log, truth, middle)
    draw_pulse(figure.add_subplot(grid[1, 0]), log, log.pulses[len(log.pulses) // 2])
    draw_energies(figure.add_subplot(grid[1, 1]), log, truth)
    figure.savefig(str(path), dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path, help="with the bags of one run")
    parser.add_argument("truth", help="truth_prefix of its simulate_hammer")
    parser.add_argument("--picture", type=pathlib.Path, required=True, help="PNG to write")
    parser.add_argument("--db", type=pathlib.Path, required=True, help="tables of the run, which get one more, `truth`")
    arguments = parser.parse_args()
    bags = sorted(arguments.directory.glob("*.bag"))
    truth = Truth(arguments.truth)
    log = Log(bags, truth.origin)
    if not len(log.loads) or not len(log.pulses):
        print(f"{arguments.directory}: {len(log.loads)} samples with loads and {len(log.pulses)} pulses in {len(bags)} "
              "bag(s): nothing to report", file=sys.stderr)
        return 1
    draw(log, truth, arguments.picture)
    write_truth(log, truth, arguments.db)
    print("\n".join(report(log, truth, bags)))
    print(f"picture: {arguments.picture}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
