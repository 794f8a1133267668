"""Lists of bags."""
import pathlib

import pytest

from fleet_support import SOURCE  # noqa: F401  (sets the path)
import bag_list


@pytest.fixture
def listed(tmp_path):
    """Bags of a list with this name and text."""
    def read(name, text):
        path = tmp_path / name
        path.write_text(text)
        return bag_list.read(str(path))
    return read


def test_csv_and_yaml_agree(listed, tmp_path):
    as_csv = listed("a.csv", "machine,bag,parameters\nred,x.bag,h.yaml;b.yaml\nblue,/abs/y.bag,\n")
    assert as_csv == listed("a.yaml", "- {machine: red, bag: x.bag, parameters: [h.yaml, b.yaml]}\n"
                                      "- {machine: blue, bag: /abs/y.bag}\n")
    assert [bag.bag for bag in as_csv] == [str(tmp_path / "x.bag"), "/abs/y.bag"]
    assert as_csv[0].parameters == (str(tmp_path / "h.yaml"), str(tmp_path / "b.yaml"))


def test_a_folder_is_a_list_of_bags(tmp_path):
    for machine, files in (("red", ("1.bag", "2.bag.active", "h.yaml", "notes.txt")), ("blue", ("1.bag",))):
        (tmp_path / machine).mkdir()
        for name in files:
            (tmp_path / machine / name).write_text("")
    bags = bag_list.read(str(tmp_path))
    assert [(b.machine, pathlib.Path(b.bag).name, len(b.parameters)) for b in bags] == [
        ("blue", "1.bag", 0), ("red", "1.bag", 1), ("red", "2.bag.active", 1)]
    assert len({bag.name for bag in bags}) == 3


def test_splits_of_one_recording_are_one_bag(listed):
    bags = listed("a.csv", "machine,bag,parameters\nred,w_0.bag,\nred,w_1.bag,\nblue,w_1.bag,\nred,other.bag,\n")
    asked = []

    def recordings(paths):
        asked.append([pathlib.Path(path).name for path in paths])
        return [sorted(paths)]
    joined = bag_list.joined(bags, recordings)
    assert [(b.machine, pathlib.Path(b.bag).name, len(b.later)) for b in joined] == [
        ("red", "w_0.bag", 1), ("blue", "w_1.bag", 0), ("red", "other.bag", 0)]
    assert asked == [["w_0.bag", "w_1.bag"]]  # what cannot be a split is not opened
    assert joined[0].name == bags[0].name


@pytest.mark.parametrize("name, text, words", [
    ("a.csv", "bag\nx.bag\n", "machine,bag,parameters"), ("c.csv", "machine,bag\n", "names no bag"),
    ("d.csv", "machine,bag\nred,x.bag\nred,x.bag\n", "twice"), ("e.yaml", "machine: red\n", "must be a list"),
    ("f.yaml", "- {machine: red, bag: \0x}\n", "not valid YAML"), ("g.yaml", "- [", "not valid YAML")])
def test_bad_ones_are_one_line(listed, name, text, words):
    with pytest.raises(bag_list.Problem, match=f"{name}: .*{words}"):
        listed(name, text)


def test_a_bad_entry_is_a_row_with_its_reason(listed, tmp_path):
    bags = listed("a.yaml", "- {machine: red, bag: x.bag}\n- 5\n- {machine: red}\n- {machine: 7, bag: 7.5}\n"
                            "- {machine: [red], bag: x.bag}\n- {machine: red, bag: y.bag, parameters: [1]}\n"
                            '- {machine: red, bag: "z\\0.bag"}\n- {machine: 7, bag: x.bag}\n')
    assert [bag.problem and bag.problem.split(":")[0] for bag in bags[:6]] == [None] + [f"entry {i}" for i in range(2, 7)]
    assert "control characters" in bags[6].problem
    assert (bags[7].machine, bags[7].problem) == ("7", None)
    assert "entry 1: machine and bag" in listed("b.csv", "machine,bag\nred,\n")[0].problem
    path = tmp_path / "c.csv"
    path.write_bytes(b"machine,bag,parameters\nred,x.bag,a\0b.yaml\nr\xff,x.bag,\nred,y\xff.bag,\nred,x.bag,\n")
    bags = bag_list.read(str(path))
    assert [bool(bag.problem) for bag in bags] == [True, True, True, False]
    for bag in bags:
        for text in (bag.machine, bag.bag, *bag.parameters, bag.problem or ""):
            assert text == bag_list.shown(text.encode("utf-8").decode("utf-8"))


def test_names_of_pages_differ():
    names = ["a b", "a_b", "all", "../x", "a/b", ".."]
    assert len({bag_list.page_name(name) for name in names} | {"all"}) == len(names) + 1
    assert not [n for n in names if "/" in bag_list.page_name(n)]
