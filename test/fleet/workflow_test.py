"""The workflow on one machine: what is broken is a row, only what changed runs again."""
import sqlite3
import subprocess
import sys
import unittest

from fleet_support import FleetTest


def snakemake_version():
    """Version of Snakemake; 0 without it."""
    done = subprocess.run([sys.executable, "-m", "snakemake", "--version"], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, universal_newlines=True)
    return int(done.stdout.split(".")[0]) if done.returncode == 0 else 0


@unittest.skipUnless(snakemake_version() >= 7, "needs Snakemake 7, as in Debian 12")
class Workflow(FleetTest):
    def setUp(self):
        super().setUp()
        self.bags = self.directory / "bags"
        for machine, count in (("red", 3), ("blue <b>", 2)):
            folder = self.bags / machine
            folder.mkdir(parents=True)
            (folder / "hammer.yaml").write_text(f"hammer: {machine}\n")
            for i in range(count):
                (folder / f"{machine[0]}{i}.bag").write_text(f"{i} 20 {1700000000 + 100 * i}")
        (self.bags / "red" / "r_broken.bag").write_text("broken")
        (self.bags / "red" / "r_now.bag.active").write_text("0 20 0")

    def bags_table(self):
        db = sqlite3.connect(str(self.out / "merged.sqlite"))
        rows = db.execute("SELECT bag, status, reason FROM bags").fetchall()
        db.close()
        return {bag.rsplit("/", 1)[1]: (status, reason) for bag, status, reason in rows}

    def test_broken_bags_are_rows_and_only_changes_run(self):
        last = self.run_fleet(self.bags).rstrip().rsplit("\n", 1)[-1]
        self.assertTrue(last.startswith("fleet: 7 bags, 2 failed (") and "r_broken.bag: " in last, last)
        everything = ["b0.bag", "b1.bag", "r0.bag", "r1.bag", "r2.bag", "r_broken.bag"]
        self.assertEqual(self.calls(), everything)
        rows = self.bags_table()
        self.assertEqual([name for name, row in sorted(rows.items()) if row[0] == "done"], everything[:5])
        self.assertIn("is no bag", rows["r_broken.bag"][1])
        self.assertIn("still being written", rows["r_now.bag.active"][1])
        pages = sorted(path.name for path in (self.out / "pages").iterdir())
        self.assertEqual(len(pages), 3)
        self.assertIn("all.html", pages)

        self.run_fleet(self.bags)
        self.assertEqual(self.calls(), [])

        (self.bags / "red" / "r1.bag").write_text("7 20 1700000100")
        (self.bags / "red" / "r_broken.bag").write_text("5 20 1700000900")
        blue = self.out / "pages" / next(page for page in pages if page.startswith("blue"))
        before = blue.stat().st_mtime_ns
        self.run_fleet(self.bags)
        self.assertEqual(self.calls(), ["r1.bag", "r_broken.bag"])
        self.assertEqual(self.bags_table()["r_broken.bag"], ("done", None))
        self.assertEqual(blue.stat().st_mtime_ns, before)

        (self.bags / "blue <b>" / "hammer.yaml").write_text("hammer: blue, new rocker\n")
        self.run_fleet(self.bags)
        self.assertEqual(self.calls(), ["b0.bag", "b1.bag"])

        (self.programs / "version.txt").write_text("0.2.0")
        self.run_fleet(self.bags)
        self.assertEqual(self.calls(), everything)

    def test_splits_and_topics_reach_process_bag(self):
        folder = self.directory / "splits"
        folder.mkdir()
        (folder / "w_1.bag").write_text("3 20 1700000020 run1")
        (folder / "w_0.bag").write_text("3 20 1700000000 run1")
        (folder / "w_2.bag").write_text("4 20 1700000090 run2")
        self.run_fleet(folder, config=["crank_topic=/drive/encoder", "imu_topic=/imu"])
        self.assertEqual(self.calls(), ["w_0.bag+w_1.bag", "w_2.bag"])
        self.assertEqual((self.programs / "options.txt").read_text().split(),
                         ["--crank-topic", "/drive/encoder", "--imu-topic", "/imu"])
        self.assertEqual(sorted(self.bags_table()), ["w_0.bag", "w_2.bag"])

    def test_a_list_with_rows_of_turns_is_merged(self):
        listed = self.directory / "list.csv"
        listed.write_text("machine,bag,parameters\nred,bags/red/r0.bag,bags/red/hammer.yaml\n"
                          "green,bags/red/none.bag,\n")
        self.run_fleet(listed, config=["rows=turns"])
        self.assertEqual(self.bags_table(), {"r0.bag": ("done", None), "none.bag": ("failed", "does not exist")})
        db = sqlite3.connect(str(self.out / "merged.sqlite"))
        self.assertEqual(db.execute("SELECT count(*) FROM turns").fetchone(), (100,))
        db.close()

    def test_odd_names_end_nothing(self):
        """Each is a row: processed, or with the reason; programs may lie in a folder with a space."""
        self.programs.rename(self.directory / "pro grams")
        self.programs = self.directory / "pro grams"
        for name in ("{x}.bag", "-x.bag", "a b.bag", "'q'.bag"):
            (self.bags / "red" / name).write_text(f"{len(name)} 20 {1700001000 + 100 * ord(name[0])}")
        listed = self.directory / "list.yaml"
        listed.write_text("- {machine: red, bag: bags/red/r0.bag}\n- {machine: '{y}', bag: 'bags/red/{x}.bag'}\n"
                          "- {machine: -m, bag: bags/red/-x.bag}\n- {machine: red, bag: 'bags/red/a b.bag'}\n"
                          "- {machine: red, bag: \"bags/red/'q'.bag\"}\n- {machine: red, bag: 5}\n"
                          '- {machine: red, bag: bags/red/r1.bag, parameters: ["h\\0.yaml"]}\n')
        self.run_fleet(listed)
        rows = self.bags_table()
        self.assertEqual(sorted(name for name, row in rows.items() if row[0] == "done"),
                         ["'q'.bag", "-x.bag", "a b.bag", "r0.bag", "{x}.bag"])
        self.assertIn("control characters", rows["r1.bag"][1])
        self.assertIn("entry 6: machine and bag: 'red', 5, must be texts", [row[1] for row in rows.values()])
        self.calls()
        self.run_fleet(listed)
        self.assertEqual(self.calls(), [])
        (self.bags / "red" / "{x}.bag").write_text("11 20 1700091000")
        self.run_fleet(listed)
        self.assertEqual(self.calls(), ["{x}.bag"])

    def test_a_bad_list_is_one_line(self):
        done = self.snakemake(self.directory / "none.csv")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("fleet: ", done.stdout)
        self.assertIn("none.csv: does not exist", done.stdout)
        self.assertNotIn("Traceback", done.stdout)


if __name__ == "__main__":
    unittest.main()
