#!/usr/bin/env python3
"""Draws the latencies that scripts/latency measured: quantile against microseconds, one panel per rate."""
import argparse
import collections
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

COLOURS = {"relay": "0.5", "node": "tab:blue", "nodelet": "tab:orange"}


def curves(path):
    """(rate, path) -> [(quantile, microseconds)]"""
    found = collections.defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row["quantile"] != "ratio":
                found[int(row["rate_Hz"]), row["path"]].append((float(row["quantile"]), float(row["microseconds"])))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table")
    parser.add_argument("picture")
    arguments = parser.parse_args()
    found = curves(arguments.table)
    rates = sorted({rate for rate, _ in found})
    figure, axes = plt.subplots(1, len(rates), figsize=(9, 3.4), sharey=True)
    for axis, rate in zip(axes, rates):
        for name, colour in COLOURS.items():
            points = found[rate, name]
            axis.plot([1.0 / (1.0 - q) for q, _ in points], [us for _, us in points], color=colour, label=name)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xticks([2, 10, 100, 1000], ["50 %", "90 %", "99 %", "99.9 %"])
        axis.set_xlabel("part of the samples")
        axis.set_title(f"{rate / 1000:g} kHz", fontsize=10)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("source to wrench, us")
    axes[0].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(arguments.picture, dpi=110)


if __name__ == "__main__":
    main()
