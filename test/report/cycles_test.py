"""Cycles, damage-equivalent loads and damage: against ASTM E1049's example, a plain count of the whole, and life."""
import json
import random
import sqlite3
import subprocess

import numpy
import pytest

from support import execute, needs_programs, page_of, program
import sample_database as sample
from report.cycles import SLOPES, Count, Curve, at_alternating, equivalent_range
from report.database import Database
from report.ledger import epochs_of
from report.subjects import subjects_of

FIGURE_6 = [-2, 1, -3, 5, -1, 3, -4, 4, -2]  # of the standard


def test_counts_follow_the_standards_example():
    count = Count(-10.5, 10.5, 21)
    count.join([level + 10 for level in FIGURE_6])
    by_range = {}
    for r, _, n in count.cycles().T:
        by_range[round(r)] = by_range.get(round(r), 0.0) + n
    assert by_range == {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}
    for slope, expected in ((3.0, 10.3039982), (4.0, 9.58741061), (5.0, 9.25325663), (10.0, 8.82000396)):
        assert equivalent_range(count.cycles(), slope, 1.0)[0] == pytest.approx(expected, abs=5e-8)


def test_pieces_add_to_a_plain_count_of_the_whole():
    rng = random.Random(5)
    for _ in range(300):
        series = [rng.randrange(12) for _ in range(rng.randrange(2, 60))]
        closed, residue = sample.count_all(series)
        count, at = Count(0.0, 12.0, 12), 0
        while at < len(series):
            end = at + rng.randrange(1, 9)
            piece_closed, piece_residue = sample.count_all(series[at:end])
            count.add_closed((b - a, a, n) for (a, b), n in piece_closed.items())
            count.join(piece_residue)
            at = end
        assert count.residue == residue
        assert count.closed == {(b - a, a): n for (a, b), n in closed.items()}


def test_nothing_gives_no_cycles():
    cycles = Count(0.0, 1.0, 4).cycles()
    assert cycles.shape == (3, 0)
    assert equivalent_range(cycles, 3.0, 10.0) == (0.0, None)


@pytest.mark.parametrize("amplitude, mean, expected", [
    (2, 2, 2.6), (3, 3, 3.9), (3, 2, 3.6), (2, 4, 2.836363), (2, 3, 2.718181), (1, 3, 1.536363), (2, 1, 2.3), (2, -2, 1.4),
    (2, -9, 1.4)])
def test_mean_stress_follows_fkm(amplitude, mean, expected):
    assert at_alternating(amplitude, mean, 0.3)[0] == pytest.approx(expected, abs=2e-6)


def test_std_is_the_difference():
    """All ranges larger by one deviation."""
    cycles, shift = numpy.array([(50.0, 120.0), (3.0, -8.0), (10.0, 2.5)]), 1e-5
    moved = cycles + [[shift], [0.0], [0.0]]
    for slope in SLOPES:
        value, deviation = equivalent_range(cycles, slope, 7.0, (shift, 0.0))
        assert equivalent_range(moved, slope, 7.0)[0] - value == pytest.approx(deviation, rel=1e-4)
        value, deviation = equivalent_range(cycles, slope, 7.0, (0.0, 0.02))
        assert deviation / value == pytest.approx(0.02)
    curve = Curve(100.0, 1e6, 3.0, 5.0, 0.3)
    value, deviation = curve.damage(cycles, (shift, 0.0))
    assert curve.damage(moved)[0] - value == pytest.approx(deviation, rel=1e-4)


def test_runs_of_a_machine_add(made):
    """Two runs joined are one count of both series; the hours add."""
    file = made(seconds=100.0, runs=2, classes=64)
    channel = subjects_of(Database(file))[0].counted_channels()[1]
    points = [c for c, in execute(file, "SELECT class FROM residues WHERE channel = 1 ORDER BY run_id, place")]
    closed, residue = sample.count_all(points)
    assert channel.count.residue == residue
    assert sum(channel.count.closed.values()) == sum(closed.values()) + execute(
        file, "SELECT sum(count) FROM cycles WHERE channel = 1")[0][0]
    assert channel.hours == pytest.approx(200.0 / 3600.0, abs=2e-4)


