"""scripts/demo as a newcomer runs it, for a shorter time and without a build: what it leaves is right and says so."""
import csv
import os
import pathlib
import sqlite3
import statistics
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SECONDS = 8
SAME_BLOW = 0.002  # [s]; the filter finds the instant to some 0.01 ms
ENERGY_ERROR = 0.02


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """Directory of what it left, and what it printed."""
    output = tmp_path_factory.mktemp("demo")
    build = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"]).parents[2]
    done = subprocess.run([str(SOURCE / "scripts" / "demo"), str(output), str(SECONDS)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True,
                          env=dict(os.environ, HAMMER_LOADS_BUILT="1", BUILD_DIR=str(build)))
    assert done.returncode == 0, done.stdout
    print(done.stdout)
    return output, done.stdout


def rows(demo, query):
    with sqlite3.connect(str(demo[0] / "demo.sqlite")) as database:
        return database.execute(query).fetchall()


def true_blows(demo):
    """(stamp [s], energy [J])"""
    with open(demo[0] / "true_blows.csv", newline="") as file:
        return [(float(row["stamp_s"]), float(row["energy_J"])) for row in csv.DictReader(file)]


def test_the_page_has_no_warning(demo):
    assert rows(demo, "SELECT text FROM warnings") == []
    assert "No warnings." in (demo[0] / "demo.html").read_text()


def test_every_true_blow_is_found_and_no_other(demo):
    true = [stamp for stamp, _ in true_blows(demo)]
    found = [1e-9 * stamp for stamp, in rows(demo, "SELECT stamp_ns FROM blows ORDER BY stamp_ns")]
    assert len(true) > 15
    assert len(found) == len(true)
    assert max(abs(a - b) for a, b in zip(found, true)) < SAME_BLOW


def test_the_energy_is_the_true_one(demo):
    true = statistics.median(energy for _, energy in true_blows(demo))
    found = statistics.median(energy for energy, in rows(demo, "SELECT energy FROM blows"))
    print("median energy %.1f J, true %.1f J" % (found, true))
    assert abs(found / true - 1.0) < ENERGY_ERROR


def test_every_crank_sample_is_logged(demo):
    samples = len((demo[0] / "true_samples.csv").read_text().splitlines()) - 1
    assert "%d crank samples logged, " % samples in demo[1]
    assert samples == pytest.approx(1000 * SECONDS, abs=2)


def test_table_and_page_state_the_truth_and_the_picture_is_there(demo):
    blows = len(true_blows(demo))
    energy = statistics.median(energy for _, energy in true_blows(demo))
    lines = {line[:30].strip(): line[30:].split() for line in demo[1].splitlines()}
    assert lines["blows"] == [str(blows), str(blows), "+0"]
    assert "%.0f" % energy in lines["blow energy, median"]
    page = (demo[0] / "demo.html").read_text()
    assert "%d, true %d" % (blows, blows) in page
    assert ", true %.4g J" % energy in page
    assert (demo[0] / "demo.png").stat().st_size > 50000
