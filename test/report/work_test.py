"""Work, its pauses, its values, and what they cost: the page against formulas and SQL of the same database."""
import statistics

import pytest

from support import execute, page_of, value
import sample_database as sample


@pytest.fixture
def site(made):
    return made(seconds=200.0)


def figures(page):
    """{name: value} of the large numbers."""
    parts = {tag: [text for name, text in page.pieces if name == tag] for tag in ("dt", "dd")}
    return dict(zip(parts["dt"], parts["dd"]))


def test_nothing_is_drawn_where_there_was_no_work(made):
    """Two runs, one with a pause, have no line from a blow before the pause to the one after it."""
    pause = (f"DELETE FROM {table} WHERE run_id = 1 AND turn BETWEEN 200 AND 260" for table in ("turns", "blows", "turn_loads"))
    file = made("site", *pause, seconds=100.0, runs=2, boom=True)
    page = page_of(file)
    pictures = [p for p in page.pictures if p.title.startswith(("Blow rate:", "Blow energy:", "Restitution:", "joint_loads/"))]
    assert len(pictures) > 5
    for picture in pictures:
        for kind in picture.classes("line"):
            lines = [piece for piece in picture.curves(kind) if len(piece) > 2]
            assert len(lines) % 3 == 0, picture.title  # three stretches of work, of the mean or of each edge
    seconds = [[60.0 * line[0][0], 60.0 * line[-1][0]] for line in page.drawn("Blow energy:").curves("line first")]
    assert sum(seconds[:3], []) == pytest.approx([0.0, 39.8, 52.2, 100.0, 100.0, 200.0], abs=0.7)


def test_key_figures_are_those_of_the_blows(site):
    shown = figures(page_of(site))
    blows, seconds = execute(site, "SELECT blows, duration FROM runs")[0]
    energies = [energy for energy, in execute(site, "SELECT energy FROM blows")]
    assert value(shown["blows per hour of work"]) == pytest.approx(blows / seconds * 3600.0, abs=1.0)
    assert value(shown["energy of all blows"]) == pytest.approx(sum(energies) / 1e3, rel=1e-3)
    median, spread = map(value, shown["blow energy, median \u00b1 spread"].split("\u00b1"))
    assert median == pytest.approx(statistics.median(energies), abs=0.1)
    assert sum(abs(e - median) <= spread for e in energies) / len(energies) == pytest.approx(0.6827, abs=0.05)


LIMIT = "INSERT INTO parameters VALUES(1, 'limit_peak_force_warn_N', '9000.0', NULL)"
START = 1700000060 * sample.SECOND


@pytest.fixture
def measured(made):
    """Limits exceeded, a measured load, and standard deviations of the measurement."""
    alarm = "INSERT INTO alarms VALUES(1, '%s', %d, 'N', %s, %s, %s, %d, %d, %d)"
    return made(
        "measured", LIMIT, alarm % ("peak_force", 1, 9120.0, 87.0, 9000.0, START, START + sample.SECOND, 6),
        alarm % ("peak_force", 1, 9456.0, 91.0, 9000.0, START + 9 * sample.SECOND, START + 9 * sample.SECOND, 1),
        alarm % ("hold_down_force", 2, 3100.0, "NULL", 3000.0, START, START + sample.SECOND, 1234),
        "INSERT INTO reference VALUES (1, 'force_z', 'N', 20000, 4200.0, 84.0, -30.0, 0.985, 0.99871, 0.968)",
        "UPDATE blows SET energy_std = 7.0, restitution_std = 0.3", seconds=200.0)


def test_exceeded_limits_are_shown(made, measured):
    kept = page_of(made("kept", LIMIT)).text
    assert "No limit was exceeded" in kept and "limit exceeded" not in kept and "Measured reference" not in kept
    page = page_of(measured)
    assert [words for tag, words in page.pieces if tag == "li" and words.startswith("limit exceeded")] == [
        "limit exceeded (ERROR): hold_down_force 3100 N, limit 3000 N, in 1\u202f234 revolutions",
        "limit exceeded (WARN): peak_force 9\u202f456 \u00b1 91 N, limit 9000 N, in 7 revolutions"]
    row = page.table("Limits exceeded")["peak_force"]
    assert [row[name] for name in ("Level", "Farthest beyond it", "Revolutions", "Times")] == [
        "WARN", "9\u202f456 \u00b1 91 N", "7", "2"]
    assert "2023-11-14 22:14:20" in row["First"]


def test_a_measured_load_is_compared_with_the_computed_one(measured):
    assert page_of(measured).table("Computed and measured load")["force_z"] == {
        "Run": "1", "Samples": "20\u202f000", "Measured, rms": "4.2 kN", "Error, rms": "0.084 kN", "Error, relative": "2 %",
        "Bias": "\u22120.03 kN", "Scale": "0.985", "Correlation": "0.99871", "Within two": "96.8 %"}


