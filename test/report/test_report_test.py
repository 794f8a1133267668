"""Test reports: results with expanded uncertainties, rounded as JCGM 100 asks, and what they rest on."""
import re

import pytest

from support import DATA, SOURCE, Reader, assert_refused, execute, needs_programs, report_here, with_budget
from budget_test import ROWS
from report.formats import rounded


@pytest.fixture
def parts(tmp_path):
    """(text by the title of a part, table by its first title: cells by the first) of a file's test report."""
    def read(*arguments):
        out = tmp_path / "page.html"
        done = report_here(*arguments, "--html", out, "--force", command="test_report")
        assert done.returncode == 0, done.stderr
        reader = Reader(out.read_text(encoding="utf-8"))
        pieces = re.split("(What was measured|Results|Input quantities|What was checked|Reservations|Method)\n", reader.text)
        tables = {rows[0][0]: {row[0]: row[1:] for row in rows[1:]} for rows, in reader.tables.values()}
        return dict(zip(pieces[1::2], pieces[2::2])), tables
    return read


@pytest.mark.parametrize("value, uncertainty, shown", [
    (1006.99, 86.19, ("1\u202f007", "86")), (0.18302, 0.01746, ("0.183", "0.017")),
    (-11996.4, 17258.0, ("\u221212\u202f000", "17\u202f000")), (3.5, None, ("3.5", "\u2013"))])
def test_an_uncertainty_has_two_digits_and_the_value_as_many_places(value, uncertainty, shown):
    assert rounded(value, uncertainty) == shown


def test_expanded_uncertainty_is_twice_the_std(made, parts):
    assert parts(with_budget(made(), ROWS))[1]["Measurand"]["blow energy"] == ["900", "40", "J", "rocker_mass_kg 64 %, readings 36 %"]


def test_every_input_of_more_than_a_hundredth_is_listed(made, parts):
    path = with_budget(made(), [
        ("pulse/amplitude", 8e3, 300.0, "rod_stiffness_N_m", 0.82), ("pulse/amplitude", 8e3, 300.0, "rocker_mass_kg", 0.175),
        ("pulse/amplitude", 8e3, 300.0, "rod_mass_kg", 0.005), ("blow/energy", 900.0, 20.0, "rocker_mass_kg", 0.98),
        ("blow/energy", 900.0, 20.0, "crank_length_m", 0.015), ("blow/energy", 900.0, 20.0, "rod_mass_kg", 0.005)])
    execute(path, "INSERT INTO parameters VALUES(1, 'rod_stiffness_N_m', '6e8', '0'), (1, 'rod_stiffness_std_N_m', '4e8', '4e8'), "
                  "(1, 'crank_length_m', '0.05', '0.048')")
    inputs = parts(path)[1]["Input quantity"]
    assert list(inputs) == ["rocker_mass_kg", "rod_stiffness_N_m", "crank_length_m"]
    assert inputs["rod_stiffness_N_m"] == ["6e8", "4e8", "82 % of u\u00b2 of peak force along the tool"]
    assert inputs["crank_length_m"][:2] == ["0.05", "\u2013"]


def test_a_check_that_failed_is_a_reservation(made, parts):
    assert parts(with_budget(made("one", restarts=1), ROWS))[0]["Reservations"].strip() == "None."
    assert "Restarts: 4, look" in parts(with_budget(made("four", restarts=4), ROWS))[0]["Reservations"]


def test_files_without_a_budget_or_of_two_machines_get_none(made, tmp_path):
    page, files = tmp_path / "page.html", [made("a"), made("b")]
    assert_refused(report_here(files[0], "--html", page, command="test_report"), "holds no budget")
    assert_refused(report_here(*files, "--html", page, command="test_report"), "one machine's recording, not of 2")
    assert not page.exists()


@needs_programs
def test_the_report_of_a_bag_names_inputs_and_checks(parts):
    texts, tables = parts(DATA / "mo100_1khz.bag")
    assert tables["Input quantity"]["rocker_mass_kg"][:2] == ["35.2", "0.704"]
    assert tables["Check"]["Consistency"][1] == "ok"
    assert "no hammer file was given" in texts["Reservations"]


@needs_programs
def test_inputs_whose_std_no_file_gives_have_the_usual_one(parts, tmp_path):
    """Half of a rod's mass, 0.3 mm of a length."""
    hammer = tmp_path / "hammer.yaml"
    lines = (SOURCE / "config" / "hammer_mo100.yaml").read_text(encoding="utf-8").splitlines()
    hammer.write_text("\n".join(line for line in lines if "_std" not in line) + "\n", encoding="utf-8")
    inputs = parts(DATA / "mo100_1khz.bag", "--params", hammer)[1]["Input quantity"]
    assert [inputs[key][:2] for key in ("rod_mass_kg", "crank_length_m", "rod_stiffness_N_m")] == [
        ["4.5", "2.25"], ["0.048", "0.0003"], ["not given", "4e+08"]]
