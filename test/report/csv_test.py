"""Tables as CSV: every row of every table, read back."""
import csv
import sqlite3
import unittest

from support import ReportTest, report
import sample_database as sample


class Csv(ReportTest):
    def setUp(self):
        super().setUp()
        self.files = [self.directory / "a.sqlite", self.directory / "b.sqlite"]
        for i, file in enumerate(self.files):
            sample.make(file, seconds=10.0 * (i + 1), boom=False, warnings=[("k", 'a "quoted", line')])
        self.out = self.directory / "tables"

    def test_every_row_of_every_table(self):
        self.assertEqual(report(*self.files, "--csv", self.out).returncode, 0)
        for file in self.files:
            db = sqlite3.connect(str(file))
            for table, in db.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall():
                cursor = db.execute(f"SELECT * FROM {table}")
                names = [column[0] for column in cursor.description]
                expected = sorted([file.stem] + ["" if v is None else str(v) for v in row] for row in cursor)
                with open(self.out / (table + ".csv"), newline="", encoding="utf-8") as text:
                    self.assertTrue(text.readline().startswith("# hammer_loads, units: file [-], "))
                    header, *rows = csv.reader(text)
                self.assertEqual(header, ["file", *names])
                self.assertEqual(sorted(row for row in rows if row[0] == file.stem), expected)
            db.close()

    def test_first_line_has_the_units_of_the_table_columns(self):
        db = sqlite3.connect(str(self.files[0]))
        db.execute("CREATE TABLE columns(table_name TEXT, column_name TEXT, unit TEXT, description TEXT)")
        db.execute("INSERT INTO columns VALUES('blows', 'energy', 'J', 'blow energy')")
        db.commit()
        db.close()
        self.assertEqual(report(self.files[0], "--csv", self.out).returncode, 0)
        with open(self.out / "blows.csv", encoding="utf-8") as text:
            units = text.readline()
        self.assertIn(" energy [J], ", units)
        self.assertIn(" restitution [-], ", units)

    def test_replaces_its_own_alone(self):
        self.assertEqual(report(self.files[0], "--csv", self.out).returncode, 0)
        self.assertRefused(report(self.files[1], "--csv", self.out), self.out, "exists already")
        self.assertEqual(report(self.files[1], "--csv", self.out, "--force").returncode, 0)
        self.assertIn("b,", (self.out / "runs.csv").read_text())
        (self.out / "notes.txt").write_text("mine")
        self.assertRefused(report(self.files[1], "--csv", self.out, "--force"), self.out, "notes.txt")
        self.assertEqual((self.out / "notes.txt").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
