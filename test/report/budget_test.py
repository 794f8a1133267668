"""Uncertainty budgets: of a recording by the command, combined over runs, on the page."""
import json

import pytest

from support import DATA, needs_programs, page_of, report_here, with_budget

ROWS = [("blow/energy", 900.0, 20.0, "rocker_mass_kg", 0.64), ("blow/energy", 900.0, 20.0, "readings", 0.36)]


def test_bars_of_the_page_are_as_long_as_the_shares(made):
    rows = [*ROWS, ("equivalent_range_3/joint_loads/boom_joint/total_torque", 9.0, 1.0, "readings", 1.0)]
    page = page_of(with_budget(made(), rows))
    parts = [(given["title"], float(given["style"].split(": ")[1].rstrip("%")))
             for tag, given in page.tags if tag == "i" and "style" in given]
    assert [part for part in parts if not part[0].startswith("the rest")] == [
        ("rocker_mass_kg: 64 %", 64.0), ("readings: 36 %", 36.0), ("readings: 100 %", 100.0)]
    assert page.table("Uncertainty budget")["blow energy"]["Largest source"] == "rocker_mass_kg (64 %)"


@needs_programs
def test_command_reads_a_bag():
    done = report_here(DATA / "mo100_1khz.bag", "--json", command="budget")
    assert done.returncode == 0, done.stderr
    machine, = json.loads(done.stdout)["machines"]
    found = {figure["quantity"]: figure for figure in machine["figures"]}
    for quantity in ("pulse/turn_impulse_z", "pulse/amplitude", "blow/energy", "equivalent_range_3/hull_wrench/force_z"):
        shares = [source["share"] for source in found[quantity]["sources"]]
        assert sum(shares) == pytest.approx(1.0, abs=1e-9)
        assert shares == sorted(shares, reverse=True)
        assert found[quantity]["std"] > found[quantity]["std_with_largest_halved"]
    assert "rocker_mass_kg" in [s["source"] for s in found["pulse/turn_impulse_z"]["sources"]]


def test_text_and_csv_state_every_source(made):
    path = with_budget(made(), ROWS)
    assert "blow energy: 900 +- 20 J; 14 J with" in report_here(path, command="budget").stdout
    header, *rows = (line.split(",") for line in report_here(path, "--csv", command="budget").stdout.splitlines())
    assert [(row[header.index("source")], float(row[header.index("share")])) for row in rows] == [
        ("rocker_mass_kg", 0.64), ("readings", 0.36)]


def test_wrong_files_are_named(made):
    path = made()
    for arguments, code, words in (([path], 1, "holds no budget"), (["no.bag"], 1, "no.bag"),
                                   ([path, "--json", "--csv"], 2, "not allowed")):
        done = report_here(*arguments, command="budget")
        assert (done.returncode, len(done.stderr.splitlines())) == (code, 1)
        assert words in done.stderr
