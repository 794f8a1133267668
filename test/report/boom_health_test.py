"""The boom's oil over runs: the page against what the database was made of."""
import unittest

from support import ReportTest
import sample_database as sample

TABLE = "Stiffness of the oil over that of the boom file, mean of a run"


class BoomHealth(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "site.sqlite"

    def rows(self, runs, **oil):
        sample.make(self.file, sample.Machine(oil=oil), seconds=20.0, runs=runs)
        self.page = self.page_of(self.file)
        return self.page.table(TABLE)

    def test_changes_are_reported(self):
        rows = self.rows(3, arm_cylinder=(0.9, 0.0, 0), boom_cylinder=(1.1, -0.05, 0), hammer_cylinder=(1.0, 0.04, 0))
        self.assertEqual(rows["arm_cylinder"]["Verdict"], "as before")
        self.assertEqual(rows["boom_cylinder"]["Verdict"], "softer")
        self.assertEqual(rows["hammer_cylinder"]["Verdict"], "stiffer")
        self.assertEqual(rows["boom_cylinder"]["Change"], "-9.1 %")
        self.assertTrue(rows["boom_cylinder"]["First run"].startswith("1.1"), rows)
        self.assertTrue(rows["boom_cylinder"]["Last run"].startswith("1 ") or
                        rows["boom_cylinder"]["Last run"].startswith("1.0"), rows)
        picture = self.page.drawn("Stiffness of the oil by run")
        arm, boom, hammer = (picture.curves(kind)[0] for kind in picture.classes("line"))
        for curve, expected in ((arm, (0.9, 0.9, 0.9)), (boom, (1.1, 1.05, 1.0)), (hammer, (1.0, 1.04, 1.08))):
            self.assertEqual([round(x) for x, _ in curve], [1, 2, 3])
            for (_, stiffness), truth in zip(curve, expected):
                self.assertAlmostEqual(stiffness, truth, delta=0.005)

    def test_a_value_damped_by_something_else_is_no_trend(self):
        rows = self.rows(2, arm_cylinder=(0.9, -0.3, 1))
        self.assertEqual(rows["arm_cylinder"]["Verdict"], "uncertain: something else than oil damps the boom")

    def test_one_run_has_nothing_to_compare(self):
        rows = self.rows(1, arm_cylinder=(0.9, 0.0, 0))
        self.assertEqual((rows["arm_cylinder"]["Verdict"], rows["arm_cylinder"]["Change"]),
                         ("one run: nothing to compare", "\u2013"))
        modes = self.page.table("Modes of the last run, over its poses")
        self.assertEqual(modes["1"]["Frequency [Hz]"], "4 to 4.09")
        self.assertEqual(modes["1"]["Turns"], "100")

    def test_load_is_unknown_without_sensors(self):
        sample.make(self.file, seconds=20.0)
        self.assertIn("Not known: it needs boom_stiffness: identified", self.page_of(self.file).text)


if __name__ == "__main__":
    unittest.main()
