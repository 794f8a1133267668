"""ros2/hammer_loads_msgs: as scripts/ros2_messages writes it, and accepted by ROS 2's own parsers."""
import importlib
import os
import pathlib
import runpy
import subprocess
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = SOURCE / "ros2" / "hammer_loads_msgs"
NAMES = sorted(path.stem for path in (SOURCE / "msg").glob("*.msg"))
TYPES_OF_ROS_1 = {"std_msgs/Header": "std_msgs/Header", "builtin_interfaces/Time": "time",
                  "builtin_interfaces/Duration": "duration"}
TRANSLATE = """
import pathlib, sys
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_parser.definition import Message
from rosidl_parser.parser import parse_idl_string
package, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
for path in sorted(package.glob("msg/*.msg")):
    idl = convert_msg_to_idl(package, package.name, path.relative_to(package), output)
    messages = parse_idl_string(idl.read_text(encoding="iso-8859-1")).get_elements_of_type(Message)
    assert [message.structure.namespaced_type.name for message in messages] == [path.stem], path
"""


@pytest.fixture(scope="module")
def script():
    return runpy.run_path(str(SOURCE / "scripts" / "ros2_messages"))


def ros1_class(name):
    sys.path.insert(0, os.environ["HAMMER_LOADS_MODULES"])
    return getattr(importlib.import_module("hammer_loads.msg"), name)


def parsed(name):
    """The message as ROS 2's own parser reads it."""
    adapter = pytest.importorskip("rosidl_adapter.parser", reason="needs the package python3-rosidl")
    return adapter.parse_message_file(PACKAGE.name, str(PACKAGE / "msg" / (name + ".msg")))


def ros1_type(type_):
    name = str(type_).replace(PACKAGE.name, "hammer_loads")
    base, bracket, rest = name.partition("[")
    return TYPES_OF_ROS_1.get(base, base) + bracket + rest


def test_the_committed_files_are_those_that_the_script_writes(script):
    written = {path: (PACKAGE / path).read_text() for path in script["package_files"]()}
    assert script["package_files"]() == written, "run scripts/ros2_messages"
    committed = {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*") if path.is_file()}
    assert committed == set(written)


@pytest.mark.parametrize("name", NAMES)
def test_ros_2_reads_the_fields_and_constants_of_ros_1(name):
    message, ros1 = parsed(name), ros1_class(name)
    assert [field.name for field in message.fields] == ros1.__slots__
    assert [ros1_type(field.type) for field in message.fields] == ros1._slot_types
    assert {constant.name: constant.value for constant in message.constants} == {
        constant: getattr(ros1, constant) for constant in vars(ros1) if constant.isupper()}


def test_ros_2_translates_the_package_to_idl(tmp_path):
    pytest.importorskip("rosidl_adapter.msg", reason="needs the package python3-rosidl")
    # In a program of its own: the templates' engine takes over stdout.
    done = subprocess.run([sys.executable, "-c", TRANSLATE, str(PACKAGE), str(tmp_path)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True)
    assert done.returncode == 0, done.stderr
    assert sorted(path.stem for path in tmp_path.glob("*.idl")) == NAMES


@pytest.mark.parametrize("line", ["byte[] data", "char letter", "float64", "*"])
def test_a_line_without_equal_in_ros_2_is_refused(script, line):
    with pytest.raises(ValueError, match="Some.msg:1: "):
        script["converted_line"](line, "Some.msg:1")
