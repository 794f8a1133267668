"""Damaged and hostile databases: a page, or one line and exit code 1; nothing lost, nothing outside its folder."""
import csv
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

from support import REPORT, ReportTest, report, report_here
import sample_database as sample

from report import csv_tables, output  # noqa: E402  (support sets the path)

MUTATIONS = int(os.environ.get("HAMMER_LOADS_MUTATIONS", "40"))  # the night has more
LONGEST_S = 60
VALUES = ["NULL", "'text'", "x'00ff'", "-1", "0", "9223372036854775807", "-9223372036854775808", "1e308", "9e999", "-9e999",
          "''", "'\x1b[31m'", "0.5"]


def execute(path, *statements):
    db = sqlite3.connect(str(path), isolation_level=None)
    for statement in statements:
        db.execute(statement)
    db.close()


class Damaged(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "in.sqlite"
        sample.make(self.file, seconds=5.0, boom=False, classes=64)
        self.good = self.file.read_bytes()
        self.out = [self.directory / "out.html", self.directory / "csv"]

    def outcome(self):
        """(exit code, what it says); what is left belongs to a command that ended well."""
        signal.alarm(LONGEST_S)  # ends the test's program
        code, _, said = report_here(self.file, "--html", self.out[0], "--csv", self.out[1])
        signal.alarm(0)
        if code == 0:
            for name in self.out[1].iterdir():
                name.unlink()
            self.out[1].rmdir()
            self.out[0].unlink()
        elif self.out[0].exists():  # the page was whole before the tables failed
            self.out[0].unlink()
        self.assertEqual(os.listdir(self.directory), ["in.sqlite"], said)
        return code, said

    def check(self, what):
        code, said = self.outcome()
        self.assertIn(code, (0, 1), f"{what}: {said}")
        self.assertNotIn("Traceback", said, what)
        if code == 1:
            self.assertEqual(sum(not line.startswith("note: ") for line in said.splitlines()), 1, f"{what}: {said}")
        self.assertFalse([c for c in said if ord(c) < 32 and c != "\n"], what)
        return code

    def test_any_bytes_and_values_are_survived(self):
        self.assertEqual(self.check("the good one"), 0)
        draw, codes = random.Random(1), [0, 0]
        tables = [row[0] for row in sqlite3.connect(str(self.file)).execute(
            "SELECT name FROM sqlite_master WHERE type = 'table'")]
        for i in range(MUTATIONS):
            self.file.unlink()  # no connection to the one before sees this one
            self.file.write_bytes(self.good)
            what = self.damage_bytes(draw) if i % 2 else self.damage_value(draw, tables)
            codes[self.check(what)] += 1
        self.assertGreater(codes[0], 0)
        self.assertGreater(codes[1], MUTATIONS // 20)

    def damage_bytes(self, draw):
        data = bytearray(self.good)
        for _ in range(draw.choice((1, 10, 100))):
            data[draw.randrange(100, len(data))] = draw.randrange(256)
        del data[draw.choice((len(data), len(data), draw.randrange(len(data)))):]
        self.file.write_bytes(data)
        return "bytes"

    def damage_value(self, draw, tables):
        table, value = draw.choice(tables), draw.choice(VALUES)
        db = sqlite3.connect(str(self.file), isolation_level=None)
        column = draw.choice([row[1] for row in db.execute(f"PRAGMA table_info({table})")])
        what = f"UPDATE {table} SET {column} = {value}"
        try:
            db.execute(what)
        except sqlite3.IntegrityError:
            pass
        db.close()
        return what

    def test_numbers_without_end_leave_one_line_at_most(self):
        for statement in ("UPDATE turns SET amplitude = 9e999 WHERE turn > 5", "UPDATE blows SET energy = 9e999",
                          "UPDATE turn_loads SET maximum = 1e308, minimum = -1e308"):
            self.file.write_bytes(self.good)
            execute(self.file, statement)
            outcome = report(self.file, "--html", self.out[0], "--force")
            self.assertEqual(len(outcome.stderr.splitlines()), outcome.returncode, outcome.stderr)

    def test_a_table_name_outside_the_folder_is_refused(self):
        victim = self.directory.parent / f"victim{os.getpid()}.csv"
        execute(self.file, f'CREATE TABLE "../../{victim.stem}"(a)')
        code, said = self.outcome()
        self.assertEqual(code, 1)
        self.assertIn("must be of letters, digits and _", said)
        self.assertFalse(victim.exists())

    def test_an_endless_view_is_refused(self):
        execute(self.file, "DROP TABLE cycles", "CREATE VIEW cycles AS WITH RECURSIVE n(steps) AS "
                           "(SELECT 1 UNION ALL SELECT 1 FROM n) SELECT steps, 1 AS run_id, 1 AS channel, 1 AS low, "
                           "1 AS count FROM n")
        code, said = self.outcome()
        self.assertEqual(code, 1)
        self.assertIn("view cycles: must hold tables alone", said)

    def test_a_query_without_end_can_be_stopped(self):
        program = ("import signal, sys; sys.path.insert(0, sys.argv[2])\n"
                   "from report.database import Database\n"
                   "signal.signal(signal.SIGTERM, signal.default_int_handler)\n"
                   "database = Database(sys.argv[1])\n"
                   "try:\n    print('begins', flush=True)\n    database.value('WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT 1 FROM n) "
                   "SELECT count(*) FROM n')\n"
                   "except KeyboardInterrupt:\n    sys.exit(130)\n")
        running = subprocess.Popen([sys.executable, "-B", "-c", program, str(self.file), str(REPORT.parents[1])],
                                   stdout=subprocess.PIPE)
        self.assertEqual(running.stdout.readline(), b"begins\n")
        running.send_signal(signal.SIGTERM)
        self.assertEqual(running.wait(timeout=30), 130)
        running.stdout.close()


class Tables(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "in.sqlite"

    def test_no_cell_is_a_formula(self):
        texts = ["=1+1", "+1", "-1+1", "@SUM(A1)", "\t=1", "\r=1", "plain", "a=b"]
        sample.make(self.file, seconds=5.0, boom=False, warnings=[(f"k{i}", text) for i, text in enumerate(texts)])
        self.assertEqual(report(self.file, "--csv", self.directory / "out").returncode, 0)
        with open(self.directory / "out" / "warnings.csv", newline="", encoding="utf-8") as file:
            file.readline()  # units
            shown = [row["text"] for row in csv.DictReader(file) if row["key"].startswith("k")]
        self.assertEqual(len(shown), len(texts))
        self.assertFalse([cell for cell in shown if cell.startswith(csv_tables.FORMULA)])
        self.assertEqual([cell.lstrip("'") for cell in shown], [text.replace("\r", "\ufffd") for text in texts])

    def test_a_number_below_zero_stays_one(self):
        self.assertEqual([csv_tables.plain(v) for v in (-1.5, -1, None, "-1")], [-1.5, -1, None, "'-1"])

    def test_the_working_directory_stays(self):
        sample.make(self.file, seconds=5.0, boom=False)
        tables = self.directory / "tables"
        self.assertEqual(report(self.file, "--csv", tables).returncode, 0)
        before = {path.name: path.read_bytes() for path in tables.iterdir()}
        for out in (".", "../tables", str(self.directory)):
            done = subprocess.run([sys.executable, str(REPORT), str(self.file), "--csv", out, "--force"], cwd=str(tables),
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
            self.assertRefused(done, out, "working directory", "of its own")
        self.assertEqual({path.name: path.read_bytes() for path in tables.iterdir()}, before)
        self.assertEqual(report(self.file, "--csv", tables, "--force").returncode, 0)
        self.assertEqual({path.name: path.read_bytes() for path in tables.iterdir()}, before)

    def test_a_kill_while_replacing_leaves_one_whole_folder(self):
        """At whatever instant: one of the two is there, whole."""
        sample.make(self.file, seconds=5.0, boom=False)
        tables = self.directory / "tables"
        self.assertEqual(report(self.file, "--csv", tables).returncode, 0)
        before = {path.name: path.read_bytes() for path in tables.iterdir()}
        begin = time.monotonic()
        self.assertEqual(report(self.file, "--csv", tables, "--force").returncode, 0)
        whole = time.monotonic() - begin
        for part in range(8):
            running = subprocess.Popen([sys.executable, str(REPORT), str(self.file), "--csv", str(tables), "--force"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                running.wait(timeout=whole * (0.3 + 0.1 * part))
            except subprocess.TimeoutExpired:
                running.kill()
                running.wait()
            self.assertEqual({path.name: path.read_bytes() for path in tables.iterdir()}, before)

    def test_a_failure_half_way_leaves_the_old_directory(self):
        """The directory that was to be replaced is as it was."""
        tables = self.directory / "tables"
        tables.mkdir()
        (tables / "a.csv").write_text("file,\n")

        def fill(part):
            (part / "b.csv").write_text("file,\n")
            raise OSError(28, "No space left on device")

        with self.assertRaisesRegex(output.Problem, "No space left"):
            output.publish_directory(str(tables), fill, True)
        self.assertEqual([p.name for p in tables.iterdir()], ["a.csv"])
        self.assertEqual(os.listdir(self.directory), ["tables"])


if __name__ == "__main__":
    unittest.main()
