#!/usr/bin/env python3
"""Merges outcomes of bags into one file, or into PostgreSQL. Outcomes (JSON files) come on stdin, one a line.

What is in already stays as it is, so that merging again is safe and a merge that was killed goes on.
"""
import argparse
import itertools
import sys

import store
from loader import OPTIONAL, Loader
from report.cycles import CURVE, MEANS, SLOPES, SUMS, Channel

BAGS_AT_ONCE = 200  # a transaction

# Load cycles of a machine over all its runs. Pieces add exactly: closed cycles add, residues join in time order.
OF_CHANNEL = "FROM bags b JOIN runs r USING(bag_id) JOIN channels c USING(run_id) "
SAME = "b.machine = ? AND r.machine = ? AND c.name = ? AND c.least = ? AND c.greatest = ? AND c.classes = ?"
IDENTITY = ["identity", "name", "least", "greatest", "classes"]
# Means are weighted by the samples of the runs that have them.
WEIGHTED = ("CAST(sum(c.{0} * c.samples) AS DOUBLE PRECISION) / "
            "nullif(sum(CASE WHEN c.{0} IS NULL THEN 0 ELSE c.samples END), 0) AS {0}")
SUMMED = ", ".join([f"CAST(sum(c.{name}) AS BIGINT)" for name in SUMS] + list(map(WEIGHTED.format, MEANS)))
CHANNELS = (
    "SELECT r.machine, c.name, c.least, c.greatest, c.classes, sum(r.duration) / 3600, max(r.equivalent_cycles_per_hour), "
    f"min(c.minimum), max(c.maximum), {SUMMED} {OF_CHANNEL} WHERE b.machine = ? AND c.counted = 1 GROUP BY r.machine, c.name, c.least, c.greatest, c.classes "
    "ORDER BY r.machine, min(c.channel)")
COLUMNS = [*IDENTITY, "hours", "equivalent_cycles_per_hour", "minimum", "maximum", *SUMS, *MEANS]
LATEST = (f"SELECT c.unit, {', '.join('c.' + name for name in CURVE)} {OF_CHANNEL} WHERE {SAME} "
          "ORDER BY r.first_stamp_ns DESC LIMIT 1")
CYCLES = (f"SELECT y.steps, y.low, CAST(sum(y.count) AS BIGINT) {OF_CHANNEL} "
          f"JOIN cycles y ON y.run_id = c.run_id AND y.channel = c.channel WHERE {SAME} GROUP BY y.steps, y.low")
RESIDUES = (f"SELECT s.class {OF_CHANNEL} JOIN residues s ON s.run_id = c.run_id AND s.channel = c.channel WHERE {SAME} "
            "ORDER BY r.first_stamp_ns, r.run_key, s.place")


def write_sums(store, machine):
    """Recomputes the sums of one machine."""
    for table in ("machine_equivalents", "machine_cycles", "machine_residues"):
        store.rows(f"DELETE FROM {table} WHERE machine_channel IN "
                   "(SELECT machine_channel FROM machine_channels WHERE machine = ?)", machine)
    store.rows("DELETE FROM machine_channels WHERE machine = ?", machine)
    for row in list(store.rows(CHANNELS, machine)):
        same = (machine, *row[:len(IDENTITY)])
        row = {**dict(zip(COLUMNS, row)), **dict(zip(["unit", *CURVE], store.row(LATEST, *same))), "machine": machine}
        channel = Channel(row, row["equivalent_cycles_per_hour"])
        channel.add(row, row["hours"] or 0.0)
        channel.count.add_closed(store.rows(CYCLES, *same))
        channel.count.join(point for point, in store.rows(RESIDUES, *same))
        write_channel(store, row, channel)


def write_channel(store, row, channel):
    at = (store.row("SELECT max(machine_channel) FROM machine_channels")[0] or 0) + 1
    remaining = channel.remaining_hours()[0]
    row.update(machine_channel=at, largest_range=float(channel.cycles[0].max(initial=0.0)), damage=channel.damage()[0],
               remaining_hours=None if remaining == float("inf") else remaining)
    store.insert("machine_channels", list(row), [list(row.values())])
    store.insert("machine_equivalents", ["machine_channel", "slope", "equivalent_range", "std"],
                 [(at, slope, *figure) for slope, figure in zip(SLOPES, channel.equivalents())])
    store.insert("machine_cycles", ["machine_channel", "steps", "low", "count"],
                 [(at, *cell, n) for cell, n in sorted(channel.count.closed.items())])
    store.insert("machine_residues", ["machine_channel", "place", "class"],
                 [(at, place, point) for place, point in enumerate(channel.count.residue)])


def merged(target, outcomes, rows):
    """Numbers of bags: given, changed."""
    given = changed = 0
    for some in iter(lambda: list(itertools.islice(outcomes, BAGS_AT_ONCE)), []):
        target.begin()
        loader = Loader(target, rows)
        changed += sum(loader.add(path) for path in some)
        given += len(some)
        target.commit()
    for machine, in list(target.rows("SELECT machine FROM stale_machines ORDER BY machine")):
        target.begin()
        write_sums(target, machine)
        target.rows("DELETE FROM stale_machines WHERE machine = ?", machine)
        target.commit()
    return given, changed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target", help="file, or postgresql://USER@HOST/DATABASE")
    parser.add_argument("--rows", choices=sorted(OPTIONAL), help="turns: rows of turns and blows as well")
    given = parser.parse_args()
    try:
        target = store.opened(given.target)
        total, changed = merged(target, (line.rstrip("\n") for line in sys.stdin), given.rows)
        target.close()
    except (store.BadStore, OSError) as problem:
        print(problem, file=sys.stderr)
        return 1
    print(f"{target.name}: {total} bags, {changed} new or changed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
