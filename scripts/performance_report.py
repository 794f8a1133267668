#!/usr/bin/env python3
"""Tables of doc/performance.md and doc/log.md from what scripts/update_performance has measured."""
import argparse
import json
import pathlib

from accuracy_report import processor, replace


def aggregates(path):
    """Rows of google-benchmark's repetitions: name, median of the time per item [ns], its variation, difference."""
    rows = json.loads(path.read_text())["benchmarks"]
    spreads = {row["run_name"]: row["cpu_time"] for row in rows if row.get("aggregate_name") == "cv"}
    for row in rows:
        if row.get("aggregate_name") == "median":
            yield row["run_name"], 1e9 / row["items_per_second"], spreads[row["run_name"]], row.get("difference")


def cost_table(path):
    lines = [f"Measured on: {processor()}, one thread.", "", "| | | ns | spread | per second and core |",
             "|---|---|---|---|---|"]
    lines += [f"| {' | '.join(name.split('/', 1))} | {ns:.3g} | {100 * spread:.0f} % | {1e3 / ns:.3g} million |"
              for name, ns, spread, _ in aggregates(path)]
    return "\n".join(lines) + "\n"


def peer_table(path):
    """Each task's first row is this package's."""
    lines = ["| task | library | ns | times hammer_loads | largest difference |", "|---|---|---|---|---|"]
    own = {}
    for name, ns, _, difference in aggregates(path):
        task, library = name.split("/", 1)
        own.setdefault(task, ns)
        lines.append(f"| {task} | {library} | {ns:.3g} | {ns / own[task]:.2g} | "
                     f"{'reference' if difference == 0.0 else format(difference, '.1g')} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("work", type=pathlib.Path, help="directory with some of costs.json, peers.json, live, log, hour")
    parser.add_argument("root", type=pathlib.Path, help="of the source")
    arguments = parser.parse_args()
    work, page = arguments.work, arguments.root / "doc" / "performance.md"
    if (work / "costs.json").exists():
        replace(page, "costs", cost_table(work / "costs.json"))
        replace(page, "peers", peer_table(work / "peers.json"))
    if (work / "live").exists():
        replace(page, "live", (work / "live").read_text())
    if (work / "hour").exists():
        head = "| an hour at 1 kHz, into a database | processor time | peak memory |\n|---|---|---|\n"
        replace(page, "hour", head + (work / "hour").read_text())
    if (work / "log").exists():
        replace(arguments.root / "doc" / "log.md", "log", (work / "log").read_text())


if __name__ == "__main__":
    main()
