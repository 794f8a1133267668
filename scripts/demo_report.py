#!/usr/bin/env python3
"""Table and picture of a log of the live node: force over some turns, one turn against its half-sine pulse."""
import argparse
import math
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import rosbag  # noqa: E402

WRENCH, PULSE, BLOW = "/hammer_loads/hull_wrench", "/hammer_loads/pulse", "/hammer_loads/blow"
CRANK = "/hammer/crank"
TURNS_SHOWN = 4
COLOR_X, COLOR_Z, COLOR_PULSE = "#8a8f98", "#1f5fa8", "#d1602b"


class Log:
    """What the bags of one run hold, times in seconds since the first crank sample."""

    def __init__(self, bags):
        self.wrench, self.pulses, self.blows, self.crank_samples = [], [], [], 0
        origin = None
        for path in bags:
            with rosbag.Bag(str(path)) as bag:
                for topic, message, _ in bag.read_messages(topics=[WRENCH, PULSE, BLOW, CRANK]):
                    stamp = message.header.stamp
                    origin = origin or stamp
                    time = (stamp - origin).to_sec()
                    if topic == WRENCH:
                        self.wrench.append((time, message.wrench.force.x, message.wrench.force.z))
                    elif topic == PULSE:
                        self.pulses.append((time, message))
                    elif topic == BLOW:
                        self.blows.append((time, message))
                    else:
                        self.crank_samples += 1


def half_sine(pulse, time):
    """Fz of the pulse model, time from the turn's start [s]."""
    if not pulse.start_s < time < pulse.period_s:
        return 0.0
    return pulse.amplitude_N * math.sin(pulse.frequency_rad_s * (time - pulse.start_s))


def middle(values):
    return statistics.median(values) if values else math.nan


def table(log, bags, working):
    """Lines of text; medians over the working turns."""
    energies = [blow.energy_J for _, blow in log.blows]
    presses = [blow.mean_press_force_N for _, blow in log.blows if math.isfinite(blow.mean_press_force_N)]
    size = sum(path.stat().st_size for path in bags)
    rows = [
        ("blows", f"{len(log.blows)}"),
        ("blow rate, median", f"{1.0 / middle([p.period_s for _, p in working]):.2f} Hz"),
        ("blow energy, median", f"{middle(energies):.0f} J"),
        ("peak force Fz, median of turns", f"{middle([p.amplitude_N for _, p in working]) / 1e3:.2f} kN"),
        ("largest force Fz", f"{max(f for _, _, f in log.wrench) / 1e3:.2f} kN"),
        ("mean press force needed, median", f"{middle(presses):.0f} N"),
        ("crank samples logged", f"{log.crank_samples}"),
        ("wrenches logged", f"{len(log.wrench)}"),
    ]
    rows += [("log", str(path)) for path in bags]
    rows.append(("log size", f"{size / 1e6:.2f} MB"))
    width = max(len(name) for name, _ in rows)
    return [f"{name:<{width}}  {value}" for name, value in rows]


def style(axes, title):
    axes.set_title(title, loc="left", fontsize=11)
    axes.set_ylabel("force on the hull [kN]")
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.grid(True, linewidth=0.3)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def split_at_blows(points, blow_times):
    """With a gap where a blow lies between two points: the force jumps there."""
    split = []
    for before, after in zip([None] + points, points):
        if before and any(before[0] < time <= after[0] for time in blow_times):
            split.append((after[0], math.nan, math.nan))
        split.append(after)
    return split


def draw_turns(axes, log, shown):
    """Force over some turns; shown is [(time of the blow that ends the turn, pulse)]."""
    begin, end = shown[0][0] - shown[0][1].period_s, shown[-1][0]
    margin = 0.02 * (end - begin)
    points = split_at_blows([point for point in log.wrench if begin - margin <= point[0] <= end + margin],
                            [time for time, _ in log.blows])
    times = [time for time, _, _ in points]
    axes.plot(times, [fx / 1e3 for _, fx, _ in points], color=COLOR_X, linewidth=1.2, label="$F_x$ across the tool")
    axes.plot(times, [fz / 1e3 for _, _, fz in points], color=COLOR_Z, linewidth=1.4, label="$F_z$ along the tool")
    last = shown[-1][0]
    for time, _ in log.blows:
        if begin - margin <= time <= end + margin:
            axes.axvline(time, color="black", linewidth=0.8, linestyle=":", label="blow" if time == last else None)
    axes.set_xlim(begin - margin, end + margin)
    axes.set_xlabel("time since the first crank sample [s]")
    style(axes, f"Force of the hammer on its hull over {len(shown)} turns")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=3, frameon=False, fontsize=9, borderaxespad=0.2)


def draw_pulse(axes, log, end, pulse):
    """One turn's Fz against its half-sine."""
    begin = end - pulse.period_s
    points = [(time - begin, fz) for time, _, fz in log.wrench if begin <= time <= end]
    axes.plot([1e3 * time for time, _ in points], [fz / 1e3 for _, fz in points], color=COLOR_Z, linewidth=1.4,
              marker=".", markersize=3, label="$F_z$")
    grid = [pulse.period_s * i / 1000 for i in range(1001)]
    axes.plot([1e3 * time for time in grid], [half_sine(pulse, time) / 1e3 for time in grid], color=COLOR_PULSE,
              linewidth=1.4, linestyle="--",
              label=f"half-sine: H = {pulse.amplitude_N / 1e3:.2f} kN, S = {pulse.impulse_Ns:.0f} N s")
    axes.set_xlim(0.0, 1e3 * pulse.period_s)
    axes.set_xlabel("time since the blow before [ms]")
    style(axes, f"Turn {pulse.turn}: force along the tool and its half-sine pulse")
    axes.legend(loc="upper left", frameon=True, framealpha=0.9, edgecolor="none", fontsize=9)


def draw(log, working, path):
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(10, 8), constrained_layout=True)
    at = max(0, len(working) // 2 - TURNS_SHOWN // 2)
    shown = working[at:at + TURNS_SHOWN]
    draw_turns(upper, log, shown)
    draw_pulse(lower, log, *shown[len(shown) // 2])
    figure.savefig(str(path), dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path, help="with the bags of one run")
    parser.add_argument("--picture", type=pathlib.Path, help="PNG to write")
    arguments = parser.parse_args()
    bags = sorted(arguments.directory.glob("*.bag"))
    if not bags:
        print(f"{arguments.directory}: no log bag", file=sys.stderr)
        return 1
    try:
        log = Log(bags)
    except rosbag.ROSBagException as error:
        print(f"{arguments.directory}: {error}", file=sys.stderr)
        return 1
    strongest = max((pulse.amplitude_N for _, pulse in log.pulses), default=0.0)
    working = [(time, pulse) for time, pulse in log.pulses if pulse.amplitude_N > 0.5 * strongest]
    if not log.wrench or not working:
        print(f"{arguments.directory}: {len(log.wrench)} wrenches and {len(log.pulses)} pulses in "
              f"{len(bags)} bag(s): nothing to report", file=sys.stderr)
        return 1
    if arguments.picture:
        draw(log, working, arguments.picture)
    print("\n".join(table(log, bags, working)))
    if arguments.picture:
        print(f"picture: {arguments.picture}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
