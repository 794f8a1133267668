"""Work, its pauses, its values, and what they cost: the page against formulas and SQL of the same database."""
import os
import sqlite3
import statistics
import subprocess
import sys
import unittest

from support import REPORT, Reader, ReportTest, value as number
import sample_database as sample

IMPOSSIBLE = ("UPDATE blows SET restitution = NULL, energy = NULL WHERE turn IN (10, 20, 30, 40, 50)",)


class Work(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "site.sqlite"
        sample.make(self.file, seconds=200.0)

    def ask(self, *sql):
        db = sqlite3.connect(str(self.file))
        rows = [db.execute(line).fetchall() for line in sql][-1]
        db.commit()
        db.close()
        return rows

    def figures(self, page):
        """{name: value} of the large numbers."""
        return dict(zip(self._parts(page, "dt"), self._parts(page, "dd")))

    @staticmethod
    def _parts(page, tag):
        return [text for name, text in page.pieces if name == tag]

    def test_nothing_is_drawn_where_there_was_no_work(self):
        """Two runs, one with a pause, have no line from a blow before the pause to the one after it."""
        sample.make(self.file, seconds=100.0, runs=2)
        self.ask(*(f"DELETE FROM {t} WHERE run_id = 1 AND turn BETWEEN 200 AND 260" for t in ("turns", "blows", "turn_loads")))
        page = self.page_of(self.file)
        pictures = [p for p in page.pictures if p.title.startswith(("Blow rate:", "Blow energy:", "Restitution:", "joint_loads/"))]
        self.assertGreater(len(pictures), 5)
        for picture in pictures:
            for kind in picture.classes("line"):
                lines = [piece for piece in picture.curves(kind) if len(piece) > 2]
                self.assertEqual(len(lines) % 3, 0, picture.title)  # three stretches of work, of the mean or of each edge
        minutes = [(line[0][0], line[-1][0]) for line in page.drawn("Blow energy:").curves("line first")]
        for (first, last), (begin, end) in zip(minutes, ((0.0, 39.8), (52.2, 100.0), (100.0, 200.0))):
            self.assertAlmostEqual(60.0 * first, begin, delta=0.7)
            self.assertAlmostEqual(60.0 * last, end, delta=0.7)

    def test_blows_per_hour_and_energy_of_all(self):
        blows, seconds = self.ask("SELECT blows, duration FROM runs")[0]
        figures = self.figures(self.page_of(self.file))
        self.assertAlmostEqual(number(figures["blows per hour of work"]), blows / seconds * 3600.0, delta=1.0)
        energy = self.ask("SELECT sum(energy) FROM blows")[0][0]
        self.assertAlmostEqual(number(figures["energy of all blows"]), energy / 1e3, delta=1e-3 * energy / 1e3)

    def page_after(self, name, *sql):
        """Page of a new file: a file that was read is not written again."""
        self.file = self.directory / name
        sample.make(self.file, seconds=20.0)
        self.ask("SELECT 1", *sql)
        return self.page_of(self.file, options=["--force"])

    def test_exceeded_limits_are_shown(self):
        limit = "INSERT INTO parameters VALUES(1, 'limit_peak_force_warn_N', '9000.0', NULL)"
        self.assertIn("No limits were given", self.page_after("none.sqlite").text)
        kept = self.page_after("kept.sqlite", limit)
        self.assertIn("No limit was exceeded", kept.text)
        self.assertNotIn("limit exceeded", kept.text)
        start = 1700000060 * sample.SECOND
        alarm = "INSERT INTO alarms VALUES(1, '%s', %d, 'N', %s, %s, %s, %d, %d, %d)"
        page = self.page_after(
            "exceeded.sqlite", limit,
            alarm % ("peak_force", 1, 9120.0, 87.0, 9000.0, start, start + sample.SECOND, 6),
            alarm % ("peak_force", 1, 9456.0, 91.0, 9000.0, start + 9 * sample.SECOND, start + 9 * sample.SECOND, 1),
            alarm % ("hold_down_force", 2, 3100.0, "NULL", 3000.0, start, start + sample.SECOND, 1234))
        lines = [words for tag, words in page.pieces if tag == "li" and words.startswith("limit exceeded")]
        self.assertEqual(lines, ["limit exceeded (ERROR): hold_down_force 3100 N, limit 3000 N, in 1\u202f234 revolutions",
                                 "limit exceeded (WARN): peak_force 9\u202f456 \u00b1 91 N, limit 9000 N, in 7 revolutions"])
        row = page.table("Limits exceeded")["peak_force"]
        self.assertEqual((row["Level"], row["Farthest beyond it"], row["Revolutions"], row["Times"]),
                         ("WARN", "9\u202f456 \u00b1 91 N", "7", "2"))
        self.assertIn("2023-11-14 22:14:20", row["First"])

    def test_a_measured_load_is_compared_with_the_computed_one(self):
        self.assertNotIn("Measured reference", self.page_after("alone.sqlite").text)
        page = self.page_after("measured.sqlite", "INSERT INTO reference VALUES(1, 'force_z', 'N', 20000, 4200.0, 84.0, -30.0, "
                               "0.985, 0.99871, 0.968)")
        row = page.table("Computed and measured load")["force_z"]
        self.assertEqual((row["Samples"], row["Measured, rms"], row["Error, rms"], row["Error, relative"], row["Bias"]),
                         ("20\u202f000", "4.2 kN", "0.084 kN", "2 %", "\u22120.03 kN"))
        self.assertEqual((row["Scale"], row["Correlation"], row["Within two"]), ("0.985", "0.99871", "96.8 %"))

    def test_median_and_spread_are_those_of_the_blows(self):
        energies = sorted(e for e, in self.ask("SELECT energy FROM blows"))
        median, spread = self.figures(self.page_of(self.file))["blow energy, median \u00b1 spread"].split("\u00b1")
        self.assertAlmostEqual(number(median), statistics.median(energies), delta=0.1)
        inside = [e for e in energies if abs(e - number(median)) <= number(spread)]
        self.assertAlmostEqual(len(inside) / len(energies), 0.6827, delta=0.05)

    def test_std_of_the_measurement_where_it_is_known(self):
        self.ask("ALTER TABLE blows ADD COLUMN energy_std REAL", "UPDATE blows SET energy_std = 7.0")
        figures = self.figures(self.page_of(self.file))
        self.assertTrue(figures["blow energy, median \u00b1 deviation"].endswith("\u00b1 7.0 J"), figures)

    def test_noise_within_the_std_looks_like_it(self):
        """An axis of values is not finer than the standard deviation of their measurement."""
        self.ask("ALTER TABLE blows ADD COLUMN restitution_std REAL", "UPDATE blows SET restitution_std = 0.3")
        picture = self.page_of(self.file).drawn("Restitution:")
        heights = [y for piece in picture.curves("band first") for _, y in piece]
        axis = picture.y_range()
        self.assertGreaterEqual(axis[1] - axis[0], 2 * 0.3)
        self.assertLess(max(heights) - min(heights), 0.3 * (axis[1] - axis[0]))

    def test_histograms_hold_every_blow(self):
        page = self.page_of(self.file)
        for caption, sql in (("Blows by blow energy", "SELECT energy FROM blows"),
                             ("Blows by peak force along the tool", "SELECT amplitude / 1000 FROM turns")):
            values = [v for v, in self.ask(sql)]
            rows = page.table(caption)
            self.assertEqual(sum(number(row["Blows"]) for row in rows.values()), len(values))
            for edges, row in rows.items():
                low, high = map(number, edges.split(" to "))
                self.assertEqual(number(row["Blows"]), sum(low <= v < high for v in values), edges)

    def test_starting_turns_do_not_stretch_a_histogram(self):
        usual = self.page_of(self.file).drawn("Blow energy of")
        self.ask("UPDATE blows SET energy = 1.0 WHERE turn < 4", "UPDATE blows SET energy = 90000.0 WHERE turn = 10")
        page = self.page_of(self.file)
        self.assertEqual(page.drawn("Blow energy of").x_range(), usual.x_range())
        few, count = self.ask("SELECT sum(energy < 2.0 OR energy > 80000.0), count(*) FROM blows")[0]
        self.assertIn(f"{few} of them, as at start and stop, lie beyond the picture", page.text)
        rows = page.table("Blows by blow energy").values()
        self.assertEqual(sum(number(row["Blows"]) for row in rows), count)

    def test_omits_a_blow_whose_energy_is_withheld(self):
        self.ask(*IMPOSSIBLE)
        page = self.page_of(self.file)
        self.assertGreater(min(y for piece in page.drawn("Blow energy:").curves("band first") for _, y in piece), 0.0)
        rows = page.table("Over all revolutions")
        good = self.ask("SELECT count(*), min(energy), sum(energy) FROM blows WHERE energy > 0")[0]
        self.assertEqual(number(rows["Blow energy [J]"]["Values"]), good[0])
        self.assertAlmostEqual(number(rows["Blow energy [J]"]["Least"]), good[1], delta=1e-3 * good[1])
        self.assertGreater(number(rows["Restitution"]["Least"]), 0.0)
        self.assertEqual(number(rows["Hold-down needed [kN]"]["Values"]), good[0] - 1)
        self.assertEqual(sum(number(r["Blows"]) for r in page.table("Blows by blow energy").values()), good[0])
        self.assertAlmostEqual(number(self.figures(page)["energy of all blows"]), good[2] / 1e3, delta=1e-3 * good[2] / 1e3)
        self.assertIn("energy and restitution are withheld: 5 of 1000", page.text)

    def test_names_are_shown_instead_of_hashes(self):
        sample.make(self.file, seconds=60.0, runs=2)
        page = self.page_of(self.file)
        for column in ("machine", "input_sha256", "run_key"):
            for value, in self.ask(f"SELECT {column} FROM runs"):
                self.assertNotIn(value[:8], page.text)
        self.assertEqual([row["Recording"] for row in page.table("Runs").values()], ["site, run 1", "site, run 2"])

    def test_runs_of_one_machine_are_compared(self):
        sample.make(self.file, seconds=60.0, runs=3)
        self.ask("UPDATE blows SET energy = 1.2 * energy WHERE run_id = 3",
                 "INSERT INTO warnings VALUES(2, 0, 'jitter', 'crank stamps jitter')")
        medians = [statistics.median(e for e, in self.ask(f"SELECT energy FROM blows WHERE run_id = {run}"))
                   for run in (1, 2, 3)]
        header, *rows = self.page_of(self.file).tables["Runs below each other"][0]
        at = header.index("Blow energy [J]")
        self.assertEqual([row[0] for row in rows], ["site, run 1", "site, run 2", "site, run 3"])
        for row, median in zip(rows, medians):
            self.assertAlmostEqual(number(row[at]) / median, 1.0, delta=1e-2)
        self.assertEqual(rows[0][at + 1], "")
        self.assertAlmostEqual(number(rows[2][at + 1]), 100.0 * (medians[2] / medians[0] - 1.0), delta=1.0)
        self.assertEqual([row[at].endswith("?") for row in rows], [False, True, False])

    def test_local_time_is_the_readers(self):
        """The page's script writes it: the page's bytes hold UTC alone, wherever it is made."""
        pages = []
        for zone in ("UTC", "Asia/Bishkek"):
            out = self.directory / (zone[:4].strip("/") + ".html")
            done = subprocess.run([sys.executable, str(REPORT), str(self.file), "--html", str(out)],
                                  env=dict(os.environ, TZ=zone), stdout=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 0)
            pages.append(out.read_bytes())
        self.assertEqual(*pages)
        times = [given["datetime"] for tag, given in Reader(pages[0].decode()).tags if tag == "time"]
        self.assertIn("2023-11-14T22:13:20Z", times)


class Costs(ReportTest):
    """A channel of which three turns in a hundred have twice the range."""
    DEAR, SLOPE = 0.03, 5.0

    def setUp(self):
        super().setUp()
        self.file = self.directory / "site.sqlite"
        sample.make(self.file, sample.Machine(curve=False), seconds=200.0, first_ns=1700002700 * sample.SECOND)
        db = sqlite3.connect(str(self.file))
        channel = db.execute("SELECT channel FROM channels WHERE name = 'hull_wrench/force_z'").fetchone()[0]
        db.execute("UPDATE turn_loads SET minimum = 0.0, maximum = CASE WHEN turn <= 30 THEN 80e3 ELSE 40e3 END "
                   "WHERE channel = ?", (channel,))
        db.commit()
        db.close()

    def test_dearest_blows_are_named(self):
        dear = self.DEAR * 2.0 ** self.SLOPE
        share = 100.0 * dear / (dear + 1.0 - self.DEAR)
        page = self.page_of(self.file)
        said = page.text.split("; 3 % of the blows did ")[1].split(" %")[0]
        self.assertAlmostEqual(float(said), share, delta=0.1)
        dearest = page.table("Most damaging revolutions")
        self.assertEqual({int(row["Turn"]) <= 30 for row in dearest.values()}, {True})

    def test_damage_is_shown_by_hour(self):
        """The recording begins 100 s before a full hour (22:58:20): the dear turns are in the first."""
        rows = self.page_of(self.file).table("Damage by hour")
        self.assertEqual(sorted(rows), ["2023-11-14 22:00", "2023-11-14 23:00"])
        first, second = (rows[k] for k in sorted(rows))
        self.assertAlmostEqual(number(first["Turns"]) + number(second["Turns"]), 1000, delta=0.5)
        turns = number(first["Turns"])
        damage = (30 * 2.0 ** self.SLOPE + turns - 30) / (30 * 2.0 ** self.SLOPE + 970)
        self.assertAlmostEqual(number(first["Damage [%]"]), 100.0 * damage, delta=0.1)

    def test_damage_by_recording_is_by_its_cycles(self):
        sample.make(self.file, sample.Machine(curve=False), seconds=100.0, runs=2)
        db = sqlite3.connect(str(self.file))
        totals = []
        for run in (1, 2):
            closed = db.execute("SELECT y.steps, y.count FROM cycles y JOIN channels c USING(run_id, channel) "
                                "WHERE run_id = ? AND name = 'hull_wrench/force_z'", (run,)).fetchall()
            ends = [r for r, in db.execute("SELECT class FROM residues JOIN channels USING(run_id, channel) WHERE run_id = ? "
                                           "AND name = 'hull_wrench/force_z' ORDER BY place", (run,))]
            halves = [(abs(a - b), 0.5) for a, b in zip(ends, ends[1:])]
            totals.append(sum(n * steps ** self.SLOPE for steps, n in closed + halves))
        db.close()
        rows = self.page_of(self.file).table("Damage by recording")
        for run, total in enumerate(totals, 1):
            self.assertAlmostEqual(number(rows[f"site, run {run}"]["Damage [%]"]), 100.0 * total / sum(totals), delta=0.1)

    def test_the_life_follows_the_load(self):
        rows = self.page_of(self.file).table("Life over that of now")
        self.assertAlmostEqual(number(rows["0.9"]["slope 5"]), 0.9 ** -5, delta=0.005)
        self.assertIn(f"slope 10: {2 ** -0.1:.3f} of the load", self.page_of(self.file, options=["--force"]).text)

    def test_life_follows_a_curve_of_two_slopes(self):
        """The life grows, where cycles fall below the knee, faster than by the steep slope, slower than by the other."""
        file = self.directory / "curve.sqlite"
        sample.make(file, seconds=100.0)
        db = sqlite3.connect(str(file))
        width, knee = db.execute("SELECT (greatest - least) / classes, sn_knee_range FROM channels "
                                 "WHERE name = 'stress/boom_foot'").fetchone()
        cycles = db.execute("SELECT steps, count FROM cycles JOIN channels USING(run_id, channel) "
                            "WHERE name = 'stress/boom_foot'").fetchall()
        db.close()
        damage = lambda f: sum(n * (s * width * f / knee) ** (3.0 if s * width * f >= knee else 5.0)  # noqa: E731
                               for s, n in cycles)
        rows = self.page_of(file).table("Life over that of now")
        for factor in ("0.8", "0.9", "1.1"):
            life = damage(1.0) / damage(float(factor))
            self.assertAlmostEqual(number(rows[factor]["stress at boom_foot"]) / life, 1.0, delta=0.02)


class Misuse(ReportTest):
    def test_counts_per_hour_over_the_runs_that_know(self):
        file = self.directory / "site.sqlite"
        sample.make(file, sample.Machine(misuse=(6, 500, 20, 12.5)), seconds=100.0, runs=2)
        db = sqlite3.connect(str(file))
        db.execute("UPDATE runs SET blows_without_hold_down = NULL, still_time = NULL WHERE run_id = 2")
        hours = [h for h, in db.execute("SELECT duration / 3600 FROM runs ORDER BY run_id")]
        db.commit()
        db.close()
        rows = self.page_of(file).table("Misuse")
        self.assertEqual(number(rows["Blank firing"]["Count"]), 12)
        self.assertAlmostEqual(number(rows["Blank firing"]["Per hour"]), 12 / sum(hours), delta=0.5)
        self.assertEqual(number(rows["Blows without hold-down force"]["Count"]), 20)
        self.assertAlmostEqual(number(rows["Blows without hold-down force"]["Per hour"]), 20 / hours[0], delta=1.0)
        self.assertIn("of 500 blows", rows["Blows without hold-down force"]["Meaning"])
        self.assertAlmostEqual(number(rows["Hammering at one place [s]"]["Count"]), 12.5)

    def test_unmeasured_values_are_not_zero(self):
        file = self.directory / "site.sqlite"
        sample.make(file, sample.Machine(misuse=(0, 0, None, None)), seconds=50.0)
        rows = self.page_of(file).table("Misuse")
        self.assertEqual(rows["Blank firing"]["Count"], "0")
        self.assertEqual(rows["Blows without hold-down force"]["Count"], "not known")
        self.assertEqual(rows["Hammering at one place [s]"]["Count"], "not known")



if __name__ == "__main__":
    unittest.main()