def test_std_of_the_measurement_where_it_is_known(measured):
    """An axis of values is not finer than the standard deviation of their measurement: noise within it looks like it."""
    page = page_of(measured)
    assert figures(page)["blow energy, median \u00b1 deviation"].endswith("\u00b1 7.0 J")
    picture = page.drawn("Restitution:")
    heights = [y for piece in picture.curves("band first") for _, y in piece]
    low, high = picture.range_of("y")
    assert high - low >= 2 * 0.3
    assert max(heights) - min(heights) < 0.3 * (high - low)


@pytest.mark.parametrize("caption, sql", [("Blows by blow energy", "SELECT energy FROM blows"),
                                          ("Blows by peak force along the tool", "SELECT amplitude / 1000 FROM turns")])
def test_histograms_hold_every_blow(site, caption, sql):
    values, rows = [v for v, in execute(site, sql)], page_of(site).table(caption)
    assert sum(value(row["Blows"]) for row in rows.values()) == len(values)
    for edges, row in rows.items():
        low, high = map(value, edges.split(" to "))
        assert value(row["Blows"]) == sum(low <= v < high for v in values), edges


def test_starting_turns_do_not_stretch_a_histogram(made, site):
    page = page_of(made("odd", "UPDATE blows SET energy = 1.0 WHERE turn < 4", "UPDATE blows SET energy = 90000.0 WHERE turn = 10",
                        seconds=200.0))
    assert page.drawn("Blow energy of").range_of("x") == page_of(site).drawn("Blow energy of").range_of("x")
    assert "4 of them, as at start and stop, lie beyond the picture" in page.text
    assert sum(value(row["Blows"]) for row in page.table("Blows by blow energy").values()) == 1000


def test_omits_a_blow_whose_energy_is_withheld(made):
    file = made("site", "UPDATE blows SET restitution = NULL, energy = NULL WHERE turn IN (10, 20, 30, 40, 50)", seconds=200.0)
    page = page_of(file)
    assert min(y for piece in page.drawn("Blow energy:").curves("band first") for _, y in piece) > 0.0
    rows = page.table("Over all revolutions")
    count, least, total = execute(file, "SELECT count(*), min(energy), sum(energy) FROM blows WHERE energy > 0")[0]
    assert value(rows["Blow energy [J]"]["Values"]) == count
    assert value(rows["Blow energy [J]"]["Least"]) == pytest.approx(least, rel=1e-3)
    assert value(rows["Restitution"]["Least"]) > 0.0
    assert value(rows["Hold-down needed [kN]"]["Values"]) == count - 1
    assert sum(value(row["Blows"]) for row in page.table("Blows by blow energy").values()) == count
    assert value(figures(page)["energy of all blows"]) == pytest.approx(total / 1e3, rel=1e-3)
    assert "energy and restitution are withheld: 5 of 1000" in page.text


def test_runs_of_one_machine_are_compared_by_names_and_not_by_hashes(made):
    file = made("site", "UPDATE blows SET energy = 1.2 * energy WHERE run_id = 3",
                "INSERT INTO warnings VALUES(2, 0, 'jitter', 'crank stamps jitter')", seconds=60.0, runs=3)
    medians = [statistics.median(e for e, in execute(file, f"SELECT energy FROM blows WHERE run_id = {run}")) for run in (1, 2, 3)]
    page = page_of(file)
    header, *rows = page.tables["Runs below each other"][0]
    at = header.index("Blow energy [J]")
    assert [row[0] for row in rows] == ["site, run 1", "site, run 2", "site, run 3"]
    assert [row["Recording"] for row in page.table("Runs").values()] == [row[0] for row in rows]
    assert [value(row[at]) for row in rows] == pytest.approx(medians, rel=1e-2)
    assert rows[0][at + 1] == ""
    assert value(rows[2][at + 1]) == pytest.approx(100.0 * (medians[2] / medians[0] - 1.0), abs=1.0)
    assert [row[at].endswith("?") for row in rows] == [False, True, False]
    for hashes in execute(file, "SELECT machine, input_sha256, run_key FROM runs"):
        assert not [one for one in hashes if one[:8] in page.text]


SLOPE, DEAR = 5.0, 30  # turns, of 1000, with twice the range


@pytest.fixture
def dear(made):
    """A channel of which three turns in a hundred have twice the range."""
    return made("site", "UPDATE turn_loads SET minimum = 0.0, maximum = CASE WHEN turn <= 30 THEN 80e3 ELSE 40e3 END WHERE channel = "
                "(SELECT channel FROM channels WHERE name = 'hull_wrench/force_z')",
                machine=sample.Machine(curve=False), seconds=200.0, first_ns=1700002700 * sample.SECOND)


