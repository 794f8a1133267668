"""doc/tables.md and msg/ against the tables of a recording of a hammer on a boom, with a place whose stress is counted."""
import contextlib
import os
import pathlib
import re
import sqlite3
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOT_SPOT = ("hot_spots: [toe]\ntoe_loads: [hull_z]\ntoe_hull_z_area_m2: 0.01\ntoe_full_scale_least_MPa: -300.0\n"
            "toe_full_scale_greatest_MPa: 300.0\n")

pytestmark = pytest.mark.skipif("HAMMER_LOADS_PROGRAMS" not in os.environ, reason="HAMMER_LOADS_PROGRAMS is not set")


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    """Rows of a query to the database."""
    folder = tmp_path_factory.mktemp("tables")
    (folder / "life.yaml").write_text(HOT_SPOT)
    process_bag = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"]) / "process_bag"
    subprocess.run([process_bag, "--no-bag", ROOT / "test" / "data" / "mo100_100hz.bag", "--db", folder / "out.sqlite",
                    "--urdf", ROOT / "urdf" / "eo2621_mo100.urdf", "--params", ROOT / "config" / "boom_eo2621.yaml",
                    "--params", folder / "life.yaml"], check=True, stderr=subprocess.DEVNULL)
    with contextlib.closing(sqlite3.connect(folder / "out.sqlite")) as database:
        yield lambda sql: database.execute(sql).fetchall()


def units_of(message):
    """{field: unit} of the numbers of a message."""
    text = (ROOT / "msg" / (message + ".msg")).read_text()
    return dict(re.findall(r"^\S*float64\S* (\w+)[ ]*(?:# \[([^\]]+)\] .+)?$", text, re.M))


def test_every_column_has_unit_and_description(rows):
    assert rows("SELECT table_name, column_name FROM columns ORDER BY 1, 2") == rows(
        "SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c WHERE m.type = 'table' ORDER BY 1, 2")
    assert rows("SELECT table_name, column_name FROM columns WHERE length(description) < 5") == []


def test_the_page_states_unit_and_description_as_the_database(rows):
    """Tables `turns` and `blows` have every field of their message as well, which the page does not repeat, and all tables but
    `runs` and `columns` have run_id."""
    page = {}
    for table, text in re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", (ROOT / "doc" / "tables.md").read_text(), re.M | re.S):
        page.update({(table, column): texts for column, *texts in re.findall(r"^\| (\w+) \| (.+) \| (.+) \|$", text, re.M)
                     if column != "column"})
    stated = {(table, name): [unit, text] for table, name, unit, text in rows("SELECT * FROM columns")}
    of_message = {key for key in stated if key[0] in ("turns", "blows") and key[1] not in ("turn", "stamp_ns")}
    assert page == {key: text for key, text in stated.items()
                    if key not in of_message and (key[1] != "run_id" or key[0] == "runs")}


def test_messages_state_the_unit_of_every_number():
    units = [(path.stem, *field) for path in (ROOT / "msg").glob("*.msg") for field in units_of(path.stem).items()]
    assert len(units) > 100
    assert [unit for unit in units if not unit[2]] == []


def test_units_of_channels_figures_and_columns_are_those_of_the_messages(rows):
    found = dict(rows("SELECT name, unit FROM channels UNION SELECT quantity, unit FROM budget"))
    for channel, message, field in (
            ("hull_wrench/force_x", "HullLoads", "force_x"), ("hull_wrench/force_z", "HullLoads", "force_z"),
            ("hull_wrench/torque_y", "HullLoads", "torque_y"), ("joint_loads/arm_joint/total_torque", "JointLoad", "total_torque"),
            ("joint_loads/arm_cylinder/force", "CylinderLoad", "force"), ("pulse/amplitude", "Pulse", "amplitude"),
            ("pulse/turn_impulse_z", "Pulse", "turn_impulse_z"), ("blow/energy", "Blow", "energy")):
        assert found[channel] == units_of(message)[field], channel
    assert (found["section_loads/boom_foot/force_x"], found["stress/toe"]) == ("N", "MPa")
    columns = dict(rows("SELECT column_name, unit FROM columns WHERE table_name = 'blows'"))
    assert {field: columns[field] for field in units_of("Blow") if field in columns} == units_of("Blow")
