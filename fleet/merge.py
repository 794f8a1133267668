#!/usr/bin/env python3
"""Merges outcomes of bags into one file, or into PostgreSQL. Outcomes (JSON files) come on stdin, one a line.

What is in already stays as it is, so that merging again is safe and a merge that was killed goes on.
"""
import argparse
import itertools
import sys

import store
from loader import OPTIONAL, Loader
from machine_sums import write_sums

BAGS_AT_ONCE = 200  # a transaction


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
