"""Cycles, damage-equivalent loads and damage: against ASTM E1049's example, a plain count of the whole, and life."""
import json
import random
import sqlite3
import subprocess
import unittest

import numpy

from support import ReportTest, program
import sample_database as sample
from report.cycles import SLOPES, Count, Curve, at_alternating, equivalent_range
from report.database import Database
from report.ledger import epochs_of
from report.subjects import subjects_of

FIGURE_6 = [-2, 1, -3, 5, -1, 3, -4, 4, -2]  # of the standard


class Rainflow(unittest.TestCase):
    def test_counts_follow_the_standards_example(self):
        count = Count(-10.5, 10.5, 21)
        count.join([level + 10 for level in FIGURE_6])
        by_range = {}
        for r, _, n in count.cycles().T:
            by_range[round(r)] = by_range.get(round(r), 0.0) + n
        self.assertEqual(by_range, {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5})
        for slope, expected in ((3.0, 10.3039982), (4.0, 9.58741061), (5.0, 9.25325663), (10.0, 8.82000396)):
            self.assertAlmostEqual(equivalent_range(count.cycles(), slope, 1.0)[0], expected, delta=5e-8)

    def test_pieces_add_to_a_plain_count_of_the_whole(self):
        rng = random.Random(5)
        for _ in range(300):
            series = [rng.randrange(12) for _ in range(rng.randrange(2, 60))]
            closed, residue = sample.count_all(series)
            count = Count(0.0, 12.0, 12)
            at = 0
            while at < len(series):
                end = at + rng.randrange(1, 9)
                piece_closed, piece_residue = sample.count_all(series[at:end])
                count.add_closed((b - a, a, n) for (a, b), n in piece_closed.items())
                count.join(piece_residue)
                at = end
            self.assertEqual(count.residue, residue)
            self.assertEqual(count.closed, {(b - a, a): n for (a, b), n in closed.items()})

    def test_nothing_gives_no_cycles(self):
        cycles = Count(0.0, 1.0, 4).cycles()
        self.assertEqual(cycles.shape, (3, 0))
        self.assertEqual(equivalent_range(cycles, 3.0, 10.0), (0.0, None))


class Damage(unittest.TestCase):
    def test_mean_stress_follows_fkm(self):
        for amplitude, mean, expected in ((2, 2, 2.6), (3, 3, 3.9), (3, 2, 3.6), (2, 4, 2.836363), (2, 3, 2.718181),
                                          (1, 3, 1.536363), (2, 1, 2.3), (2, -2, 1.4), (2, -9, 1.4)):
            self.assertAlmostEqual(at_alternating(amplitude, mean, 0.3)[0], expected, delta=2e-6)

    def test_std_is_the_difference(self):
        """All ranges larger by one deviation."""
        cycles, shift = numpy.array([(50.0, 120.0), (3.0, -8.0), (10.0, 2.5)]), 1e-5
        moved = cycles + [[shift], [0.0], [0.0]]
        for slope in SLOPES:
            value, deviation = equivalent_range(cycles, slope, 7.0, (shift, 0.0))
            self.assertAlmostEqual(equivalent_range(moved, slope, 7.0)[0] - value, deviation, delta=1e-4 * deviation)
            part = equivalent_range(cycles, slope, 7.0, (0.0, 0.02))
            self.assertAlmostEqual(part[1] / part[0], 0.02)
        curve = Curve(100.0, 1e6, 3.0, 5.0, 0.3)
        value, deviation = curve.damage(cycles, (shift, 0.0))
        self.assertAlmostEqual(curve.damage(moved)[0] - value, deviation, delta=1e-4 * deviation)


class Recording(ReportTest):
    def test_runs_of_a_machine_add(self):
        """Two runs joined are one count of both series; the hours add."""
        file = self.directory / "two.sqlite"
        sample.make(file, seconds=100.0, runs=2, boom=False, classes=64)
        channel = subjects_of(Database(file))[0].counted_channels()[1]
        db = sqlite3.connect(str(file))
        count = db.execute("SELECT sum(count) FROM cycles WHERE channel = 1").fetchone()[0]
        points = [[c for c, in db.execute("SELECT class FROM residues WHERE channel = 1 AND run_id = ? ORDER BY place",
                                          (run,))] for run in (1, 2)]
        db.close()
        closed, residue = sample.count_all(points[0] + points[1])
        self.assertEqual(channel.count.residue, residue)
        self.assertEqual(sum(channel.count.closed.values()), count + sum(closed.values()))
        self.assertAlmostEqual(channel.hours, 200.0 / 3600.0, delta=2e-4)


