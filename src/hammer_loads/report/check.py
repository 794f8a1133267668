"""The command check: conditions of recordings, a line each, with ok, look or wrong, and the action."""
import json
import os
import subprocess
import tempfile

from report import inputs
from report.checks import REMEDY, WRONG, check_rows, sorted_warnings, verdict
from report.command import Parser, Usage
from report.database import Database, Problem, one_line
from report.subjects import subjects_of


def refused_rows(lines):
    """Rows of a recording that process_bag refused; lines: of its stderr, warnings with their keys."""
    keyed = [line.split("\t", 1) for line in lines if "\t" in line]
    rows = [[name, status, words[0], REMEDY.get(name, "")] for name, (status, words) in sorted_warnings(keyed).items()]
    if all(row[1] != WRONG for row in rows):
        problems = [one_line(line) for line in lines if "\t" not in line]
        rows.append(["recording", WRONG, problems[0] if problems else "no result", "see process_bag IN.bag"])
    return rows


def rows_of(splits, options, folder):
    database = os.path.join(folder, f"{len(os.listdir(folder))}.sqlite")
    done = inputs.process(splits, ["--keys", *options], database, stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    return refused_rows(done.stderr.splitlines()) if done.returncode else check_rows(subjects_of(Database(database))[0])


def as_text(name, rows):
    lines = [f"{name}: {verdict(rows)}"]
    for check, status, finding, action in rows:
        lines.append(f"  {status:5} {check:11} {finding}" + (f" -> {action}" if action else ""))
    return "\n".join(lines)


def as_json(found):
    return json.dumps({"recordings": [
        {"recording": name, "verdict": verdict(rows),
         "checks": [dict(zip(("check", "status", "finding", "action"), row)) for row in rows]} for name, rows in found]}, indent=2)


def run(given):
    if others := [name for name in given.files if not inputs.is_bag(name)]:
        raise Usage(f"{others[0]}: must be a bag")
    with tempfile.TemporaryDirectory(prefix="hammer_loads_check") as folder:
        found = [(splits[0], rows_of(splits, inputs.bag_options(given), folder)) for splits in inputs.recordings(given.files)]
    print(as_json(found) if given.json else "\n".join(as_text(name, rows) for name, rows in found))
    if wrong := [name for name, rows in found if any(row[1] == WRONG for row in rows)]:
        raise Problem(f"{', '.join(wrong)}: do not use before the cause is removed")


def parser():
    result = Parser(
        dict(metavar="IN.bag", help="bags; splits of one recording count as one"),
        prog="check", description="Whether recordings can be used: a line for each thing that must be right, and what to do.",
        epilog="Status: ok, look (usable, read the line), wrong (do not use), - (not known). Exit code 1 where a line is wrong.")
    result.add_argument("--json", action="store_true", help="print JSON")
    return result
