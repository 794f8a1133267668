"""Outputs: tables as CSV, every row read back; what is there already stays; nothing is left of what failed."""
import csv
import os
import signal
import sqlite3
import subprocess
import sys
import time

import pytest

from support import REPORT, assert_refused, execute, report, report_here
from report import output


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture
def tables(tmp_path):
    return tmp_path / "tables"


def test_csv_has_every_row_of_every_table(made, tables):
    files = [made(name, seconds=seconds, warnings=[("k", 'a "quoted", line')]) for name, seconds in (("a", 10.0), ("b", 20.0))]
    assert report_here(*files, "--csv", tables).returncode == 0
    for file in files:
        for table, in execute(file, "SELECT name FROM sqlite_master WHERE type = 'table'"):
            names = [row[1] for row in execute(file, f"PRAGMA table_info({table})")]
            stored = execute(file, f"SELECT * FROM {table}")
            expected = sorted([file.stem] + ["" if v is None else str(v) for v in row] for row in stored)
            with open(tables / (table + ".csv"), newline="", encoding="utf-8") as text:
                assert text.readline().startswith("# hammer_loads, units: file [-], ")
                header, *rows = csv.reader(text)
            assert header == ["file", *names]
            assert sorted(row for row in rows if row[0] == file.stem) == expected


def test_first_line_of_csv_has_the_units_of_the_table_columns(made, tables):
    file = made("a", "INSERT INTO columns VALUES('blows', 'energy', 'J', 'blow energy')")
    assert report_here(file, "--csv", tables).returncode == 0
    units = (tables / "blows.csv").read_text().splitlines()[0]
    assert " energy [J], " in units and " restitution [-], " in units


def test_no_cell_of_csv_is_a_formula(made, tables):
    texts = ["=1+1", "+1", "-1+1", "@SUM(A1)", "\t=1", "\r=1", "plain", "a=b"]
    file = made(warnings=[(f"k{i}", text) for i, text in enumerate(texts)])
    assert report_here(file, "--csv", tables).returncode == 0
    with open(tables / "warnings.csv", newline="", encoding="utf-8") as text:
        text.readline()  # units
        shown = [row["text"] for row in csv.DictReader(text) if row["key"].startswith("k")]
    assert not [cell for cell in shown if cell.startswith(output.FORMULA)]
    assert [cell.lstrip("'") for cell in shown] == [text.replace("\r", "\ufffd") for text in texts]
    assert [output.plain(v) for v in (-1.5, -1, None, "-1")] == [-1.5, -1, None, "'-1"]


def test_replaces_its_own_tables_alone(made, tables):
    first, second = made("a"), made("b")
    assert report_here(first, "--csv", tables).returncode == 0
    assert_refused(report_here(second, "--csv", tables), tables, "exists already")
    assert report_here(second, "--csv", tables, "--force").returncode == 0
    assert "b," in (tables / "runs.csv").read_text()
    for name in ("notes.txt", "notes.csv", "link.csv"):
        foreign = tables / name
        foreign.symlink_to(tables / "runs.csv") if name == "link.csv" else foreign.write_text("mine")
        before = contents(tables)
        assert_refused(report_here(second, "--csv", tables, "--force"), tables, f"{name} is none of its tables")
        assert contents(tables) == before
        foreign.unlink()


def test_replaces_its_own_pages_alone(made, tmp_path):
    file, out = made(), tmp_path / "out.html"
    for command in ((), ("--force",)):
        assert report_here(file, "--html", out, *command).returncode == 0
    assert_refused(report_here(file, "--html", out), out, "exists already", "--force")
    out.write_text("<html>thesis</html>")
    assert_refused(report_here(file, "--html", out, "--force"), out, "no page of this command")
    assert out.read_text() == "<html>thesis</html>"


def test_an_input_is_never_overwritten(made, tmp_path):
    file, link = made(), tmp_path / "link"
    before = file.read_bytes()
    os.link(file, link)
    for out in (file, link):
        assert_refused(report_here(file, "--html", out, "--force"), out, "is no page of this command")
    assert file.read_bytes() == before


def test_other_kinds_of_files_are_refused(made, tmp_path):
    file = made()
    fifo, link, folder = (tmp_path / name for name in ("fifo", "link", "folder"))
    os.mkfifo(fifo)
    link.symlink_to(tmp_path / "out.html")
    folder.mkdir()
    for out in (fifo, link, folder, "/dev/null"):
        assert_refused(report_here(file, "--html", out, "--force"), out, "is no regular file")
    assert_refused(report_here(file, "--csv", file.with_name("fifo"), "--force"), "is no directory")
    assert_refused(report_here(file, "--html", tmp_path / "none" / "out.html"), "No such file")


def test_the_working_directory_stays(made, tables, monkeypatch):
    file = made()
    assert report_here(file, "--csv", tables).returncode == 0
    before = contents(tables)
    monkeypatch.chdir(tables)
    for out in (".", "../tables", str(tables.parent)):
        assert_refused(report_here(file, "--csv", out, "--force"), out, "working directory", "of its own")
    assert contents(tables) == before


def test_a_kill_while_replacing_leaves_one_whole_folder(made, tables):
    file = made(seconds=5.0)
    assert report_here(file, "--csv", tables).returncode == 0
    before, begin = contents(tables), time.monotonic()
    assert report(file, "--csv", tables, "--force").returncode == 0
    whole = time.monotonic() - begin
    for part in range(0, 8, 2):
        running = subprocess.Popen([sys.executable, str(REPORT), str(file), "--csv", str(tables), "--force"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            running.wait(timeout=whole * (0.3 + 0.1 * part))
        except subprocess.TimeoutExpired:
            running.kill()
            running.wait()
        assert contents(tables) == before


@pytest.mark.parametrize("stop", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failure_half_way_leaves_the_old_directory(tables, stop, monkeypatch):
    """The failure comes while the new one is filled, and between the two renames."""
    tables.mkdir()
    (tables / "a.csv").write_text("file,\n")

    def fill(part):
        (part / "b.csv").write_text("file,\n")
        raise stop

    with pytest.raises((output.Problem, KeyboardInterrupt)):
        output.publish_directory(str(tables), fill, True)
    rename = os.rename

    def rename_once(old, new):
        if new == str(tables) and old.name == "part":
            raise stop
        rename(old, new)

    monkeypatch.setattr(os, "rename", rename_once)
    with pytest.raises((output.Problem, KeyboardInterrupt)):
        output.publish_directory(str(tables), lambda part: None, True)
    assert [p.name for p in tables.iterdir()] == ["a.csv"]
    assert os.listdir(tables.parent) == ["tables"]


def test_an_interruption_leaves_nothing(made, tmp_path):
    """By a signal while it waits for a file that is locked."""
    file = made()
    locked = sqlite3.connect(str(file), isolation_level=None)
    locked.execute("BEGIN EXCLUSIVE")
    running = subprocess.Popen([sys.executable, str(REPORT), str(file), "--html", str(tmp_path / "out.html")],
                               stderr=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True)
    running.send_signal(signal.SIGTERM)
    _, err = running.communicate(timeout=30)
    locked.close()
    assert running.returncode in (130, -signal.SIGTERM)  # the latter before Python has begun
    assert "Traceback" not in err
    assert os.listdir(tmp_path) == [file.name]
