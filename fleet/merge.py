#!/usr/bin/env python3
"""Merges outcomes of bags into one file, or into PostgreSQL. Outcomes (JSON files) come on stdin, one a line.

What is in already stays as it is, so that merging again is safe and a merge that was killed goes on.
"""
import argparse
import itertools
import sys

import report_path  # noqa: F401  (sets the path of report)
import store
from loader import OPTIONAL, Loader
from report.cycles import channels_of

BAGS_AT_ONCE = 200  # a transaction

OF_MACHINE = "r.bag_id IN (SELECT bag_id FROM bags WHERE machine = ?)"


def write_sums(store, machine):
    """Recomputes the sums of one machine."""
    store.rows("DELETE FROM machine_channels WHERE machine = ?", machine)
    for channel in channels_of(store, OF_MACHINE, machine):
        write_channel(store, machine, channel)


def write_channel(store, machine, channel):
    at, = store.row("SELECT coalesce(max(machine_channel), 0) + 1 FROM machine_channels")
    remaining = channel.remaining_hours()[0]
    row = {**channel.row, "machine": machine, "machine_channel": at, "largest_range": float(channel.cycles[0].max(initial=0.0)),
           "damage": channel.damage()[0], "remaining_hours": None if remaining == float("inf") else remaining}
    store.insert("machine_channels", [list(row.values())], list(row))
    store.insert("machine_equivalents", [(at, slope, *figure) for slope, figure in channel.equivalents().items()])
    store.insert("machine_cycles", [(at, *cell, n) for cell, n in sorted(channel.count.closed.items())])
    store.insert("machine_residues", [(at, place, point) for place, point in enumerate(channel.count.residue)])


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
    except (store.Problem, OSError) as problem:
        print(problem, file=sys.stderr)
        return 1
    print(f"{target.name}: {total} bags, {changed} new or changed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
