"""Content of a page, read as a browser without JavaScript reads it, against independent queries of the database."""
import os
import re
import statistics
import subprocess
import sys

import pytest

from support import SOURCE, Reader, execute, page_of, report, value
import sample_database as sample


@pytest.fixture
def site(made):
    machine = sample.Machine(parameters={"rocker_mass_kg": ("36.5", "35.2"), "own_key": ("1", None)})
    return made("site_a", machine=machine, seconds=200.0, boom=True, restarts=2, refusals={"duplicate": 7, "unsettled": 3},
                warnings=[("jitter", "crank stamps jitter by 0.23 ms"), ("second", "the less important one")])


def test_warnings_come_first_in_their_order(site):
    text = page_of(site).text
    places = [text.index(words) for words in
              ("crank stamps jitter by 0.23 ms", "the less important one", "Who, when, which parameters")]
    assert places == sorted(places)


def test_statistics_are_those_of_all_turns(site):
    rows = page_of(site).table("Over all revolutions")
    peaks = [row[0] / 1000 for row in execute(site, "SELECT amplitude FROM turns")]
    shown = rows["Peak force along the tool [kN]"]
    assert value(shown["Median"]) == pytest.approx(statistics.median(peaks), abs=1e-3 * max(peaks))
    assert value(shown["Greatest"]) == pytest.approx(max(peaks), rel=1e-3)
    assert value(shown["Values"]) == len(peaks)
    # The first blow has no hold-down: it is left out, not zero.
    assert value(rows["Hold-down needed [kN]"]["Values"]) == len(peaks) - 1
    assert value(rows["Hold-down needed [kN]"]["Least"]) > 0.1


def test_a_long_recording_is_thinned_and_keeps_least_and_greatest(made):
    """Eight times the turns, hardly more bytes; far below 3 MB with all channels."""
    pages = [page_of(made(f"of_{seconds:.0f}", seconds=seconds, boom=True)) for seconds in (100.0, 800.0)]
    assert pages[1].size < 1.2 * pages[0].size
    assert pages[1].size < 1.5e6
    file = made("of_800", seconds=800.0, boom=True)
    least, greatest, turns = execute(file, "SELECT min(energy), max(energy), count(*) FROM blows")[0]
    band = [y for piece in pages[1].drawn("Blow energy:").curves("band first") for _, y in piece]
    assert len(band) < turns / 2
    assert (min(band), max(band)) == pytest.approx((least, greatest), abs=1e-3 * greatest)


def test_differing_parameters_are_listed(site):
    assert page_of(site).table("Parameters that differ from the shipped ones") == {
        "rocker_mass_kg": {"In force": "36.5", "Shipped": "35.2"}, "own_key": {"In force": "1", "Shipped": "none"}}


def test_sensor_health_is_shown(site):
    page = page_of(site)
    health = page.table("The crank's sensor")
    assert health["Consistency"]["Status"] == "ok"
    assert health["Restarts"]["Value"] == "2"
    assert (health["Hull pitch"]["Value"], health["Hull pitch"]["Status"]) == ("0.35 rad", "ok")
    assert health["Refused samples"]["Value"].split()[0] == "10"
    assert page.table("Refused samples by reason")["duplicate"]["Samples"] == "7"


def test_loads_of_joints_and_sections_are_shown(site):
    page = page_of(site)
    extremes = execute(site, "SELECT min(t.minimum), avg(mean), max(t.maximum) FROM turn_loads t "
                             "JOIN channels USING(run_id, channel) WHERE name = 'section_loads/boom_foot/torque_y'")[0]
    shown = page.table("Loads over all revolutions")["section boom_foot, torque y"]
    assert [value(shown[name]) for name in ("Least", "Mean of revolutions", "Greatest")] == pytest.approx(
        [extreme / 1000 for extreme in extremes], abs=1e-6 * abs(extremes[2]))
    drawn = [y for picture in page.pictures if picture.title == "joint_loads/boom_joint" for kind in picture.classes("line")
             for piece in picture.curves(kind) for _, y in piece]
    greatest, = execute(site, "SELECT max(t.maximum) / 1000 FROM turn_loads t JOIN channels USING(run_id, channel) "
                              "WHERE name LIKE 'joint_loads/boom_joint/%'")[0]
    assert max(drawn) == pytest.approx(greatest, rel=1e-2)
    for kind, count in execute(site, "SELECT rtrim(name, replace(name, '/', '')), count(*) FROM channels GROUP BY 1"):
        assert sum(len(p.classes("line")) for p in page.pictures if p.title == kind.rstrip("/")) == count, kind


