"""Packages of others, built from the install space."""
import os
import pathlib
import re
import shutil

import pytest

from support import BUILD, HERE, PREFIX, SOURCE, configure, needs_own_prefix, said

pytestmark = needs_own_prefix  # what a user installed is not touched
LAUNCH = "roslaunch --dump-params hammer_loads "


@pytest.fixture(scope="module", autouse=True)
def installed(tmp_path_factory):
    """Below the package roslaunch would find each launch file twice: it is removed again."""
    os.environ["ROS_LOG_DIR"] = str(tmp_path_factory.mktemp("log"))
    shutil.rmtree(PREFIX, ignore_errors=True)
    said(f"cmake --install {BUILD}")
    yield
    shutil.rmtree(PREFIX)


def in_install_space(command):
    """Output of a command in an environment that knows the install space alone."""
    ros = "[ ! -e /opt/ros/noetic/setup.bash ] || . /opt/ros/noetic/setup.bash; "
    return said(f"{ros}. {PREFIX}/setup.bash; {command}")


@pytest.fixture(scope="module")
def package(installed, tmp_path_factory):
    """Build folder of use_package."""
    build = tmp_path_factory.mktemp("use_package")
    in_install_space(configure(HERE / "use_package", build, "-DCMAKE_UNITY_BUILD=ON") + f" && cmake --build {build}")
    return build


@pytest.fixture(scope="module")
def programs(package):
    return package / "devel" / "lib" / "use_package"


def public_headers():
    """Rows of the C++ table of doc/api.md: | `LIBRARY` | `HEADER` | for what."""
    return re.findall(r"^\| `hammer_loads_\w+` \| `(hammer_loads/[\w/]+\.h)` \|", (SOURCE / "doc" / "api.md").read_text(), re.M)


def test_links_the_libraries_without_ros_by_their_own_names(programs):
    """No setup.bash: they are found."""
    assert said(f"{programs}/turn") == said(f"{PREFIX}/lib/hammer_loads/turn_table --summary --level rocker")
    libraries = said(f"ldd {programs}/use_hull_model")
    assert f"{PREFIX}/lib/libhammer_loads_core.so" in libraries
    for other in ("libros", "libboost", "librosbag", "hammer_loads_ros", "libkdl"):
        assert other not in libraries


def test_links_and_includes_the_public_interface(programs):
    headers = public_headers()
    assert len(headers) > 10
    for header in headers:
        said(f"{programs}/use_{pathlib.Path(header).stem}")


def test_runs_commands_in_python(tmp_path):
    assert in_install_space("rosrun hammer_loads report --version").startswith("hammer_loads ")
    assert "0 bags" in in_install_space(f"$(rospack find hammer_loads)/fleet/merge.py {tmp_path}/m.sqlite < /dev/null")


def test_uses_messages_and_the_libraries_with_ros(programs):
    assert said(f"{programs}/use_messages") == "hammer_loads/HullLoads\nhammer_loads/RunInfo\n"
    assert in_install_space('python3 -c "import hammer_loads.msg as m; print(m.HullLoads._type)"') == "hammer_loads/HullLoads\n"


def test_tests_with_the_installed_node(package):
    in_install_space(f"cd {package} && ctest --output-on-failure")


def test_installed_launch_files_find_their_nodelets():
    assert f"{PREFIX}/share/hammer_loads/nodelet_plugins.xml" in in_install_space("rospack plugins --attrib=plugin nodelet")
    assert (PREFIX / "lib" / "libhammer_loads_nodelets.so").exists()


def test_launch_files_state_what_is_required():
    for name in ("hammer_loads_nodelet", "demo", "grapple"):
        arguments = in_install_space(f"roslaunch hammer_loads {name}.launch --ros-args")
        assert "Optional Arguments" in arguments and "Required Arguments" not in arguments
    replay = in_install_space("roslaunch hammer_loads replay.launch --ros-args")
    required, optional = replay.split("\nOptional Arguments:")
    assert required.startswith("Required Arguments:\n  bag: ")
    for argument in ("urdf_file", "boom_file", "boom_model", "boom_wrench_links", "hull_imu", "tf", "crank_joint"):
        assert f"\n  {argument} (default" in optional


def assert_parameters(dumped, *lines):
    for line in lines:
        assert f"/hammer_loads/{line}" in dumped, dumped


def test_launch_arguments_become_parameters():
    assert_parameters(
        in_install_space(LAUNCH + 'hammer_loads.launch crank_joint:=drive_joint boom_model:=rigid '
                         'boom_wrench_links:="[arm_link, base_link]" log_directory:=/somewhere'),
        "crank_joint: drive_joint", "boom: rigid", "boom_wrench_links:\n- arm_link\n- base_link", "log_directory: /somewhere")
    shipped = in_install_space(LAUNCH + "hammer_loads.launch")
    assert_parameters(shipped, "crank_joint: hammer_crank_joint", "boom: auto", "boom_wrench_links: []")
    assert "crank_length_m" not in shipped  # the node states that it uses the MO-100
    assert "hull_imu:=/imu" in in_install_space("roslaunch --args /hammer_loads hammer_loads hammer_loads.launch hull_imu:=/imu")


@pytest.mark.parametrize("launch", ["hammer_loads_nodelet", "replay", "demo"])
def test_a_calibration_is_merged_with_the_hammer(tmp_path, launch):
    """Each includes hammer_loads.launch."""
    calibration, hammer = tmp_path / "calibration.yaml", PREFIX / "share" / "hammer_loads" / "config" / "hammer_mo100.yaml"
    calibration.write_text("crank_zero_rad: 0.125\ndrive_inertia_kg_m2: 0.375\n")
    bag = " bag:=some.bag" if launch == "replay" else ""
    assert_parameters(in_install_space(f"{LAUNCH}{launch}.launch calibration_file:={calibration} hammer_file:={hammer}{bag}"),
                      "crank_zero_rad: 0.125", "drive_inertia_kg_m2: 0.375", "crank_length_m: 0.048")


def test_rviz_shows_the_machine_of_its_namespace():
    share = PREFIX / "share" / "hammer_loads"
    assert "-f '$(arg fixed_frame)'" in (share / "launch" / "hammer_loads.launch").read_text()
    picture = (share / "rviz" / "hammer_loads.rviz").read_text()
    assert "Topic: hammer_loads/hull_wrench" in picture and "Topic: /" not in picture


def with_includes(headers):
    found = set()
    while headers:
        found.update(headers)
        texts = [(SOURCE / "src" / header).read_text() for header in headers if (SOURCE / "src" / header).exists()]
        headers = {name for text in texts for name in re.findall(r'^#include "(hammer_loads/[^"]+)"', text, re.M)} - found
    return {header for header in found if (SOURCE / "src" / header).exists()}


def test_installs_the_public_headers_and_what_they_include_alone():
    """Generated headers, of messages and of dynamic_reconfigure, have no directory below hammer_loads."""
    paths = [path.relative_to(PREFIX / "include") for path in (PREFIX / "include").rglob("*") if path.is_file()]
    assert {str(path) for path in paths if path.parent.name != "hammer_loads"} == with_includes(set(public_headers()))
