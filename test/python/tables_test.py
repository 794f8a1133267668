"""Counted cycles against the example of ASTM E1049, databases against Python's own SQLite."""
import math
import os
import sqlite3
import tempfile
import unittest

import support  # noqa: F401

import hammer_loads_py as hl
import numpy as np
import sample_database


class Cycles(unittest.TestCase):
    def test_counts_follow_the_standards_example(self):
        cycles = hl.count_cycles([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
        by_range = {}
        for r, n in zip(cycles["range"], cycles["count"]):
            by_range[r] = by_range.get(r, 0.0) + n
        self.assertEqual(by_range, {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5})  # X1, figure X1.1

    def test_nothing_and_nan_give_no_cycles(self):
        self.assertEqual(hl.count_cycles([])["range"].size, 0)
        np.testing.assert_array_equal(hl.count_cycles([0.0, math.nan, 2.0, math.inf, 0.0])["range"], [2.0])
        self.assertEqual(support.message(hl.count_cycles, [1.0], full_scale=(2.0, 1.0)),
                         "full scale: 2 to 1, must be finite and the first below the second")
        self.assertIn("one", support.message(hl.count_cycles, [[1.0, 2.0]]))


class Databases(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "work's.sqlite")

    def tearDown(self):
        self.folder.cleanup()

    def test_every_table_is_what_sqlite_has(self):
        sample_database.make(self.path, seconds=20.0, boom=True)
        tables = hl.read_database(self.path)
        connection = sqlite3.connect(self.path)
        names = [n for n, in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        self.assertEqual(sorted(tables), sorted(names))
        for name in names:
            rows = connection.execute(f'SELECT * FROM "{name}"')
            columns = [d[0] for d in rows.description]
            self.assertEqual(list(tables[name]), columns)
            for column, values in zip(columns, zip(*rows.fetchall())):
                got = tables[name][column]
                for a, b in zip(got.tolist(), values):
                    self.assertTrue(a == b or (b is None and (a is None or math.isnan(a))), (name, column, a, b))
                self.assertEqual(len(got), len(values))
        self.assertGreater(len(tables["turns"]["turn"]), 50)
        self.assertEqual(tables["turns"]["stamp_ns"].dtype, np.int64)
        connection.close()

    def test_words_are_the_report_s(self):
        self.assertEqual(support.message(hl.read_database, "/no/such"),
                         "/no/such: cannot be read: No such file or directory")
        with open(self.path, "w") as file:
            file.write("a,b\n1,2\n" * 10)
        self.assertEqual(support.message(hl.read_database, self.path), f"{self.path}: is no SQLite file")


if __name__ == "__main__":
    unittest.main()
