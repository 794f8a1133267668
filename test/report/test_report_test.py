"""Certificates: results with expanded uncertainties, rounded as JCGM 100 asks, and what they rest on."""
import re
import shutil
import sqlite3
import subprocess
import unittest

from support import HERE, REPORT, Reader, ReportTest, SOURCE, program

import sample_database as sample
from budget_test import with_budget
from report.formats import rounded
from report.test_report import deviation_key


class TestReport(ReportTest):
    ROWS = [("blow/energy", 900.0, 20.0, "rocker_mass_kg", 0.64), ("blow/energy", 900.0, 20.0, "readings", 0.36)]

    def command(self, *arguments):
        link = self.directory / "test_report"
        if not link.exists():
            link.symlink_to(REPORT)
        return subprocess.run([str(link), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              encoding="utf-8")

    def test_an_uncertainty_has_two_digits_and_the_value_as_many_places(self):
        self.assertEqual(rounded(1006.99, 86.19), ("1\u202f007", "86"))
        self.assertEqual(rounded(0.18302, 0.01746), ("0.183", "0.017"))
        self.assertEqual(rounded(-11996.4, 17258.0), ("\u221212\u202f000", "17\u202f000"))

    def test_std_keys_stand_before_the_unit(self):
        keys = {"rocker_mass_std_kg", "rod_damping_ratio_std"}
        self.assertEqual(deviation_key("rocker_mass_kg", keys), "rocker_mass_std_kg")
        self.assertEqual(deviation_key("rod_damping_ratio", keys), "rod_damping_ratio_std")
        self.assertIsNone(deviation_key("rocker_length_m", keys))

    def test_expanded_uncertainty_is_twice_the_std(self):
        path, page = self.directory / "a.sqlite", self.directory / "a.html"
        with_budget(path, self.ROWS)
        outcome = self.command(path, "--html", page)
        self.assertEqual((outcome.returncode, outcome.stderr), (0, ""))
        words = re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8"))
        self.assertRegex(words, r"blow energy\s+900\s+40\s+J\s+rocker_mass_kg 64 %, readings 36 %")
        self.assertNotEqual(self.command(path, "--html", page).returncode, 0)  # a page that is there stays

    def page(self, path):
        """(text of its parts by their titles, table of the input quantities)."""
        out = self.directory / "page.html"
        outcome = self.command(path, "--html", out, "--force")
        self.assertEqual((outcome.returncode, outcome.stderr), (0, ""))
        reader = Reader(out.read_text(encoding="utf-8"))
        parts = re.split("(What was measured|Results|Input quantities|What was checked|Reservations|Method)\n", reader.text)
        inputs = next(rows for rows, in reader.tables.values() if rows[0][0] == "Input quantity")
        return dict(zip(parts[1::2], parts[2::2])), {row[0]: row[1:] for row in inputs[1:]}

    def test_every_input_of_more_than_a_hundredth_is_listed(self):
        path = self.directory / "a.sqlite"
        with_budget(path, [("pulse/amplitude", 8e3, 300.0, "rod_stiffness_N_m", 0.82),
                           ("pulse/amplitude", 8e3, 300.0, "rocker_mass_kg", 0.175),
                           ("pulse/amplitude", 8e3, 300.0, "rod_mass_kg", 0.005),
                           ("blow/energy", 900.0, 20.0, "rocker_mass_kg", 0.98),
                           ("blow/energy", 900.0, 20.0, "crank_length_m", 0.015),
                           ("blow/energy", 900.0, 20.0, "rod_mass_kg", 0.005)])
        db = sqlite3.connect(str(path))
        db.executemany("INSERT INTO parameters VALUES(1,?,?,?)", [
            ("rod_stiffness_N_m", "6e8", "0"), ("rod_stiffness_std_N_m", "4e8", "4e8"), ("crank_length_m", "0.05", "0.048")])
        db.commit()
        db.close()
        _, inputs = self.page(path)
        self.assertEqual(list(inputs), ["rocker_mass_kg", "rod_stiffness_N_m", "crank_length_m"])
        self.assertEqual(inputs["rod_stiffness_N_m"], ["6e8", "4e8", "82 % of u\u00b2 of peak force along the tool"])
        self.assertEqual(inputs["crank_length_m"][:2], ["0.05", "\u2013"])

    def test_a_check_that_failed_is_a_reservation(self):
        path = self.directory / "a.sqlite"
        with_budget(path, self.ROWS, restarts=1)
        self.assertEqual(self.page(path)[0]["Reservations"].strip(), "None.")
        with_budget(path, self.ROWS, restarts=4)
        self.assertRegex(self.page(path)[0]["Reservations"], r"Restarts: 4, look")

    def test_files_without_a_budget_or_of_two_machines_get_none(self):
        path, page = self.directory / "b.sqlite", self.directory / "b.html"
        sample.make(path, seconds=20.0, boom=False)
        outcome = self.command(path, "--html", page)
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("holds no budget", outcome.stderr)
        other = self.directory / "c.sqlite"
        shutil.copy(path, other)
        outcome = self.command(path, other, "--html", page)
        self.assertIn("one machine's recording, not of 2", outcome.stderr)
        self.assertFalse(page.exists())

    @unittest.skipUnless(program("process_bag"), "needs the built commands")
    def test_the_report_of_a_bag_names_inputs_and_checks(self):
        page = self.directory / "d.html"
        outcome = self.command(HERE.parent / "data" / "mo100_1khz.bag", "--html", page)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8")))
        self.assertIn("rocker_mass_kg 35.2 0.704", words)
        self.assertRegex(words, r"Consistency \S+ ok")
        self.assertIn("no hammer file was given", words)

    @unittest.skipUnless(program("process_bag"), "needs the built commands")
    def test_inputs_whose_std_no_file_gives_have_the_usual_one(self):
        """Half of a rod's mass, 0.3 mm of a length."""
        hammer, page = self.directory / "hammer.yaml", self.directory / "d.html"
        lines = (SOURCE / "config" / "hammer_mo100.yaml").read_text(encoding="utf-8").splitlines()
        hammer.write_text("\n".join(line for line in lines if "_std" not in line) + "\n", encoding="utf-8")
        outcome = self.command(HERE.parent / "data" / "mo100_1khz.bag", "--params", hammer, "--html", page)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8")))
        for words_of_row in ("rod_mass_kg 4.5 2.25", "crank_length_m 0.048 0.0003", "rod_stiffness_N_m not given 4e+08"):
            self.assertIn(words_of_row, words)


if __name__ == "__main__":
    unittest.main()
