"""Shipped questions on a fleet of which the answers are known."""
import csv
import io
import subprocess
import sys

import pytest

from fleet_support import FLEET
import sample_database as sample


def query(*arguments):
    return subprocess.run([sys.executable, str(FLEET / "query"), *map(str, arguments)], capture_output=True, text=True)


@pytest.fixture
def answer(merged):
    """Red strikes hard, blue's sensor jitters, green's bag is broken. A question's rows."""
    red = sample.Machine("red", peak_N=60000.0, parameters={"rocker_mass_kg": ("36.0", "35.2")})
    merged.merge(merged.add("r", of=red),
                 merged.add("b", "blue", of=sample.Machine("blue", jitter_s=4e-4), seconds=80.0, restarts=4, refusals={"duplicate": 8}),
                 merged.add("g", "green", status="failed"))

    def ask(name):
        done = query(name, merged.path, "--csv")
        assert (done.returncode, done.stderr) == (0, "")
        return list(csv.DictReader(io.StringIO(done.stdout)))
    return ask


def machine_row(rows, machine):
    return next(row for row in rows if row["machine"] == machine)


def test_every_question_has_its_answer(merged, answer):
    assert [row["machine"] for row in answer("worst_machines")] == ["red", "blue"]
    assert answer("restarts")[0]["restarts"] == "4"
    assert answer("highest_peaks")[0]["machine"] == "red"
    assert [(row["machine"], row["refused"]) for row in answer("refused_samples")] == [("blue", "8")]
    assert float(machine_row(answer("hours_and_blows"), "blue")["hours"]) == pytest.approx(80 / 3600, abs=1e-4)
    assert [row["bag"] for row in answer("failed_bags")] == ["/in/g.bag"]
    changed = [(row["key"], row["value"], row["machine"]) for row in answer("changed_parameters")]
    assert ("rocker_mass_kg", "36.0", "red") in changed
    assert [row["week"] for row in answer("energy_by_week")] == ["2023-W46", "2023-W46"]
    assert sum(float(row["energy_MJ"]) for row in answer("energy_by_week")) == pytest.approx(
        merged.ask("SELECT sum(total) / 1e6 FROM run_figures WHERE quantity = 'energy'")[0][0])
    assert len(answer("lowest_hold_down")) == 2
    assert answer("blank_turns") == answer("life_left") == []


def test_failed_bags_are_the_last_warnings_of_a_page(merged, answer):
    merged.merge(merged.add("a", "amber", status="failed", reason="/elsewhere/a.bag: no message on /hammer/crank"),
                 merged.add("z", "zinc", of=sample.Machine("zinc"), warnings=[("jitter", "crank stamps jitter")]))
    lines = [text for tag, text in merged.page().pieces if tag == "li"]
    warned, amber, green = (next(at for at, line in enumerate(lines) if words in line)
                            for words in ("crank stamps jitter", "bag /in/a.bag", "bag /in/g.bag"))
    assert warned < min(amber, green)
    assert lines[amber].count("a.bag") == 1


def test_machines_that_worked_minutes_in_different_years_fill_their_pictures(merged, answer):
    year = 365 * 86400
    merged.merge(*(merged.add(f"y{at}", "yellow", first=at * year, seed=at) for at in range(4)),
                 *(merged.add(f"v{at}", "violet", first=at * year + 1000, seed=9 + at) for at in range(4)))
    pictures = [p for p in merged.page().pictures if p.title.endswith("over the time of work")]
    assert len(pictures) == 5
    for picture in pictures:
        assert len(picture.x) > 2  # labels of the time
        assert [len(piece) for piece in picture.curves("line third")] == [4, 4, 4]  # mean and edges join the points of the runs
        places = [x for kind in picture.classes("line") for piece in picture.curves(kind) for x, _ in piece]
        assert max(places) < 200.0  # seconds of work, not years
        assert max(places) - min(places) > 0.9 * (picture.x[-1][0] - picture.x[0][0])
        assert len({round(place) for place in places}) >= 4


