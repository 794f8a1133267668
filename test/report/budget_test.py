"""Uncertainty budgets: of a recording by the command, combined over runs, on the page."""
import json
import math
import sqlite3
import subprocess
import unittest

from support import HERE, ReportTest, program

import sample_database as sample
from report import budget
from report.budget import budget_of
from report.database import Database
from report.subjects import subjects_of


def with_budget(path, rows, restarts=0):
    sample.make(path, seconds=20.0, boom=False, restarts=restarts)
    db = sqlite3.connect(str(path))
    db.execute("CREATE TABLE budget(run_id INTEGER, quantity TEXT, unit TEXT, value REAL, std REAL, source TEXT, share REAL)")
    db.executemany("INSERT INTO budget VALUES(1,?,?,?,?,?,?)",
                   [(quantity, sample.unit_of(quantity), *row) for quantity, *row in rows])
    db.commit()
    db.close()


class Budget(ReportTest):
    ROWS = [("blow/energy", 900.0, 20.0, "rocker_mass_kg", 0.64), ("blow/energy", 900.0, 20.0, "readings", 0.36)]

    def test_largest_source_comes_first_with_the_gain_of_halving_it(self):
        path = self.directory / "a.sqlite"
        with_budget(path, self.ROWS)
        figure, = budget_of(subjects_of(Database(path))[0])
        self.assertEqual([source for source, _ in figure.shares], ["rocker_mass_kg", "readings"])
        self.assertAlmostEqual(figure.halved, math.sqrt(0.25 * 0.64 * 400.0 + 0.36 * 400.0))
        self.assertEqual((figure.unit, figure.value), ("J", 900.0))

    def test_page_has_table_and_picture(self):
        path = self.directory / "a.sqlite"
        with_budget(path, self.ROWS)
        page = self.page_of(path)
        self.assertIn("rocker_mass_kg (64 %)", page.text)
        self.assertIn("Uncertainty budget", page.tables)

    def test_bars_are_as_long_as_the_shares(self):
        path = self.directory / "a.sqlite"
        with_budget(path, self.ROWS + [("equivalent_range_3/joint_loads/boom_joint/total_torque", 9.0, 1.0, "readings", 1.0)])
        parts = [(given["title"], float(given["style"].split(": ")[1].rstrip("%")))
                 for tag, given in self.page_of(path).tags if tag == "i" and "style" in given]
        self.assertEqual([part for part in parts if not part[0].startswith("the rest")],
                         [("rocker_mass_kg: 64 %", 64.0), ("readings: 36 %", 36.0), ("readings: 100 %", 100.0)])

    def test_a_file_without_a_budget_is_reported(self):
        path = self.directory / "b.sqlite"
        sample.make(path, seconds=20.0, boom=False)
        self.assertIn("keeps no budget", self.page_of(path).text)

    @unittest.skipUnless(program("budget") and program("process_bag"), "needs the built commands")
    def test_command_reads_a_bag(self):
        bag = HERE.parent / "data" / "mo100_1khz.bag"
        outcome = subprocess.run([program("budget"), str(bag), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 encoding="utf-8")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        machine, = json.loads(outcome.stdout)["machines"]
        found = {figure["quantity"]: figure for figure in machine["figures"]}
        for quantity in ("pulse/turn_impulse_z", "pulse/amplitude", "blow/energy",
                         "equivalent_range_3/hull_wrench/force_z"):
            shares = [source["share"] for source in found[quantity]["sources"]]
            self.assertAlmostEqual(sum(shares), 1.0, delta=1e-9)
            self.assertEqual(shares, sorted(shares, reverse=True))
            self.assertGreater(found[quantity]["std"], found[quantity]["std_with_largest_halved"])
        self.assertIn("rocker_mass_kg", [s["source"] for s in found["pulse/turn_impulse_z"]["sources"]])

    def test_negligible_shares_are_one_line(self):
        shares = [("rocker_mass_kg", 0.9991), ("readings", 5e-4), ("supply", 3e-4), ("crank_mass_kg", 1e-4)]
        self.assertEqual(budget.share_lines(shares), ["   99.9 %  rocker_mass_kg", "    0.1 %  readings", "    0.0 %  2 more"])
        self.assertEqual(budget.share_lines(shares[:1]), ["   99.9 %  rocker_mass_kg"])

    @unittest.skipUnless(program("budget"), "needs the built command")
    def test_wrong_files_are_named(self):
        path = self.directory / "b.sqlite"
        sample.make(path, seconds=20.0, boom=False)
        for arguments, code, words in (([path], 1, "holds no budget"), ([self.directory / "no.bag"], 1, "no.bag"),
                                       ([path, "--json", "--csv"], 2, "not allowed")):
            outcome = subprocess.run([program("budget"), *map(str, arguments)], stdout=subprocess.PIPE,
                                     stderr=subprocess.PIPE, encoding="utf-8")
            self.assertEqual(outcome.returncode, code, outcome.stderr)
            self.assertIn(words, outcome.stderr)
            self.assertEqual(len(outcome.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
