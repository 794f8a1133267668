"""A bag as input: one command from the recording to its page."""
import os

import pytest

from support import HERE, assert_refused, page_of, report_here


@pytest.fixture
def programs(tmp_path, monkeypatch):
    """Folder with a process_bag for bags of text."""
    folder = tmp_path / "programs"
    folder.mkdir()
    (folder / "process_bag").symlink_to(HERE.parent / "fleet" / "fake_process_bag.py")
    monkeypatch.setenv("HAMMER_LOADS_PROGRAMS", str(folder))
    return folder


@pytest.fixture
def bag(tmp_path):
    def write(name, text):
        path = tmp_path / f"{name}.bag"
        path.write_text(text)
        return path
    return write


def test_a_bag_becomes_a_page_and_its_options_reach_process_bag(programs, bag, tmp_path):
    parameters = tmp_path / "hammer.yaml"
    parameters.write_text("a: 1\n")
    options = ["--params", str(parameters), "--crank-topic", "/drive", "--joint-states-topic", "/js", "--imu-topic", "/imu",
               "--pressures-topic", "/p"]
    page = page_of(bag("work", "3 20 1700000000"), options=options)
    assert "Loads of the hammer: work" in page.text
    assert "Over all revolutions" in page.tables
    assert (programs / "options.txt").read_text().split() == options
    assert sorted(os.listdir(tmp_path)) == ["hammer.yaml", "programs", "work.bag"]


def test_splits_of_one_recording_are_one(programs, bag):
    bags = [bag(name, text) for name, text in (("a", "3 20 1700000040 run1"), ("other", "9 20 1700000010 run3"),
                                               ("b", "3 20 1700000020 run1"), ("work", "3 20 1700000000 run1"))]
    assert page_of(*bags).tables["Machines side by side"][0][0][1:] == ["other", "work", "Diff. [%]"]
    assert sorted((programs / "calls.txt").read_text().split()) == ["other.bag", "work.bag+b.bag+a.bag"]


def test_bad_bags_are_refused(programs, bag, tmp_path, capfd):
    out, broken = tmp_path / "out.html", bag("broken", "broken")
    for path, words in ((broken, "is no bag"), (tmp_path / "none.bag", "cannot be read")):
        assert_refused(report_here(path, "--html", out), f"{path}: process_bag ended with code 1, nothing is written")
        assert f"{path}: {words}" in capfd.readouterr().err
    (programs / "process_bag").unlink()
    assert_refused(report_here(broken, "--html", out), "needs the built command process_bag")
    assert not out.exists()


def test_parameters_without_a_bag_are_refused():
    assert_refused(report_here("a.sqlite", "--html", "x", "--params", "y"), "are for bags", code=2)