LEDGER = """
CREATE TABLE epochs(epoch INTEGER PRIMARY KEY, machine TEXT, equivalent_cycles_per_hour REAL);
CREATE TABLE channels(channel INTEGER PRIMARY KEY, epoch INTEGER, name TEXT, unit TEXT, least REAL, greatest REAL,
  classes INTEGER, sn_knee_range REAL, sn_knee_cycles REAL, sn_slope REAL, sn_slope_below REAL,
  mean_stress_sensitivity REAL);
CREATE TABLE runs(run INTEGER PRIMARY KEY, name TEXT, epoch INTEGER, pieces INTEGER, parameters TEXT,
  messages INTEGER);
CREATE TABLE days(day INTEGER PRIMARY KEY, epoch INTEGER, run INTEGER, date TEXT, duration_ns INTEGER, turns INTEGER);
CREATE TABLE tallies(channel INTEGER, day INTEGER, counted INTEGER, skipped INTEGER, below INTEGER, above INTEGER,
  gaps INTEGER, deviations INTEGER, deviation_sum INTEGER, least REAL, greatest REAL, range_square INTEGER,
  range_own INTEGER, range_common INTEGER, PRIMARY KEY(channel, day));
CREATE TABLE cycles(channel INTEGER, day INTEGER, steps INTEGER, low INTEGER, count INTEGER,
  PRIMARY KEY(channel, day, steps, low));
CREATE TABLE residues(channel INTEGER, run INTEGER, place INTEGER, class INTEGER, PRIMARY KEY(channel, run, place));
CREATE TABLE marks(mark INTEGER, run INTEGER, PRIMARY KEY(mark, run));
INSERT INTO epochs VALUES(1, 'mo100', 3600.0);
INSERT INTO channels VALUES(1, 1, 'hull_wrench/force_z', 'N', -2e5, 2e5, 512, NULL, NULL, NULL, NULL, NULL);
INSERT INTO channels VALUES(2, 1, 'stress/weld', 'MPa', -4e2, 4e2, 256, 80.0, 1e7, 3.0, 5.0, 0.3);
INSERT INTO runs VALUES(1, 'a', 1, 3, '', 3000);
INSERT INTO runs VALUES(2, 'b', 1, 1, '', 3000);
INSERT INTO days VALUES(1, 1, 1, '2026-01-31', 7200000000000, 36000);
INSERT INTO days VALUES(2, 1, 2, '2026-02-01', 1800000000000, 9000);
"""


def make_ledger(path):
    """Counts of a random series over two days, a run on each."""
    rng, db = random.Random(3), sqlite3.connect(str(path))
    db.executescript(LEDGER)
    for channel, classes in ((1, 512), (2, 256)):
        for day in (1, 2):
            series = [min(classes - 1, max(0, int(rng.gauss(classes / 2, classes / 9)))) for _ in range(3000)]
            closed, residue = sample.count_all(series)
            db.executemany("INSERT INTO cycles VALUES(?,?,?,?,?)",
                           [(channel, day, b - a, a, n) for (a, b), n in closed.items()])
            db.executemany("INSERT INTO residues VALUES(?,?,?,?)",
                           [(channel, day, place, c) for place, c in enumerate(residue)])
            db.execute("INSERT INTO tallies VALUES(?,?,3000,2,1,0,1,3000,?,-1e3,1e3,0,0,0)", (channel, day, 3000 * 300 * day))
    db.execute(f"PRAGMA application_id = {0x484C4C31}")
    db.execute("PRAGMA user_version = 1")
    db.commit()
    db.close()


class Ledger(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "machine.sqlite"
        make_ledger(self.file)

    def assertSame(self, ours, theirs):
        for mine, other in zip(ours, (theirs["value"], theirs["std"]) if theirs else (None, None)):
            if other is None:
                self.assertIsNone(mine)
            else:
                self.assertAlmostEqual(mine, other, delta=1e-12 * abs(other))

    @unittest.skipUnless(program("life"), "needs the built command life")
    def test_figures_are_those_of_life(self):
        outcome = subprocess.run([program("life"), str(self.file), "--json"], stdout=subprocess.PIPE, check=True)
        theirs = json.loads(outcome.stdout)["epochs"][0]
        epoch = epochs_of(Database(self.file))[0]
        for channel, expected in zip(epoch.channels(), theirs["channels"]):
            self.assertSameFigures(channel, expected)
            self.assertEqual(channel.sums["below"] + channel.sums["above"], expected["below"] + expected["above"])
        for at, (_, days) in enumerate(epoch.by_date()):
            for channel, expected in zip(epoch.channels(days), theirs["channels"]):
                self.assertSameFigures(channel, expected["days"][at])

    def assertSameFigures(self, channel, expected):
        for slope, figure in zip(SLOPES, channel.equivalents()):
            self.assertSame(figure, expected[f"equivalent_range_{slope:g}"])
        self.assertSame(channel.damage(), expected["damage"])
        self.assertSame(channel.remaining_hours(), expected["remaining_hours"])
        self.assertEqual(channel.cycles[2].sum(), expected["cycles"])

    def test_the_page_shows_the_epoch(self):
        page = self.page_of(self.file)
        self.assertIn("Epoch 1: 2.5 hours", page.text)
        self.assertEqual(sorted(page.table("By the day on which a cycle closed")), ["2026-01-31", "2026-02-01"])

    def test_a_ledger_is_shown_beside_a_recording(self):
        other = self.directory / "rec.sqlite"
        sample.make(other, seconds=20.0, boom=False)
        page = self.page_of(other, self.file)
        self.assertIn("Over all revolutions", page.tables)
        self.assertEqual(len(page.tables["Damage-equivalent loads"]), 2)

    def test_an_empty_ledger_has_no_epoch(self):
        db = sqlite3.connect(str(self.file))
        db.execute("DELETE FROM epochs")
        db.commit()
        db.close()
        self.assertIn("no epoch yet", self.page_of(self.file).text)


if __name__ == "__main__":
    unittest.main()
