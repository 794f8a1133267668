#!/usr/bin/env python3
"""One bag to one database and one outcome: what is wrong with a bag is an outcome too, not a failure of the job."""
import argparse
import hashlib
import json
import os
import subprocess
import sys

from programs import inputs, program

LONGEST_REASON = 500


def sha256(paths):
    """Over the files' bytes in their order; nothing for what cannot be read."""
    digest = hashlib.sha256()
    try:
        for path in paths:
            with open(path, "rb") as file:
                for piece in iter(lambda: file.read(1 << 20), b""):
                    digest.update(piece)
    except OSError:
        return None
    return digest.hexdigest()


def reason_of(done):
    """First line of the program's output; its exit code where there is none."""
    if done.returncode < 0:
        return f"process_bag ended by signal {-done.returncode}"
    lines = [line for line in done.stderr.splitlines() if line and not line.startswith("note: ")]
    return (lines[0] if lines else f"process_bag ended with code {done.returncode}")[:LONGEST_REASON]


def processed(bags, parameters, options, database):
    """(status, reason); the database is there if the status is `done`."""
    for bag in bags:
        if bag.endswith(".active"):
            return "failed", "is still being written, or was left by a power cut: rosbag reindex makes it a bag"
        if not os.path.isfile(bag):
            return "failed", "does not exist" if not os.path.exists(bag) else "is no regular file"
    options = options + [word for file in parameters for word in ("--params", file)]
    done = inputs.process(bags, options, database, program("process_bag"), stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    return ("done", None) if done.returncode == 0 else ("failed", reason_of(done))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--machine", required=True)
    parser.add_argument("--bag", required=True)
    parser.add_argument("--split", action="append", default=[], help="another bag of the same recording, in order")
    parser.add_argument("--option", action="append", default=[], help="a word for process_bag")
    parser.add_argument("--params", action="append", default=[])
    parser.add_argument("--problem", help="why the bag cannot be tried")
    parser.add_argument("--db", required=True, help="to write; empty if the bag gives none")
    parser.add_argument("--outcome", required=True, help="JSON to write")
    given = parser.parse_args()
    for path in (given.db, given.outcome):
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if os.path.exists(path):
            os.unlink(path)
    status, reason = (("failed", given.problem) if given.problem else
                      processed([given.bag, *given.split], given.params, given.option, given.db))
    if status != "done":
        open(given.db, "w").close()
    outcome = {"machine": given.machine, "bag": given.bag, "input_sha256": sha256([given.bag, *given.split]),
               "parameters_sha256": sha256(given.params), "status": status, "reason": reason}
    part = given.outcome + ".part"
    with open(part, "w", encoding="utf-8") as file:
        json.dump(outcome, file, indent=1, sort_keys=True)
    os.replace(part, given.outcome)


if __name__ == "__main__":
    sys.exit(main())
