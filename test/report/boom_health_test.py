"""The boom's oil over runs: the page against what the database was made of."""
import pytest

import sample_database as sample
from support import page_of, value


@pytest.fixture
def page(made):
    """Page of so many runs with this oil: stiffness of the first, change from run to run, doubtful."""
    return lambda runs, **oil: page_of(made(machine=sample.Machine(oil=oil), runs=runs))


def cylinders(page):
    return page.table("Stiffness of the oil over that of the boom file, mean of a run")


def test_changes_are_reported(page):
    shown = page(3, arm_cylinder=(0.9, 0.0, 0), boom_cylinder=(1.1, -0.05, 0), hammer_cylinder=(1.0, 0.04, 0))
    rows = cylinders(shown)
    assert [rows[f"{name}_cylinder"]["Verdict"] for name in ("arm", "boom", "hammer")] == ["as before", "softer", "stiffer"]
    assert rows["boom_cylinder"]["Change"] == "-9.1 %"
    assert [value(rows["boom_cylinder"][at]) for at in ("First run", "Last run")] == pytest.approx([1.1, 1.0], abs=0.005)
    picture = shown.drawn("Stiffness of the oil by run")
    for kind, truth in zip(picture.classes("line"), ((0.9, 0.9, 0.9), (1.1, 1.05, 1.0), (1.0, 1.04, 1.08))):
        curve, = picture.curves(kind)[:1]
        assert [round(x) for x, _ in curve] == [1, 2, 3]
        assert [y for _, y in curve] == pytest.approx(truth, abs=0.005)


def test_a_value_damped_by_something_else_is_no_trend(page):
    assert cylinders(page(2, arm_cylinder=(0.9, -0.3, 1)))["arm_cylinder"]["Verdict"].startswith("uncertain: ")


def test_one_run_has_nothing_to_compare(page):
    shown = page(1, arm_cylinder=(0.9, 0.0, 0))
    row, mode = cylinders(shown)["arm_cylinder"], shown.table("Modes of the last run, over its poses")["1"]
    assert (row["Verdict"], row["Change"]) == ("one run: nothing to compare", "\u2013")
    assert (mode["Frequency [Hz]"], mode["Turns"]) == ("4 to 4.09", "100")