def test_the_page_begins_with_the_typical_turn(site):
    """The curve is that of the table; the worst turn follows, each with half sine and band."""
    page = page_of(site)
    typical, worst = page.pictures[:2]
    assert typical.title.startswith("Typical revolution, number") and worst.title.startswith("Worst revolution, number")
    for picture in (typical, worst):
        assert [len(picture.curves(drawn)) for drawn in ("line first", "line second", "line third", "band first")] == [1] * 4
    forces = [force / 1000 for force, in execute(site, "SELECT force_z FROM traces WHERE kind = 'typical' AND run_id = 1")]
    heights = [y for _, y in typical.curves("line first")[0]]
    assert (min(heights), max(heights)) == pytest.approx((min(forces), max(forces)), abs=2e-3 * max(forces))


def test_the_page_serves_keyboard_and_screen_reader_without_a_network(site):
    page = page_of(site)
    assert len(page.ids) == len(set(page.ids))
    assert {link[1:] for link in page.links if link.startswith("#")} <= set(page.ids)
    assert [given.get("class") for tag, given in page.tags if tag == "a"][0] == "skip"
    levels = [int(tag[1]) for tag, _ in page.tags if tag in ("h1", "h2", "h3", "h4")]
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in zip(levels, levels[1:]))
    for tag, given in page.tags:
        assert given.get("aria-label") or not (tag == "svg" or given.get("class") == "scroll")
        assert given.get("class") != "scroll" or given["tabindex"] == "0"
        assert not any(given.get(name, "#").startswith(("http", "//", "file")) for name in ("src", "href", "srcset")), given


def test_equal_files_give_equal_bytes_in_every_time_zone(made, tmp_path):
    """The page's script writes the reader's local time: the page holds UTC alone, wherever it is made."""
    pages = []
    for zone in ("UTC", "Asia/Bishkek"):
        out = tmp_path / f"{zone[:4]}.html"
        assert report(made(), "--html", out, env=dict(os.environ, TZ=zone)).returncode == 0
        pages.append(out.read_bytes())
    assert pages[0] == pages[1]
    assert "2023-11-14T22:13:20Z" in [given["datetime"] for tag, given in Reader(pages[0].decode()).tags if tag == "time"]


@pytest.fixture
def two(made):
    return [made(name, machine=sample.Machine(name, peak_N=peak)) for name, peak in (("first", 40e3), ("second", 60e3))]


def test_machines_are_shown_side_by_side_and_overlaid(two):
    page = page_of(*two)
    peaks = page.table("Machines side by side")["Peak force along the tool [kN]"]
    assert value(peaks["second"]) / value(peaks["first"]) == pytest.approx(1.5, abs=0.05)
    assert value(peaks["Diff. [%]"]) == pytest.approx(50.0, abs=5.0)
    curves = [p for p in page.pictures if p.title.endswith("over the time of work")]
    assert [p.classes("line") for p in curves] == 5 * [["line first", "line second"]]


def test_figures_affected_by_a_warning_are_marked(two, made):
    third = made("third", warnings=[("jitter", "crank stamps jitter by 0.23 ms")])
    boom = made("boom", boom=True, warnings=[("pressures", "pressures in bar")])
    many = [made(f"m{i}") for i in range(2)]  # one a row, without pictures of each
    header, *rows = page_of(two[0], third, boom, *many).tables["Machines, one a row"][0]
    marked = {row[0]: {name for name, cell in zip(header, row) if cell.endswith("?")} for row in rows}
    assert marked["first"] == set()
    assert "Blow energy [J]" in marked["third"] and "Blows" not in marked["third"]
    assert {name.split(" at ")[0] for name in marked["boom"]} == {"stress"}


