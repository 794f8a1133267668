"""Shipped questions on a fleet of which the answers are known."""
import csv
import io
import sqlite3
import subprocess
import sys
import unittest

from fleet_support import FLEET, MergeTest
import sample_database as sample
from support import Reader, report


class Queries(MergeTest):
    """Red strikes hard, blue's sensor jitters, green's bag is broken."""

    def setUp(self):
        super().setUp()
        red = sample.Machine("red", peak_N=60000.0, parameters={"rocker_mass_kg": ("36.0", "35.2")})
        blue = sample.Machine("blue", jitter_s=4e-4)
        self.merge(self.add("r", of=red), self.add("b", "blue", of=blue, seconds=80.0, restarts=4, refusals={"duplicate": 8}),
                   self.add("g", "green", status="failed"))

    def answer(self, name):
        done = subprocess.run([sys.executable, str(FLEET / "query"), name, str(self.directory / "merged.sqlite"), "--csv"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return list(csv.DictReader(io.StringIO(done.stdout)))

    def test_every_question_has_its_answer(self):
        self.assertEqual([row["machine"] for row in self.answer("worst_machines")], ["red", "blue"])
        self.assertEqual(self.answer("restarts")[0]["restarts"], "4")
        self.assertEqual(self.answer("highest_peaks")[0]["machine"], "red")
        self.assertEqual([(row["machine"], row["refused"]) for row in self.answer("refused_samples")], [("blue", "8")])
        hours = {row["machine"]: float(row["hours"]) for row in self.answer("hours_and_blows")}
        self.assertAlmostEqual(hours["blue"], 80 / 3600, delta=1e-4)
        self.assertEqual([row["bag"] for row in self.answer("failed_bags")], ["/in/g.bag"])
        self.assertIn(("rocker_mass_kg", "36.0", "red"),
                      [(row["key"], row["value"], row["machine"]) for row in self.answer("changed_parameters")])
        self.assertEqual([row["week"] for row in self.answer("energy_by_week")], ["2023-W46", "2023-W46"])
        energy = sum(float(row["energy_MJ"]) for row in self.answer("energy_by_week"))
        self.assertAlmostEqual(energy, self.ask("SELECT sum(total) / 1e6 FROM run_figures WHERE quantity = 'energy'")[0][0])
        self.assertEqual(len(self.answer("lowest_hold_down")), 2)
        self.assertEqual(self.answer("blank_turns"), [])
        self.assertEqual(self.answer("life_left"), [])

    def test_failed_bags_are_the_last_warnings_of_a_page(self):
        self.merge(self.add("a", "amber", status="failed"),
                   self.add("z", "zinc", of=sample.Machine("zinc"), warnings=[("jitter", "crank stamps jitter")]))
        out = self.directory / "all.html"
        self.assertEqual(report(self.directory / "merged.sqlite", "--html", out).returncode, 0)
        text = Reader(out.read_text(encoding="utf-8")).text
        warned, amber, green = (text.index(words) for words in ("crank stamps jitter", "bag /in/a.bag", "bag /in/g.bag"))
        self.assertLess(warned, min(amber, green))

    def test_a_reason_on_a_page_names_the_bag_once(self):
        self.merge(self.add("x", "violet", status="failed", reason="/elsewhere/x.bag: no message on /hammer/crank"))
        out = self.directory / "all.html"
        self.assertEqual(report(self.directory / "merged.sqlite", "--html", out).returncode, 0)
        line = next(text for tag, text in Reader(out.read_text(encoding="utf-8")).pieces if "/hammer/crank" in text)
        self.assertEqual(line.count("x.bag"), 1, line)

    def test_machines_that_worked_minutes_in_different_years_fill_their_pictures(self):
        year = 365 * 86400
        self.merge(*(self.add(f"y{at}", "yellow", first=at * year, seed=at) for at in range(4)),
                   *(self.add(f"v{at}", "violet", first=at * year + 1000, seed=9 + at) for at in range(4)))
        out = self.directory / "all.html"
        self.assertEqual(report(self.directory / "merged.sqlite", "--html", out).returncode, 0)
        pictures = [p for p in Reader(out.read_text(encoding="utf-8")).pictures if p.title.endswith("over the time of work")]
        self.assertEqual(len(pictures), 5)
        for picture in pictures:
            self.assertGreater(len(picture.x), 2)  # labels of the time
            places = [x for kind in picture.classes("line") for piece in picture.curves(kind) for x, _ in piece]
            self.assertLess(max(places), 200.0)  # seconds of work, not years
            self.assertGreater(max(places) - min(places), 0.9 * (picture.x[-1][0] - picture.x[0][0]))
            self.assertGreaterEqual(len({round(place) for place in places}), 4)

    def test_misuse_is_counted_by_machine(self):
        self.merge(self.add("m", "mauve", of=sample.Machine("mauve", misuse=(3, 100, 5, None)), seconds=80.0))
        row = next(row for row in self.answer("misuse") if row["machine"] == "mauve")
        self.assertAlmostEqual(float(row["blank_firings_per_hour"]), 3 * 3600 / 80, delta=0.5)
        self.assertAlmostEqual(float(row["blows_without_hold_down_per_hour"]), 5 * 3600 / 80, delta=0.5)
        self.assertEqual(row["still_s_per_hour"], "")

    def test_boom_health_is_shown_by_month(self):
        """A cylinder that softens from one month to the next; what is doubtful is in no trend."""
        for at, stiffness in enumerate((1.0, 0.98, 0.8)):
            oil = {"boom_cylinder": (stiffness, 0.0, 0), "arm_cylinder": (1.2, 0.0, 1)}
            self.merge(self.add(f"o{at}", "olive", of=sample.Machine("olive", oil=oil), seed=at,
                                first=40 * 86400 * at))
        rows = [row for row in self.answer("boom_health") if row["machine"] == "olive"]
        self.assertEqual([(row["cylinder"], row["month"], row["runs"]) for row in rows],
                         [("boom_cylinder", month, "1") for month in ("2023-11", "2023-12", "2024-02")])
        for row, change in zip(rows, (0.0, -2.0, -20.0)):
            self.assertAlmostEqual(float(row["change_percent"]), change, delta=0.2)
            self.assertAlmostEqual(float(row["std"]), 0.01, delta=1e-6)

    def test_sensors_to_calibrate_takes_warnings(self):
        """Sound figures and a warning: the sensor asks for it; a warning about something else does not."""
        self.assertEqual([row["machine"] for row in self.answer("sensors_to_calibrate")], ["blue"])
        self.merge(self.add("w", "white", of=sample.Machine("white"), runs=2,
                            warnings=[("zero", "crank_zero_rad: run calibrate"), ("jitter", "jitters")]),
                   self.add("y", "yellow", of=sample.Machine("yellow"), warnings=[("hammer", "no hammer file")]))
        rows = {row["machine"]: row for row in self.answer("sensors_to_calibrate")}
        self.assertEqual(sorted(rows), ["blue", "white"])
        self.assertEqual((rows["white"]["runs"], rows["white"]["warnings"]), ("2", "2"))
        self.assertEqual(rows["white"]["a_warning"], "crank_zero_rad: run calibrate")

    def test_every_shipped_question_runs_and_states_its_subject(self):
        shipped = sorted(FLEET.glob("queries/*.sql"))
        self.assertGreaterEqual(len(shipped), 10)
        for path in shipped:
            self.assertTrue(path.read_text().startswith("-- "), path)
            self.answer(path.stem)

    def test_a_file_that_is_no_database_is_refused(self):
        done = subprocess.run([sys.executable, str(FLEET / "query"), "life_left", "/dev/null"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1))


if __name__ == "__main__":
    unittest.main()

    def after(self, name, machine, *sql, seconds=40.0):
        """An outcome whose database was changed."""
        outcome = self.add(name, machine, of=sample.Machine(machine), seconds=seconds)
        with sqlite3.connect(str(self.directory / "bags" / f"{name}.sqlite")) as database:
            for line in sql:
                database.execute(line)
        database.close()
        return outcome

    def test_exceeded_limits_are_counted_by_machine_and_shown(self):
        alarm = "INSERT INTO alarms VALUES(1, 'hold_down_force', 2, 'N', %s, NULL, 3000.0, %d, %d, %d)"
        limit = "INSERT INTO parameters VALUES(1, 'limit_hold_down_force_error_N', '3000.0', NULL)"
        self.merge(self.after("o", "orange", limit, alarm % (2900.0, 10, 20, 4), alarm % (2400.0, 30, 40, 7)),
                   self.after("p", "orange", limit, alarm % (2700.0, 50, 50, 1), seconds=60.0))
        row, = self.answer("alarms")
        self.assertEqual((row["machine"], row["name"], row["alarms"], row["turns"], row["farthest_value"]),
                         ("orange", "hold_down_force", "3", "12", "2400.0"))
        out = self.directory / "orange.html"
        self.assertEqual(report(self.directory / "merged.sqlite", "--machine", "orange", "--html", out).returncode, 0)
        shown = Reader(out.read_text(encoding="utf-8")).table("Limits exceeded")["hold_down_force"]
        self.assertEqual((shown["Revolutions"], shown["Times"]), ("12", "3"))

    def test_measured_loads_are_weighted_by_their_samples(self):
        reference = "INSERT INTO reference VALUES(1, 'force_z', 'N', %d, 4000.0, %s, %s, 1.0, 0.99, 0.95)"
        self.merge(self.after("o", "orange", reference % (100, 30.0, 10.0)),
                   self.after("p", "orange", reference % (300, 50.0, -10.0), seconds=60.0))
        row, = self.answer("references")
        self.assertEqual((row["machine"], row["component"], row["runs"], row["samples"]), ("orange", "force_z", "2", "400"))
        self.assertAlmostEqual(float(row["rms_error"]) ** 2, (900.0 + 3 * 2500.0) / 4)
        self.assertAlmostEqual(float(row["bias"]), -5.0)

    def test_recordings_without_tables_of_alarms_are_merged(self):
        self.merge(self.after("o", "orange", "DROP TABLE alarms", "DROP TABLE reference"))
        self.assertEqual(self.ask("SELECT count(*) FROM runs r JOIN bags b USING(bag_id) WHERE machine = 'orange'"), [(1,)])
