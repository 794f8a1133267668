"""A loader crane whose cylinders act through bucket linkages, measured by others: examples/loader_crane/convert."""
import re

import numpy as np
import pytest
import yaml

import support


def stroke_table(name):
    return np.loadtxt(support.crane_bags() / f"{name}.csv", delimiter=",", skiprows=1).T


def lever(linkage, name, angle):
    """dL/dq by differences; both joints turn about -y."""
    def length(q):
        key = lambda k: linkage[f"{name}_{k}"]
        turn = np.exp(1j * q)  # x + iz, from x to z
        pivot = key("rocker_link_base_x_m") + 1j * key("rocker_link_base_z_m") - ORIGIN[name]
        base = key("base_x_m") + 1j * key("base_z_m") - ORIGIN[name]
        across = (key("rod_x_m") + 1j * key("rod_z_m")) * turn - pivot
        guide, coupler, d = key("rocker_link_length_m"), key("coupler_length_m"), abs(across)
        at_pivot = np.arccos((guide**2 + d**2 - coupler**2) / (2 * guide * d))
        return abs(pivot + guide * across / d * np.exp(-1j * key("linkage_branch") * at_pivot) - base)
    return (length(angle + 1e-6) - length(angle - 1e-6)) / 2e-6


ORIGIN = {"main_cylinder": 1.5j, "jib_cylinder": 2.4 + 0.06997j}


@pytest.mark.parametrize("name,limit", [("main", 0.003), ("jib", 0.013)])
def test_linkage_is_fitted_to_the_stroke_map(tmp_path, name, limit):
    boom = yaml.safe_load((support.CRANE / "boom.yaml").read_text())
    known = tmp_path / "known.yaml"
    known.write_text(f"root_link: base_link\ntip_link: jib_link\n{name}_cylinder_joint: {name}_joint\n" +
                     (f"main_cylinder_coupler_length_m: 0.49\n" if name == "main" else ""))
    done = support.run("calibrate", "--linkage", support.crane_bags() / f"{name}.csv", "--cylinder", f"{name}_cylinder",
                       "--params", known, "--urdf", support.CRANE / "crane.urdf", "--tape-std", "0.002", "--write",
                       tmp_path / "linkage.yaml")
    assert done.returncode == 0, done.stdout + done.stderr
    stroke, angle = stroke_table(name)
    slope = np.gradient(stroke, angle, edge_order=2)
    for linkage in (yaml.safe_load((tmp_path / "linkage.yaml").read_text()), boom):
        off = lever(linkage, f"{name}_cylinder", angle) - slope
        print(name, np.sqrt(np.mean(off**2) / np.mean(slope**2)))
        assert np.sqrt(np.mean(off**2) / np.mean(slope**2)) < limit


def test_one_day_weighs_the_boom(tmp_path):
    done = support.weigh(support.DAY, tmp_path / "found.yaml")
    print(done.stdout, done.stderr)
    assert done.returncode == 0
    figures = {name: (float(left), float(held)) for name, left, held in
               re.findall(r"^(\w+_cylinder) .* left ([\d.]+) %, last quarter by the others ([\d.]+) %", done.stdout, re.M)}
    assert figures["main_cylinder"][0] <= 1.5
    assert figures["jib_cylinder"][0] <= 3.0
    assert max(held for _, held in figures.values()) <= 3.5


def test_a_faulty_sensor_among_good_recordings_is_named(tmp_path):
    """The jib's stroke swings by 2 mm at 15 Hz while the jib rests and its pressures stay."""
    done = support.weigh(support.DAY[:4] + [support.FAULTY], tmp_path / "found.yaml")
    print(done.stderr)
    assert done.returncode == 1
    assert re.search(f"jib_joint: .*{support.FAULTY}.* its sensor has .* faulty there", done.stderr)
    assert not (tmp_path / "found.yaml").exists()


@pytest.mark.parametrize("names", [support.DAY[1:], support.DAY[2:]])
def test_good_recordings_are_not_called_faulty(tmp_path, names):
    done = support.weigh(names, tmp_path / "found.yaml")
    print(done.stderr)
    assert "leave that recording out" not in done.stderr


def test_pressures_in_bar_are_named(tmp_path):
    import rosbag
    bag = tmp_path / "bar.bag"
    with rosbag.Bag(str(bag), "w") as out, rosbag.Bag(str(support.crane_bags() / f"{support.DAY[0]}.bag")) as given:
        for topic, message, stamp in given:
            if hasattr(message, "fluid_pressure"):
                message.fluid_pressure /= 1e5
            out.write(topic, message, stamp)
    done = support.run("calibrate", "--boom", bag, "--params", support.CRANE / "boom.yaml", "--urdf",
                       support.CRANE / "crane.urdf", "--write", tmp_path / "found.yaml")
    assert done.returncode == 1
    assert "in bar" in done.stderr
