"""From a recorded session to its page by the real process_bag: the page's figures against the session's truth."""
import csv
import statistics
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


if __name__ == "__main__":
    unittest.main()
