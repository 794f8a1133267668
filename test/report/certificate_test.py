"""Certificates: results with expanded uncertainties, rounded as JCGM 100 asks, and what they rest on."""
import re
import shutil
import subprocess
import unittest

from support import HERE, REPORT, ReportTest, program

import sample_database as sample
from budget_test import with_budget
from report.certificate import deviation_key, rounded


class Certificate(ReportTest):
    def command(self, *arguments):
        certificate = self.directory / "certificate"
        if not certificate.exists():
            certificate.symlink_to(REPORT)
        return subprocess.run([str(certificate), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              encoding="utf-8")

    def test_an_uncertainty_has_two_digits_and_the_value_as_many_places(self):
        self.assertEqual(rounded(1006.99, 86.19), ("1007", "86"))
        self.assertEqual(rounded(0.18302, 0.01746), ("0.183", "0.017"))
        self.assertEqual(rounded(-11996.4, 17258.0), ("-12000", "17000"))

    def test_deviation_keys_stand_before_the_unit(self):
        keys = {"rocker_mass_deviation_kg", "rod_damping_ratio_deviation"}
        self.assertEqual(deviation_key("rocker_mass_kg", keys), "rocker_mass_deviation_kg")
        self.assertEqual(deviation_key("rod_damping_ratio", keys), "rod_damping_ratio_deviation")
        self.assertIsNone(deviation_key("rocker_length_m", keys))

    def test_expanded_uncertainty_is_twice_the_deviation(self):
        path, page = self.directory / "a.sqlite", self.directory / "a.html"
        with_budget(path, [("blow/energy_J", 900.0, 20.0, "rocker_mass_kg", 0.64),
                           ("blow/energy_J", 900.0, 20.0, "readings", 0.36)])
        outcome = self.command(path, "--html", page)
        self.assertEqual((outcome.returncode, outcome.stderr), (0, ""))
        words = re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8"))
        self.assertRegex(words, r"blow/energy\s+900\s+40\s+J\s+rocker_mass_kg 64 %, readings 36 %")
        self.assertNotEqual(self.command(path, "--html", page).returncode, 0)  # a page that is there stays

    def test_what_has_no_budget_or_two_machines_gets_none(self):
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
    def test_over_a_bag_it_names_inputs_and_checks(self):
        page = self.directory / "d.html"
        outcome = self.command(HERE.parent / "data" / "mo100_1khz.bag", "--html", page)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8")))
        self.assertIn("rocker_mass_kg 35.2 0.704", words)
        self.assertRegex(words, r"Consistency \S+ sound")
        self.assertIn("no hammer file was given", words)


if __name__ == "__main__":
    unittest.main()
