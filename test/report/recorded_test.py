"""From a recorded session to its page by the real process_bag: the page's figures against the session's truth."""
import contextlib
import csv
import sqlite3
import statistics
import subprocess
import unittest

from support import SOURCE, Reader, ReportTest, program, report

DATA = SOURCE / "test" / "data"


@unittest.skipUnless(program("process_bag"), "needs the built command process_bag")
class Recorded(ReportTest):
    def test_the_page_of_a_session_has_its_figures(self):
        out = self.directory / "page.html"
        level = self.directory / "level.yaml"  # that of the session's machine
        level.write_text("level: rocker\n")
        outcome = report(DATA / "mo100_1khz.bag", "--params", level, "--html", out)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        page = Reader(out.read_text(encoding="utf-8"))
        with open(DATA / "mo100_1khz_blows.csv", newline="") as file:
            energies = [float(row["blow_energy_J"]) for row in csv.DictReader(file)]
        shown = float(page.table("Over all revolutions")["Blow energy [J]"]["Median"])
        self.assertAlmostEqual(shown, statistics.median(energies), delta=0.02 * max(energies))
        for kind in ("Typical revolution, number", "Worst revolution, number"):
            self.assertIn(kind, page.text)
        self.assertIn("force along the tool, Fz", page.table("Damage-equivalent loads"))

    def test_states_the_band_beside_each_damage_equivalent_load(self):
        out, options = self.directory / "page.html", self.directory / "options.yaml"
        options.write_text("level: rocker\nlife_bandwidth_Hz: 100.0\n")
        outcome = report(DATA / "mo100_1khz.bag", "--params", options, "--html", out)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        loads = Reader(out.read_text(encoding="utf-8")).table("Damage-equivalent loads")
        self.assertEqual(list(loads), [f"{name}, below 100 Hz" for name in (
            "force across the tool, Fx", "force along the tool, Fz", "moment about the rocker pivot, My")])

    def first_stamp(self, bag):
        """Times of the crank's samples [s]."""
        file = self.directory / "first.sqlite"
        subprocess.run([program("process_bag"), bag, "--no-bag", "--db", file], check=True, capture_output=True)
        with contextlib.closing(sqlite3.connect(file)) as database:
            return 1e-9 * database.execute("SELECT first_stamp_ns FROM runs").fetchone()[0]

    def test_compares_a_measured_load_of_a_csv_file(self):
        """The session's truth, 0.9 times as large, with one of three components."""
        with open(DATA / "mo100_1khz_truth.csv", newline="") as file:
            truth = [(float(row["t_s"]), float(row["hull_force_z_N"])) for row in csv.DictReader(file)]
        start = self.first_stamp(DATA / "mo100_1khz.bag") - truth[0][0]
        measured = self.directory / "cell.csv"
        measured.write_text("# load cell\nstamp,channel 7,force_z\n" +
                            "".join(f"{start + time:.9f},x,{0.9 * force!r}\n" for time, force in truth))
        out, level = self.directory / "page.html", self.directory / "level.yaml"
        level.write_text("level: rocker\n")
        outcome = report(DATA / "mo100_1khz.bag", "--params", level, "--reference", measured, "--html", out)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        row, = Reader(out.read_text(encoding="utf-8")).table("Computed and measured load").values()
        self.assertAlmostEqual(float(row["Scale"]), 1.0 / 0.9, delta=0.01)
        self.assertGreater(float(row["Correlation"]), 0.999)
        measured.write_text("stamp,force_z\n1.0,2.0\n1.0,3.0\n")
        outcome = report(DATA / "mo100_1khz.bag", "--reference", measured, "--html", out, "--force")
        self.assertEqual(outcome.returncode, 1)
        self.assertIn(f"{measured}: line 3: '1.0,3.0', must be later than the line before", outcome.stderr)


if __name__ == "__main__":
    unittest.main()
