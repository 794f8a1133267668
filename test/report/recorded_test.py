"""From a recorded session to its page by the real process_bag: the page's figures against the session's truth."""
import csv
import statistics
import subprocess

import pytest

from support import DATA, Reader, assert_refused, execute, needs_programs, program, report_here

pytestmark = needs_programs
BAG = DATA / "mo100_1khz.bag"


@pytest.fixture
def page(tmp_path):
    """Page of the session, with these parameters and options."""
    def read(parameters, *options):
        out, file = tmp_path / "page.html", tmp_path / "parameters.yaml"
        file.write_text(parameters)
        done = report_here(BAG, "--params", file, *options, "--html", out)
        assert done.returncode == 0, done.stderr
        return Reader(out.read_text(encoding="utf-8"))
    return read


def truth(name):
    with open(DATA / f"mo100_1khz_{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_figures_are_those_of_the_session(page):
    shown = page("level: rocker\nlife_bandwidth_Hz: 100.0\n")
    energies = [float(row["blow_energy_J"]) for row in truth("blows")]
    median = float(shown.table("Over all revolutions")["Blow energy [J]"]["Median"])
    assert median == pytest.approx(statistics.median(energies), abs=0.02 * max(energies))
    assert "Typical revolution, number" in shown.text and "Worst revolution, number" in shown.text
    assert list(shown.table("Damage-equivalent loads")) == [f"{name}, below 100 Hz" for name in (
        "force across the tool, Fx", "force along the tool, Fz", "moment about the rocker pivot, My")]


def test_compares_a_measured_load_of_a_csv_file(page, tmp_path):
    """The session's truth, 0.9 times as large, with one of three components."""
    database, measured, rows = tmp_path / "first.sqlite", tmp_path / "cell.csv", truth("truth")
    subprocess.run([program("process_bag"), BAG, "--no-bag", "--db", database], check=True, capture_output=True)
    start = 1e-9 * execute(database, "SELECT first_stamp_ns FROM runs")[0][0] - float(rows[0]["t_s"])
    measured.write_text("# load cell\nstamp,channel 7,force_z\n" + "".join(
        f"{start + float(row['t_s']):.9f},x,{0.9 * float(row['hull_force_z_N'])!r}\n" for row in rows))
    row, = page("level: rocker\n", "--reference", measured).table("Computed and measured load").values()
    assert float(row["Scale"]) == pytest.approx(1.0 / 0.9, abs=0.01)
    assert float(row["Correlation"]) > 0.999


def test_a_measured_load_out_of_order_is_refused(tmp_path, capfd):
    measured = tmp_path / "cell.csv"
    measured.write_text("stamp,force_z\n1.0,2.0\n1.0,3.0\n")
    assert_refused(report_here(BAG, "--reference", measured, "--html", tmp_path / "x.html"), "process_bag ended with code 1")
    assert f"{measured}: line 3: '1.0,3.0', must be later than the line before" in capfd.readouterr().err
