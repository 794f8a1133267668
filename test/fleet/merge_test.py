"""The merged file: every run once, machines' cycles as one count of the whole, whatever the order."""
import subprocess
import sys

import pytest

from fleet_support import FLEET
import sample_database as sample
from support import execute
from report.database import Database
from report.subjects import subjects_of


def test_sums_are_one_count_in_order_of_time(merged):
    """Bags come in any order, all at once or one by one; the sum is that of their series one after the other."""
    outcomes = [merged.add(f"b{i}", first=1000 * i, seed=3 + i) for i in range(5)]
    merged.merge(*(outcomes[i] for i in (3, 0, 4, 2, 1)))
    closed, points = {}, []
    for i in range(5):
        file = merged.directory / "bags" / f"b{i}.sqlite"
        for steps, low, count in execute(file, "SELECT steps, low, count FROM cycles WHERE channel = 1"):
            closed[steps, low] = closed.get((steps, low), 0) + count
        points += [c for c, in execute(file, "SELECT class FROM residues WHERE channel = 1 ORDER BY place")]
    across, residue = sample.count_all(points)
    for (a, b), n in across.items():
        closed[b - a, a] = closed.get((b - a, a), 0) + n
    assert across
    at = merged.ask("SELECT machine_channel FROM machine_channels WHERE name = 'hull_wrench/force_z'")[0][0]
    cycles = merged.ask(f"SELECT steps, low, count FROM machine_cycles WHERE machine_channel = {at}")
    assert {(steps, low): n for steps, low, n in cycles} == closed
    left = merged.ask(f"SELECT class FROM machine_residues WHERE machine_channel = {at} ORDER BY place")
    assert [level for level, in left] == residue
    for outcome in reversed(outcomes):
        merged.merge(outcome, target="pieces.sqlite")
    for sql in ("SELECT hours, damage, remaining_hours FROM machine_channels ORDER BY name",
                "SELECT equivalent_range FROM machine_equivalents ORDER BY 1",
                "SELECT steps, low, count FROM machine_cycles ORDER BY 1, 2, 3"):
        for one, other in zip(merged.ask(sql), merged.ask(sql, "pieces.sqlite")):
            assert one == pytest.approx(other)


def test_again_changes_nothing(merged):
    outcomes = [merged.add("a"), merged.add("b", first=900, seed=2), merged.add("c", status="failed")]
    assert merged.merge(*outcomes) == "3 bags, 3 new or changed"
    before = merged.ask("SELECT * FROM runs"), merged.ask("SELECT * FROM bags")
    assert merged.merge(*outcomes) == "3 bags, 0 new or changed"
    assert (merged.ask("SELECT * FROM runs"), merged.ask("SELECT * FROM bags")) == before


def test_a_changed_bag_replaces_itself(merged):
    hours = lambda: merged.ask("SELECT max(hours) FROM machine_channels")[0][0]  # noqa: E731
    a, b = merged.add("a"), merged.add("b", first=900, seed=2)
    merged.merge(a, b)
    merged.add("b", first=900, seed=7, seconds=80.0)
    assert merged.merge(a, b) == "2 bags, 1 new or changed"
    assert merged.ask("SELECT count(*), sum(turns) FROM runs") == [(2, 600)]
    assert hours() == pytest.approx(120 / 3600, abs=1e-4)
    assert merged.ask("SELECT count(*) FROM cycles WHERE run_id NOT IN (SELECT run_id FROM runs)") == [(0,)]
    merged.add("b", status="failed")
    merged.merge(a, b)
    assert hours() == pytest.approx(40 / 3600, abs=1e-4)


def test_the_same_recording_counts_once(merged):
    merged.merge(merged.add("a"), merged.add("copy_of_a"))
    assert merged.ask("SELECT bag, status FROM bags ORDER BY bag") == [("/in/a.bag", "done"), ("/in/copy_of_a.bag", "twice")]
    assert merged.ask("SELECT count(*) FROM runs") == [(1,)]


def test_half_a_database_is_a_row_with_its_reason(merged):
    outcomes = merged.add("whole"), merged.add("half", first=900, seed=2), merged.add("other", first=99, seed=4)
    half, other = (outcome.with_suffix(".sqlite") for outcome in outcomes[1:])
    content = half.read_bytes()
    half.write_bytes(content[:len(content) * 2 // 3 // 4096 * 4096])
    other.write_bytes(b"")
    merged.merge(*outcomes)
    rows = {bag: (status, reason) for bag, status, reason in merged.ask("SELECT bag, status, reason FROM bags")}
    assert [rows[f"/in/{name}.bag"][0] for name in ("whole", "half", "other")] == ["done", "failed", "failed"]
    assert "cannot be read" in rows["/in/half.bag"][1]
    assert merged.ask("SELECT count(*), (SELECT count(DISTINCT run_id) FROM cycles) FROM runs") == [(1, 1)]


def test_another_hammer_is_never_mixed(merged):
    merged.merge(merged.add("a", of=sample.Machine("old")), merged.add("b", first=900, seed=2, of=sample.Machine("new")))
    assert merged.ask("SELECT count(*), count(DISTINCT identity) FROM machine_channels") == [(6, 2)]


def test_a_kill_between_bags_and_sums_is_repaired(merged):
    a = merged.add("a")
    merged.merge(a)
    execute(merged.path, "INSERT INTO stale_machines VALUES('red')",
            *(f"DELETE FROM machine_{table}" for table in ("channels", "cycles", "equivalents", "residues")))
    merged.merge(a)
    assert merged.ask("SELECT count(*) FROM machine_channels") == [(3,)]


def test_other_files_are_refused(merged):
    text, database = merged.directory / "text", merged.directory / "db"
    text.write_bytes(b"mine")
    sample.make(database, seconds=5.0)
    for path in (text, database):
        before = path.read_bytes()
        done = subprocess.run([sys.executable, str(FLEET / "merge.py"), str(path)], input="", capture_output=True, text=True)
        assert (done.returncode, done.stderr.count("\n")) == (1, 1), done.stderr
        assert path.read_bytes() == before


def test_a_page_of_the_merged_file_has_the_same_figures(merged):
    """The page of one bag has the figures of the bag's own page."""
    a = merged.add("a")
    merged.merge(a)
    own, other = (subjects_of(Database(file))[0].counted_channels() for file in (a.with_suffix(".sqlite"), merged.path))
    assert [(c.name, c.equivalents()) for c in own] == [(c.name, c.equivalents()) for c in other]


def test_bags_of_one_file_name_are_shown_with_their_folder(merged):
    merged.merge(merged.add("a"), merged.add("b", first=900, seed=2), merged.add("c", first=1800, seed=3))
    execute(merged.path, "UPDATE bags SET bag = '/disk' || bag_id || '/same.bag' WHERE bag <> '/in/c.bag'")
    assert [row["Recording"] for row in merged.page().table("Runs").values()] == ["/disk1/same", "/disk2/same", "c"]