def test_files_of_one_name_are_distinguished(two, made, tmp_path):
    (tmp_path / "other").mkdir()
    assert page_of(two[0], made("other/first")).tables["Machines side by side"][0][0][1:] == ["first", "first (2)", "Diff. [%]"]


def test_two_machines_in_one_file_are_never_added(two):
    tables = ("runs", "channels", "cycles", "residues", "turns", "blows")
    execute(two[0], f"ATTACH '{two[1]}' AS other", *(f"UPDATE other.{table} SET run_id = 2" for table in tables),
            *(f"INSERT INTO {table} SELECT * FROM other.{table}" for table in tables))
    note = "first: holds 2 machines (hammer, boom or their parameters differ); each stands alone"
    page = page_of(two[0], note=note)
    assert note in page.text
    assert page.tables["Machines side by side"][0][0][1:] == ["first, machine 1", "first, machine 2", "Diff. [%]"]


def test_missing_parts_are_reported(made):
    page = page_of(made("idle", seconds=0.0), note="idle: no whole revolution")
    assert "no whole revolution" in page.text and "The crank's sensor" in page.tables
    assert "no run at all" in page_of(made("nothing", runs=0), note="nothing: no run at all").text
    text = page_of(made("bare")).text
    for words in ("No sections", "No limits were given", "keeps no budget", "Not known: it needs boom_stiffness: identified"):
        assert words in text


KEPT = {"runs": ("run_id", "run_key", "input_sha256", "parameters_sha256", "machine", "version", "revision", "parameters_yaml"),
        "turns": ("run_id", "turn"), "blows": ("run_id", "turn"), "turn_loads": ("run_id", "turn", "channel"),
        "traces": ("run_id", "kind", "turn", "place", "time"),
        "channels": ("run_id", "channel", "name", "counted", "least", "greatest", "classes")}


def test_null_columns_are_survived(made):
    file = made("null", boom=True)
    for table, kept in KEPT.items():
        names = [row[1] for row in execute(file, f"PRAGMA table_info({table})")]
        execute(file, f"UPDATE {table} SET " + ", ".join(f"{n} = NULL" for n in names if n not in kept))
    assert "Load cycles" in page_of(file, note="null: no whole revolution").text


EVIL = "</script><script>alert(1)</script><b onmouseover=\"x\" title=\"y\">&amp;$\\frac{$\x1b[31m\u202e"


def test_text_of_a_database_and_its_name_stay_text(made):
    file = made("<img src=x onerror=alert(1)>", warnings=[(EVIL, EVIL)], refusals={EVIL: 3})
    for table in ("runs", "parameters", "channels", "traces"):
        for _, name, kind, *_ in execute(file, f"PRAGMA table_info({table})"):
            if kind == "TEXT" and name not in ("run_key", "kind", "key"):
                execute(file, f"UPDATE {table} SET {name} = '{EVIL}'")
    execute(file, f"UPDATE parameters SET shipped = 'other', key = key || '{EVIL}'")
    page, honest = page_of(file), page_of(made())
    for name in ("script", "b", "img"):
        assert sum(tag == name for tag, _ in page.tags) == sum(tag == name for tag, _ in honest.tags)
    assert not [given for _, given in page.tags if "onmouseover" in given or "onerror" in given]
    assert "alert(1)" in page.text


def test_ten_lines_make_a_picture(made, tmp_path):
    """The example of doc/report.md."""
    text = (SOURCE / "doc" / "report.md").read_text(encoding="utf-8")
    code = re.search(r"<!-- example -->\n```python\n(.*?)```", text, re.S).group(1)
    assert code.count("\n") <= 10
    made("work")
    subprocess.run([sys.executable, "-c", code], cwd=str(tmp_path), check=True,
                   env=dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(tmp_path)))
    assert (tmp_path / "work.png").stat().st_size > 5000
