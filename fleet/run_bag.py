#!/usr/bin/env python3
"""One bag to one database and one outcome: what is wrong with a bag is an outcome too, not a failure of the job.

Usage: run_bag.py BAG.json-text OUT.sqlite OUTCOME.json
"""
import hashlib
import json
import os
import subprocess
import sys

import report_path  # noqa: F401  (sets the path of report)
from report import inputs

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


def processed(bag, database):
    """(status, reason); the database is there if the status is `done`."""
    if bag["problem"]:
        return "failed", bag["problem"]
    for path in bag["bags"]:
        if path.endswith(".active"):
            return "failed", "is still being written, or was left by a power cut: rosbag reindex makes it a bag"
        if not os.path.isfile(path):
            return "failed", "does not exist" if not os.path.exists(path) else "is no regular file"
    options = bag["options"] + [word for file in bag["parameters"] for word in ("--params", file)]
    done = inputs.process(bag["bags"], options, database, stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    return ("done", None) if done.returncode == 0 else ("failed", reason_of(done))


def main(bag, database, outcome_path):
    """bag: JSON of machine, bags (of one recording, in order), parameters, options (of process_bag), problem (why it cannot be
    tried), states. Writes the database, empty if the bag gives none, and the outcome. Snakemake makes their folder and removes the
    files of an earlier job."""
    bag = json.loads(bag)
    status, reason = processed(bag, database)
    if status != "done":
        open(database, "w").close()
    outcome = {"machine": bag["machine"], "bag": bag["bags"][0], "input_sha256": sha256(bag["bags"]),
               "parameters_sha256": sha256(bag["parameters"]), "status": status, "reason": reason}
    with open(outcome_path, "w", encoding="utf-8") as file:
        json.dump(outcome, file, indent=1, sort_keys=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
