"""The merged file: every run once, machines' cycles as one count of the whole, whatever the order."""
import os
import sqlite3
import subprocess
import sys
import unittest

from fleet_support import FLEET, MergeTest
import sample_database as sample
from report.database import Database
from report.subjects import subjects_of


class Merge(MergeTest):
    def test_sums_are_one_count_in_order_of_time(self):
        """Bags come in any order; the sum is that of their series one after the other."""
        outcomes = [self.add(f"b{i}", first=1000 * i, seed=3 + i) for i in range(5)]
        self.merge(*(outcomes[i] for i in (3, 0, 4, 2, 1)))
        closed, points = {}, []
        for i in range(5):
            db = sqlite3.connect(str(self.directory / "bags" / f"b{i}.sqlite"))
            for steps, low, count in db.execute("SELECT steps, low, count FROM cycles WHERE channel = 1"):
                closed[steps, low] = closed.get((steps, low), 0) + count
            points += [c for c, in db.execute("SELECT class FROM residues WHERE channel = 1 ORDER BY place")]
            db.close()
        across, residue = sample.count_all(points)
        for (a, b), n in across.items():
            closed[b - a, a] = closed.get((b - a, a), 0) + n
        self.assertTrue(across)
        at = self.ask("SELECT machine_channel FROM machine_channels WHERE name = 'hull_wrench/force_z'")[0][0]
        self.assertEqual({(s, l): n for s, l, n in self.ask(
            f"SELECT steps, low, count FROM machine_cycles WHERE machine_channel = {at}")}, closed)
        self.assertEqual([c for c, in self.ask(
            f"SELECT class FROM machine_residues WHERE machine_channel = {at} ORDER BY place")], residue)

    def test_merging_in_pieces_equals_merging_at_once(self):
        outcomes = [self.add(f"b{i}", first=1000 * i, seed=3 + i) for i in range(4)]
        self.merge(*outcomes, target="whole.sqlite")
        for outcome in reversed(outcomes):
            self.merge(outcome)
        for sql in ("SELECT machine, identity, name, hours, damage, remaining_hours FROM machine_channels ORDER BY name",
                    "SELECT steps, low, count FROM machine_cycles ORDER BY 1, 2, 3",
                    "SELECT equivalent_range FROM machine_equivalents ORDER BY 1"):
            for one, other in zip(self.ask(sql), self.ask(sql, "whole.sqlite")):
                for a, b in zip(one, other):
                    (self.assertAlmostEqual if isinstance(a, float) else self.assertEqual)(a, b)

    def test_again_changes_nothing(self):
        outcomes = [self.add("a"), self.add("b", first=900, seed=2), self.add("c", status="failed")]
        self.assertEqual(self.merge(*outcomes), "3 bags, 3 new or changed")
        before = self.ask("SELECT * FROM runs"), self.ask("SELECT * FROM bags")
        self.assertEqual(self.merge(*outcomes), "3 bags, 0 new or changed")
        self.assertEqual((self.ask("SELECT * FROM runs"), self.ask("SELECT * FROM bags")), before)

    def test_a_changed_bag_replaces_itself(self):
        a, b = self.add("a"), self.add("b", first=900, seed=2)
        self.merge(a, b)
        self.add("b", first=900, seed=7, seconds=80.0)
        self.assertEqual(self.merge(a, b), "2 bags, 1 new or changed")
        self.assertEqual(self.ask("SELECT count(*), sum(turns) FROM runs"), [(2, 600)])
        self.assertAlmostEqual(self.ask("SELECT max(hours) FROM machine_channels")[0][0], 120 / 3600, delta=1e-4)
        self.assertEqual(self.ask("SELECT count(*) FROM cycles WHERE run_id NOT IN (SELECT run_id FROM runs)"), [(0,)])
        self.add("b", status="failed")
        self.merge(a, b)
        self.assertAlmostEqual(self.ask("SELECT max(hours) FROM machine_channels")[0][0], 40 / 3600, delta=1e-4)

    def test_the_same_recording_counts_once(self):
        self.merge(self.add("a"), self.add("copy_of_a"))
        self.assertEqual(self.ask("SELECT bag, status FROM bags ORDER BY bag"),
                         [("/in/a.bag", "done"), ("/in/copy_of_a.bag", "twice")])
        self.assertEqual(self.ask("SELECT count(*) FROM runs"), [(1,)])

    def test_half_a_database_is_a_row_with_its_reason(self):
        whole, half, other = self.add("whole"), self.add("half", first=900, seed=2), self.add("other", first=99, seed=4)
        path = self.directory / "bags" / "half.sqlite"
        content = path.read_bytes()
        path.write_bytes(content[:len(content) * 2 // 3 // 4096 * 4096])
        (self.directory / "bags" / "other.sqlite").write_bytes(b"")
        self.merge(whole, half, other)
        rows = {bag: (status, reason) for bag, status, reason in self.ask("SELECT bag, status, reason FROM bags")}
        self.assertEqual([rows[f"/in/{name}.bag"][0] for name in ("whole", "half", "other")], ["done", "failed", "failed"])
        self.assertIn("cannot be read", rows["/in/half.bag"][1])
        self.assertEqual(self.ask("SELECT count(*) FROM runs"), [(1,)])
        self.assertEqual(self.ask("SELECT count(DISTINCT run_id) FROM cycles"), [(1,)])

    def test_another_hammer_is_never_mixed(self):
        self.merge(self.add("a", of=sample.Machine("old")), self.add("b", first=900, seed=2, of=sample.Machine("new")))
        self.assertEqual(self.ask("SELECT count(*), count(DISTINCT identity) FROM machine_channels"), [(6, 2)])

    def test_a_kill_between_bags_and_sums_is_repaired(self):
        a = self.add("a")
        self.merge(a)
        db = sqlite3.connect(str(self.directory / "merged.sqlite"))
        db.execute("INSERT INTO stale_machines VALUES('red')")
        for table in ("channels", "cycles", "equivalents", "residues"):
            db.execute(f"DELETE FROM machine_{table}")
        db.commit()
        db.close()
        self.merge(a)
        self.assertEqual(self.ask("SELECT count(*) FROM machine_channels"), [(3,)])

    def test_other_files_are_refused(self):
        for name, content in (("text", b"mine"), ("db", None)):
            path = self.directory / name
            path.write_bytes(content) if content else sample.make(path, seconds=5.0)
            before = path.read_bytes()
            done = subprocess.run([sys.executable, str(FLEET / "merge.py"), str(path)], input="", universal_newlines=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertEqual(path.read_bytes(), before)

    def test_rows_of_turns_when_asked(self):
        a = self.add("a")
        self.merge(a)
        self.assertEqual(self.ask("SELECT count(*) FROM sqlite_master WHERE name = 'turns'"), [(0,)])
        self.merge(a, target="rows.sqlite", options=["--rows", "turns"])
        self.assertEqual(self.ask("SELECT count(*) FROM turns", "rows.sqlite"), [(200,)])
        page = self.directory / "page.html"
        subprocess.run([str(self.programs / "report"), str(self.directory / "rows.sqlite"), "--html", str(page)], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertTrue(os.path.getsize(page))

    def test_a_page_of_the_merged_file_has_the_same_figures(self):
        """The page of one bag has the figures of the bag's own page."""
        self.merge(self.add("a"))
        own = subjects_of(Database(self.directory / "bags" / "a.sqlite"))[0].counted_channels()
        merged = subjects_of(Database(self.directory / "merged.sqlite"))[0].counted_channels()
        for one, other in zip(own, merged):
            self.assertEqual(one.name, other.name)
            self.assertEqual(one.equivalents(), other.equivalents())


if __name__ == "__main__":
    unittest.main()
