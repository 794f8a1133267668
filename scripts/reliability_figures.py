#!/usr/bin/env python3
"""Replaces what stands between <!-- NAME --> and <!-- /NAME --> in doc/reliability.md by measured figures."""
import argparse
import csv
import pathlib
import sys


def figures(path):
    """key -> value of a soak's `key: value` lines."""
    pairs = (line.split(": ") for line in path.read_text().splitlines() if ": " in line)
    return {key: float(value) for key, value in pairs}


def table(header, rows):
    lines = ["| " + " | ".join(cells) + " |" for cells in [header, *rows]]
    return "\n".join([lines[0], "|" + "---|" * len(header), *lines[1:]]) + "\n"


def soak_pipeline(results):
    f = figures(results / "soak_pipeline.txt")
    return table(["a day through the pipeline", ""], [
        ["samples, turns", f"{f['samples']:.0f}, {f['turns']:.0f}"],
        ["took", f"{f['seconds']:.0f} s"],
        ["refused, restarts after the first sample", f"{f['refused']:.0f}, {f['restarts'] - 1:.0f}"],
        ["memory, mean of first and last quarter",
         f"{f['memory_first_quarter_MB']:.3f}, {f['memory_last_quarter_MB']:.3f} MB"],
        ["rms error of Fz over its peak, at first and at last",
         f"{f['first_rms_error']:.7f}, {f['last_rms_error']:.7f}"],
        ["worst error of them", f"{f['first_worst_error']:.6f}, {f['last_worst_error']:.6f}"],
    ])


def soak_log(results):
    f = figures(results / "soak_log.txt")
    return table(["machine time through the log", ""], [
        ["machine time, took", f"{f['machine_seconds']:.0f} s, {f['seconds']:.0f} s"],
        ["messages written, dropped", f"{f['messages_written']:.0f}, {f['messages_dropped']:.0f}"],
        ["bags closed, of these deleted", f"{f['bags_closed']:.0f}, {f['bags_deleted']:.0f}"],
        ["most on the disk, allowed but for the open bag", f"{f['most_on_disk_MB']:.0f}, {f['allowed_MB']:.0f} MB"],
        ["memory, mean of first and last quarter",
         f"{f['memory_first_quarter_MB']:.2f}, {f['memory_last_quarter_MB']:.2f} MB"],
        ["gaps in what was kept", f"{f['gaps']:.0f}"],
    ])


def soak_live(results):
    f = figures(results / "soak_live.txt")
    return table(["live node", ""], [
        ["time, rate", f"{f['seconds']:.0f} s, {f['rate_Hz']:.0f} Hz"],
        ["samples sent, wrenches received", f"{f['sent']:.0f}, {f['received']:.0f}"],
        ["before the first wrench, lost, doubled",
         f"{f['before_the_first_wrench']:.0f}, {f['lost']:.0f}, {f['doubled']:.0f}"],
        ["memory of the node, mean of first and last quarter",
         f"{f['node_memory_first_quarter_MB']:.2f}, {f['node_memory_last_quarter_MB']:.2f} MB"],
    ])


def latency(results):
    with open(results / "latency.csv", newline="") as file:
        cells = {(row["rate_Hz"], row["path"], row["quantile"]): row["microseconds"] for row in csv.DictReader(file)}
    rows = []
    for rate in sorted({key[0] for key in cells}, key=float):
        for path in ("relay", "node", "nodelet"):
            values = [f"{float(cells[rate, path, q]):.0f}".replace("inf", "lost") for q in ("0.5", "0.99", "0.999")]
            rows.append([f"{float(rate) / 1000:g} kHz", path, *values, cells[rate, path, "ratio"]])
    return table(["rate", "path", "median, us", "99 %", "99.9 %", "median over the relay's"], rows)


def fuzz(path):
    with open(path, newline="") as file:
        rows = [[r["target"], r["executions"], r["seconds"] + " s", r["edges_covered"], r["findings"]]
                for r in csv.DictReader(file)]
    return table(["target", "executions", "took", "edges covered", "findings"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path, required=True)
    parser.add_argument("--fuzz", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    text = arguments.document.read_text()
    results = arguments.results
    sources = {
        "soak_pipeline": lambda: soak_pipeline(results),
        "soak_log": lambda: soak_log(results),
        "soak_live": lambda: soak_live(results),
        "latency": lambda: latency(results),
        "fuzz": lambda: fuzz(arguments.fuzz),
    }
    for name, source in sources.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- /{name} -->"
        try:
            section = source()
        except FileNotFoundError as error:
            print(f"{name}: left as it is, no {error.filename}", file=sys.stderr)
            continue
        head, rest = text.split(begin)
        text = head + begin + section + end + rest.split(end)[1]
    arguments.document.write_text(text)


if __name__ == "__main__":
    main()