LEDGER = """
CREATE TABLE epochs(epoch INTEGER PRIMARY KEY, machine TEXT, equivalent_cycles_per_hour REAL);
CREATE TABLE channels(channel INTEGER PRIMARY KEY, epoch INTEGER, name TEXT, unit TEXT, least REAL, greatest REAL,
  classes INTEGER, sn_knee_range REAL, sn_knee_cycles REAL, sn_slope REAL, sn_slope_below REAL,
  mean_stress_sensitivity REAL);
CREATE TABLE runs(run INTEGER PRIMARY KEY, name TEXT, epoch INTEGER, pieces INTEGER, parameters TEXT,
  messages INTEGER);
CREATE TABLE days(day INTEGER PRIMARY KEY, epoch INTEGER, run INTEGER, date TEXT, duration_ns INTEGER, turns INTEGER);
CREATE TABLE tallies(channel INTEGER, day INTEGER, counted INTEGER, skipped INTEGER, below INTEGER, above INTEGER,
  gaps INTEGER, deviations INTEGER, deviation_sum INTEGER, least REAL, greatest REAL, range_square INTEGER,
  range_own INTEGER, range_common INTEGER, PRIMARY KEY(channel, day));
CREATE TABLE cycles(channel INTEGER, day INTEGER, steps INTEGER, low INTEGER, count INTEGER,
  PRIMARY KEY(channel, day, steps, low));
CREATE TABLE residues(channel INTEGER, run INTEGER, place INTEGER, class INTEGER, PRIMARY KEY(channel, run, place));
CREATE TABLE marks(mark INTEGER, run INTEGER, PRIMARY KEY(mark, run));
CREATE TABLE columns(table_name TEXT, column_name TEXT, unit TEXT, description TEXT);
INSERT INTO epochs VALUES(1, 'mo100', 3600.0);
INSERT INTO channels VALUES(1, 1, 'hull_wrench/force_z', 'N', -2e5, 2e5, 512, NULL, NULL, NULL, NULL, NULL);
INSERT INTO channels VALUES(2, 1, 'stress/weld', 'MPa', -4e2, 4e2, 256, 80.0, 1e7, 3.0, 5.0, 0.3);
INSERT INTO runs VALUES(1, 'a', 1, 3, '', 3000);
INSERT INTO runs VALUES(2, 'b', 1, 1, '', 3000);
INSERT INTO days VALUES(1, 1, 1, '2026-01-31', 7200000000000, 36000);
INSERT INTO days VALUES(2, 1, 2, '2026-02-01', 1800000000000, 9000);
"""


@pytest.fixture
def ledger(tmp_path):
    """Counts of a random series over two days, a run on each."""
    path = tmp_path / "machine.sqlite"
    rng, db = random.Random(3), sqlite3.connect(str(path))
    db.executescript(LEDGER)
    for channel, classes in ((1, 512), (2, 256)):
        for day in (1, 2):
            series = [min(classes - 1, max(0, int(rng.gauss(classes / 2, classes / 9)))) for _ in range(3000)]
            closed, residue = sample.count_all(series)
            db.executemany("INSERT INTO cycles VALUES(?,?,?,?,?)",
                           [(channel, day, b - a, a, n) for (a, b), n in closed.items()])
            db.executemany("INSERT INTO residues VALUES(?,?,?,?)", [(channel, day, place, c) for place, c in enumerate(residue)])
            db.execute("INSERT INTO tallies VALUES(?,?,3000,2,1,0,1,3000,?,-1e3,1e3,0,0,0)", (channel, day, 3000 * 300 * day))
    db.execute(f"PRAGMA application_id = {0x484C4C31}")
    db.execute("PRAGMA user_version = 1")
    db.commit()
    db.close()
    return path


def assert_same_figures(channel, expected):
    figures = {f"equivalent_range_{slope:g}": figure for slope, figure in channel.equivalents().items()}
    figures.update(damage=channel.damage(), remaining_hours=channel.remaining_hours())
    for name, figure in figures.items():
        theirs = expected[name] or {"value": None, "std": None}
        assert figure == pytest.approx((theirs["value"], theirs["std"]), rel=1e-12)
    assert channel.cycles[2].sum() == expected["cycles"]


@needs_programs
def test_figures_of_a_ledger_are_those_of_life(ledger):
    outcome = subprocess.run([program("life"), str(ledger), "--json"], stdout=subprocess.PIPE, check=True)
    theirs = json.loads(outcome.stdout)["epochs"][0]["channels"]
    epoch = epochs_of(Database(ledger))[0]
    for channel, expected in zip(epoch.channels(), theirs):
        assert_same_figures(channel, expected)
        assert channel.row["below"] + channel.row["above"] == expected["below"] + expected["above"]
    for at, (_, days) in enumerate(epoch.by_date()):
        for channel, expected in zip(epoch.channels(days), theirs):
            assert_same_figures(channel, expected["days"][at])


def test_the_page_shows_the_epoch_beside_a_recording(ledger, made):
    page = page_of(made("rec"), ledger)
    assert "Epoch 1: 2.5 hours" in page.text
    assert sorted(page.table("By the day on which a cycle closed")) == ["2026-01-31", "2026-02-01"]
    assert "Over all revolutions" in page.tables
    assert len(page.tables["Damage-equivalent loads"]) == 2


def test_an_empty_ledger_has_no_epoch(ledger):
    execute(ledger, "DELETE FROM epochs")
    assert "no epoch yet" in page_of(ledger).text