def test_misuse_is_counted_by_machine(merged, answer):
    merged.merge(merged.add("m", "mauve", of=sample.Machine("mauve", misuse=(3, 100, 5, None)), seconds=80.0))
    row = machine_row(answer("misuse"), "mauve")
    assert float(row["blank_firings_per_hour"]) == pytest.approx(3 * 3600 / 80, abs=0.5)
    assert float(row["blows_without_hold_down_per_hour"]) == pytest.approx(5 * 3600 / 80, abs=0.5)
    assert row["still_s_per_hour"] == ""


def test_boom_health_is_shown_by_month(merged, answer):
    """A cylinder that softens from one month to the next; what is doubtful is in no trend."""
    merged.merge(*(merged.add(f"o{at}", "olive", seed=at, first=40 * 86400 * at, of=sample.Machine(
        "olive", oil={"boom_cylinder": (stiffness, 0.0, 0), "arm_cylinder": (1.2, 0.0, 1)}))
        for at, stiffness in enumerate((1.0, 0.98, 0.8))))
    rows = [row for row in answer("boom_health") if row["machine"] == "olive"]
    assert [(row["cylinder"], row["month"], row["runs"]) for row in rows] == [
        ("boom_cylinder", month, "1") for month in ("2023-11", "2023-12", "2024-02")]
    assert [float(row["change_percent"]) for row in rows] == pytest.approx([0.0, -2.0, -20.0], abs=0.2)
    assert [float(row["std"]) for row in rows] == pytest.approx([0.01] * 3)


def test_sensors_to_calibrate_takes_warnings(merged, answer):
    """Sound figures and a warning: the sensor asks for it; a warning about something else does not."""
    assert [row["machine"] for row in answer("sensors_to_calibrate")] == ["blue"]
    merged.merge(merged.add("w", "white", of=sample.Machine("white"), runs=2,
                            warnings=[("zero", "crank_zero_rad: run calibrate"), ("jitter", "jitters")]),
                 merged.add("y", "yellow", of=sample.Machine("yellow"), warnings=[("hammer", "no hammer file")]))
    rows = answer("sensors_to_calibrate")
    white = machine_row(rows, "white")
    assert sorted(row["machine"] for row in rows) == ["blue", "white"]
    assert (white["runs"], white["warnings"], white["a_warning"]) == ("2", "2", "crank_zero_rad: run calibrate")


def test_every_shipped_question_runs_and_states_its_subject(answer):
    for path in FLEET.glob("queries/*.sql"):
        assert path.read_text().startswith("-- "), path
        answer(path.stem)


def test_a_file_that_is_no_database_is_refused():
    done = query("life_left", "/dev/null")
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)


def test_exceeded_limits_are_counted_by_machine_and_shown(merged, answer):
    alarm = "INSERT INTO alarms VALUES(1, 'hold_down_force', 2, 'N', %s, NULL, 3000.0, %d, %d, %d)"
    limit = "INSERT INTO parameters VALUES(1, 'limit_hold_down_force_error_N', '3000.0', NULL)"
    merged.merge(merged.add("o", "orange", sql=(limit, alarm % (2900.0, 10, 20, 4), alarm % (2400.0, 30, 40, 7))),
                 merged.add("p", "orange", sql=(limit, alarm % (2700.0, 50, 50, 1)), seconds=60.0))
    row, = answer("alarms")
    assert [row[name] for name in ("machine", "name", "alarms", "turns", "farthest_value")] == [
        "orange", "hold_down_force", "3", "12", "2400.0"]
    shown = merged.page("--machine", "orange").table("Limits exceeded")["hold_down_force"]
    assert (shown["Revolutions"], shown["Times"]) == ("12", "3")


def test_measured_loads_are_weighted_by_their_samples(merged, answer):
    reference = "INSERT INTO reference VALUES(1, 'force_z', 'N', %d, 4000.0, %s, %s, 1.0, 0.99, 0.95)"
    merged.merge(merged.add("o", "orange", sql=[reference % (100, 30.0, 10.0)]),
                 merged.add("p", "orange", sql=[reference % (300, 50.0, -10.0)], seconds=60.0))
    row, = answer("references")
    assert [row[name] for name in ("machine", "component", "runs", "samples")] == ["orange", "force_z", "2", "400"]
    assert float(row["rms_error"]) ** 2 == pytest.approx((900.0 + 3 * 2500.0) / 4)
    assert float(row["bias"]) == pytest.approx(-5.0)
