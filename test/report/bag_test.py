"""A bag as input: one command from the recording to its page."""
import os
import unittest
from unittest import mock

from support import HERE, ReportTest, report


class Bags(ReportTest):
    def setUp(self):
        super().setUp()
        self.programs = self.directory / "programs"
        self.programs.mkdir()
        (self.programs / "process_bag").symlink_to(HERE.parent / "fleet" / "fake_process_bag.py")
        patch = mock.patch.dict(os.environ, HAMMER_LOADS_PROGRAMS=str(self.programs))
        patch.start()
        self.addCleanup(patch.stop)
        self.bag = self.directory / "work.bag"
        self.bag.write_text("3 20 1700000000")

    def test_a_bag_becomes_a_page(self):
        parameters = self.directory / "hammer.yaml"
        parameters.write_text("a: 1\n")
        page = self.page_of(self.bag, options=["--params", parameters])
        self.assertIn("work", [title for title in page.text.split("\n") if title])
        self.assertIn("Over all revolutions", page.tables)
        self.assertEqual(sorted(os.listdir(self.directory)), ["hammer.yaml", "page.html", "programs", "work.bag"])

    def test_two_bags_are_compared(self):
        other = self.directory / "other.bag"
        other.write_text("9 20 1700000000")
        self.assertIn("Machines side by side", self.page_of(self.bag, other).tables)

    def test_splits_of_one_recording_are_one(self):
        self.bag.write_text("3 20 1700000000 run1")
        later, last, other = (self.directory / name for name in ("b.bag", "a.bag", "other.bag"))
        later.write_text("3 20 1700000020 run1")
        last.write_text("3 20 1700000040 run1")
        other.write_text("9 20 1700000010 run3")
        page = self.page_of(last, other, later, self.bag)
        self.assertIn("Machines side by side", page.tables)  # the recording and the other one
        self.assertEqual(sorted((self.programs / "calls.txt").read_text().split()), ["other.bag", "work.bag+b.bag+a.bag"])

    def test_names_of_topics_reach_process_bag(self):
        topics = ["--crank-topic", "/drive", "--joint-states-topic", "/js", "--imu-topic", "/imu", "--pressures-topic", "/p"]
        self.page_of(self.bag, options=topics)
        self.assertEqual((self.programs / "options.txt").read_text().split(), topics)

    def test_bad_bags_are_refused(self):
        out = self.directory / "out.html"
        self.bag.write_text("broken")
        outcome = report(self.bag, "--html", out)
        self.assertEqual(outcome.returncode, 1)
        self.assertEqual(outcome.stderr.splitlines()[-1], f"{self.bag}: process_bag ended with code 1, nothing is written")
        self.assertRefused(report(self.directory / "none.bag", "--html", out), "none.bag: cannot be read")
        (self.programs / "process_bag").unlink()
        self.assertRefused(report(self.bag, "--html", out), "needs the built command process_bag")
        self.assertFalse(out.exists())

    def test_parameters_without_a_bag_are_refused(self):
        self.assertRefused(report("a.sqlite", "--html", "x", "--params", "y"), "are for bags", code=2)


if __name__ == "__main__":
    unittest.main()
