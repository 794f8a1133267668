"""examples/ros2_bag.py: every value of a log, read back as a ROS 2 program with hammer_loads_msgs reads it."""
import dataclasses
import math
import os
import pathlib
import subprocess
import sys

import pytest

rosbags_typesys = pytest.importorskip("rosbags.typesys", reason="needs rosbags (pip install rosbags)")
import rosbag  # noqa: E402
from rosbags.rosbag2 import Reader  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SESSION = SOURCE / "test" / "data" / "mo100_100hz.bag"


def ros1_values(value):
    """Numbers and texts in their order; ROS 2 has no header.seq."""
    if getattr(value, "_type", None) == "std_msgs/Header":
        return [value.stamp.secs, value.stamp.nsecs, value.frame_id]
    if hasattr(value, "__slots__"):
        return [number for slot in value.__slots__ for number in ros1_values(getattr(value, slot))]
    if isinstance(value, (list, tuple, bytes)):
        return [number for element in value for number in ros1_values(element)]
    return [value]


def ros2_values(value):
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if not field.name.isupper()]  # no constants
        return [number for name in names if name != "__msgtype__" for number in ros2_values(getattr(value, name))]
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, list):
        return [number for element in value for number in ros2_values(element)]
    return [value]


def comparable(values):
    return ["not a number" if isinstance(value, float) and math.isnan(value) else value for value in values]


def store_of_the_package():
    """ROS 2's types with those of ros2/hammer_loads_msgs, not those that the bag brings."""
    store = rosbags_typesys.get_typestore(rosbags_typesys.Stores.ROS2_HUMBLE)
    types = {}
    for path in (SOURCE / "ros2" / "hammer_loads_msgs" / "msg").glob("*.msg"):
        types.update(rosbags_typesys.get_types_from_msg(path.read_text(), "hammer_loads_msgs/msg/" + path.stem))
    store.register(types)
    return store


def by_topic(messages):
    topics = {}
    for topic, time, values in messages:
        topics.setdefault(topic, []).append((time, comparable(values)))
    return topics


def test_every_value_arrives(tmp_path):
    log, converted = tmp_path / "log.bag", tmp_path / "ros2"
    programs = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"])
    subprocess.run([str(programs / "process_bag"), str(SESSION), str(log)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([sys.executable, str(SOURCE / "examples" / "ros2_bag.py"), str(log), str(converted)], check=True)
    with rosbag.Bag(str(log)) as bag:
        expected = by_topic((topic, time.to_nsec(), ros1_values(message)) for topic, message, time in bag.read_messages())
    store = store_of_the_package()
    with Reader(converted) as reader:
        for connection in reader.connections:
            assert connection.digest == store.hash_rihs01(connection.msgtype), connection.msgtype
        found = by_topic((connection.topic, time, ros2_values(store.deserialize_cdr(message, connection.msgtype)))
                         for connection, time, message in reader.messages())
    assert sum(len(messages) for messages in found.values()) > 1000
    assert sorted(found) == sorted(expected)
    for topic, messages in found.items():
        assert messages == expected[topic], topic
