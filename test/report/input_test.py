"""Bad, damaged and hostile inputs: a page, or one line and an exit code; nothing outside of the output."""
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys

import pytest

from support import REPORT, SOURCE, assert_refused, execute, report, report_here

MUTATIONS = int(os.environ.get("HAMMER_LOADS_MUTATIONS", "8"))  # the night has more
LONGEST_S = 60
VALUES = ["NULL", "'text'", "x'00ff'", "-1", "0", "9223372036854775807", "-9223372036854775808", "1e308", "9e999", "-9e999",
          "''", "'\x1b[31m'", "0.5"]
ENDLESS = "WITH RECURSIVE n(steps) AS (SELECT 1 UNION ALL SELECT 1 FROM n) SELECT "


def refused(file, *words):
    before = sorted(os.listdir(file.parent))
    assert_refused(report_here(file, "--html", file.parent / "out.html", "--csv", file.parent / "csv"), file, *words)
    assert sorted(os.listdir(file.parent)) == before


@pytest.mark.parametrize("sql, words", [
    ("PRAGMA application_id = 1", ["another database"]), ("DROP TABLE cycles", ["no such table: cycles"]),
    ("PRAGMA user_version = 0", ["older", "version, 0;", "reads version 1"]), ("PRAGMA user_version = 2", ["newer"]),
    (f"CREATE VIEW endless AS {ENDLESS} steps FROM n", ["view endless: must hold tables alone"])])
def test_other_databases_are_refused(made, sql, words):
    refused(made("in", sql), *words)


def test_other_files_are_refused(made, tmp_path):
    file = made("in")
    whole = file.read_bytes()
    for content in (b"", b"#ROSBAG V2.0\n", b"SQLite format 2\0" * 100):
        file.write_bytes(content)
        refused(file, "is no SQLite file")
    file.write_bytes(whole[:len(whole) // 2 // 4096 * 4096])
    refused(file, "cannot be read")
    os.mkfifo(tmp_path / "fifo")
    refused(tmp_path / "fifo", "is no regular file")
    refused(tmp_path / "none.sqlite", "No such file")
    assert_refused(report_here(tmp_path, "--html", "x.html"), "is no regular file")


def test_a_table_name_outside_the_folder_is_refused(made, tmp_path):
    file = made("in", 'CREATE TABLE "../../victim"(a)')
    assert_refused(report_here(file, "--csv", tmp_path / "csv"), "must be of letters, digits and _")
    assert os.listdir(tmp_path) == ["in.sqlite"]
    assert not (tmp_path.parent / "victim.csv").exists()


def outcome_of(file):
    """Exit code of page and tables; only a command that ends well leaves something, which is removed."""
    page, tables = file.parent / "out.html", file.parent / "csv"
    signal.alarm(LONGEST_S)  # ends the test's program
    done = report_here(file, "--html", page, "--csv", tables)
    signal.alarm(0)
    page.unlink(missing_ok=True)  # where the tables fail, the page was whole before
    if done.returncode == 0:
        shutil.rmtree(tables)
    assert os.listdir(file.parent) == [file.name], done.stderr
    assert done.returncode in (0, 1), done.stderr
    assert sum(not line.startswith("note: ") for line in done.stderr.splitlines()) == done.returncode, done.stderr
    assert not [c for c in done.stderr if ord(c) < 32 and c != "\n"]
    return done.returncode


def damage_bytes(file, draw):
    data = bytearray(file.read_bytes())
    for _ in range(draw.choice((1, 10, 100))):
        data[draw.randrange(100, len(data))] = draw.randrange(256)
    del data[draw.choice((len(data), len(data), draw.randrange(len(data)))):]
    file.write_bytes(data)


def damage_value(file, draw):
    table = draw.choice([name for name, in execute(file, "SELECT name FROM sqlite_master WHERE type = 'table'")])
    column = draw.choice([row[1] for row in execute(file, f"PRAGMA table_info({table})")])
    try:
        execute(file, f"UPDATE {table} SET {column} = {draw.choice(VALUES)}")
    except sqlite3.IntegrityError:
        pass


def test_any_bytes_and_values_are_survived(made):
    file = made("in", seconds=5.0, classes=64)
    good, draw = file.read_bytes(), random.Random(1)
    codes = [outcome_of(file)]
    for i in range(MUTATIONS):
        file.unlink()  # no connection to the one before sees this one
        file.write_bytes(good)
        (damage_bytes if i % 2 else damage_value)(file, draw)
        codes.append(outcome_of(file))
    assert codes[0] == 0
    assert codes[1:].count(0) > 0
    assert codes[1:].count(1) > MUTATIONS // 20


@pytest.mark.parametrize("sql", ["UPDATE turns SET amplitude = 9e999 WHERE turn > 5",
                                 "UPDATE turn_loads SET maximum = 1e308, minimum = -1e308"])
def test_numbers_without_end_leave_one_line_at_most(made, sql):
    outcome_of(made("in", sql, seconds=5.0))


def test_a_query_without_end_can_be_stopped(made):
    program = ("import signal, sys; sys.path.insert(0, sys.argv[2])\n"
               "from report.database import Database\n"
               "signal.signal(signal.SIGTERM, signal.default_int_handler)\n"
               "database = Database(sys.argv[1])\n"
               "try:\n    print('begins', flush=True)\n"
               f"    database.value('{ENDLESS} count(*) FROM n')\n"
               "except KeyboardInterrupt:\n    sys.exit(130)\n")
    running = subprocess.Popen([sys.executable, "-B", "-c", program, str(made()), str(REPORT.parents[1])], stdout=subprocess.PIPE)
    assert running.stdout.readline() == b"begins\n"
    running.send_signal(signal.SIGTERM)
    assert running.wait(timeout=30) == 130
    running.stdout.close()


@pytest.mark.parametrize("arguments", [(), ("a.sqlite",), ("--html", "x.html"), ("a.sqlite", "--html", "x", "--colour")])
def test_wrong_usage_is_refused(arguments):
    assert_refused(report_here(*arguments), "report: ", "--help", code=2)


def test_a_missing_python_package_is_named(made, tmp_path):
    (tmp_path / "jinja2").mkdir()
    (tmp_path / "jinja2" / "__init__.py").write_text("raise ImportError('No module named jinja2')\n")
    done = report(made(), "--html", tmp_path / "x.html", env=dict(os.environ, PYTHONPATH=str(tmp_path)))
    assert_refused(done, "No module named jinja2")


def test_help_and_version_are_printed():
    assert "--html OUT.html" in report_here("--help").stdout
    version = (SOURCE / "package.xml").read_text().split("<version>")[1].split("<")[0]
    assert report("--version").stdout == f"hammer_loads {version}\n"