def test_dearest_blows_are_named(dear):
    share = 100.0 * DEAR * 2.0 ** SLOPE / (DEAR * 2.0 ** SLOPE + 1000 - DEAR)
    page = page_of(dear)
    assert float(page.text.split("; 3 % of the blows did ")[1].split(" %")[0]) == pytest.approx(share, abs=0.1)
    assert all(int(row["Turn"]) <= DEAR for row in page.table("Most damaging revolutions").values())


def test_damage_is_shown_by_hour(dear):
    """The recording begins 100 s before a full hour (22:58:20): the dear turns are in the first."""
    rows = page_of(dear).table("Damage by hour")
    assert sorted(rows) == ["2023-11-14 22:00", "2023-11-14 23:00"]
    first, second = (value(rows[k]["Turns"]) for k in sorted(rows))
    assert first + second == 1000
    damage = (DEAR * 2.0 ** SLOPE + first - DEAR) / (DEAR * 2.0 ** SLOPE + 1000 - DEAR)
    assert value(rows[min(rows)]["Damage [%]"]) == pytest.approx(100.0 * damage, abs=0.1)


@pytest.fixture
def misused(made):
    """Two runs, of which the second knows less of its misuse."""
    return made("site", "UPDATE runs SET blows_without_hold_down = NULL, still_time = NULL WHERE run_id = 2",
                machine=sample.Machine(curve=False, misuse=(6, 500, 20, 12.5)), seconds=100.0, runs=2)


def test_damage_by_recording_is_by_its_cycles(misused):
    file, totals = misused, []
    for run in (1, 2):
        where = f"JOIN channels USING(run_id, channel) WHERE run_id = {run} AND name = 'hull_wrench/force_z'"
        closed = execute(file, f"SELECT steps, count FROM cycles {where}")
        ends = [r for r, in execute(file, f"SELECT class FROM residues {where} ORDER BY place")]
        halves = [(abs(a - b), 0.5) for a, b in zip(ends, ends[1:])]
        totals.append(sum(n * steps ** SLOPE for steps, n in closed + halves))
    rows = page_of(file).table("Damage by recording")
    assert [value(rows[f"site, run {run}"]["Damage [%]"]) for run in (1, 2)] == pytest.approx(
        [100.0 * total / sum(totals) for total in totals], abs=0.1)


def test_the_life_follows_the_load(dear):
    page = page_of(dear)
    assert value(page.table("Life over that of now")["0.9"]["slope 5"]) == pytest.approx(0.9 ** -5, abs=0.005)
    assert f"slope 10: {2 ** -0.1:.3f} of the load" in page.text


def test_life_follows_a_curve_of_two_slopes(made):
    """The life grows, where cycles fall below the knee, faster than by the steep slope, slower than by the other."""
    file = made("curve", seconds=100.0, boom=True)
    width, knee = execute(file, "SELECT (greatest - least) / classes, sn_knee_range FROM channels WHERE name = 'stress/boom_foot'")[0]
    cycles = execute(file, "SELECT steps, count FROM cycles JOIN channels USING(run_id, channel) WHERE name = 'stress/boom_foot'")
    ranges = {factor: [(steps * width * factor, n) for steps, n in cycles] for factor in (0.8, 0.9, 1.0, 1.1)}
    damage = {factor: sum(n * (r / knee) ** (3.0 if r >= knee else 5.0) for r, n in some) for factor, some in ranges.items()}
    rows = page_of(file).table("Life over that of now")
    for factor in (0.8, 0.9, 1.1):
        assert value(rows[str(factor)]["stress at boom_foot"]) == pytest.approx(damage[1.0] / damage[factor], rel=0.02)


def test_misuse_is_counted_over_the_runs_that_know(misused):
    file = misused
    hours = [h for h, in execute(file, "SELECT duration / 3600 FROM runs ORDER BY run_id")]
    blank, without, still = page_of(file).table("Misuse").values()
    assert (value(blank["Count"]), value(without["Count"]), value(still["Count"])) == (12, 20, 12.5)
    assert value(blank["Per hour"]) == pytest.approx(12 / sum(hours), abs=0.5)
    assert value(without["Per hour"]) == pytest.approx(20 / hours[0], abs=1.0)
    assert "of 500 blows" in without["Meaning"]


def test_misuse_that_nothing_measured_is_not_zero(site):
    assert [row["Count"] for row in page_of(site).table("Misuse").values()] == ["0", "not known", "not known"]
