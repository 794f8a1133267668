#!/usr/bin/env python3
"""Converts a bag of ROS 1 to a rosbag2 of MCAP whose messages have the types of ROS 2; this package's as hammer_loads_msgs.

Needs no ROS but the Python library rosbags (pip install rosbags). Definitions that ROS 2 lacks are taken from the bag.
Usage: ros2_bag.py IN.bag OUT_DIRECTORY [DISTRIBUTION]    default: humble
"""
import sys

from rosbags.convert.converter import LATCH
from rosbags.rosbag1 import Reader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


def ros2_name(ros1_name):
    return ros1_name.replace("hammer_loads/", "hammer_loads_msgs/")


def register(store, connection):
    """Type of the connection's messages in ROS 2, known to the store from now on."""
    name = ros2_name(connection.msgtype)
    types = get_types_from_msg(ros2_name(connection.msgdef.data), name)
    store.register({key: fields for key, fields in types.items() if key not in store.fielddefs})
    return name


def convert(source, target, distribution="humble"):
    store = get_typestore(Stores("ros2_" + distribution))
    with Reader(source) as reader, Writer(target, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        out = {}  # one for each type and topic: several publishers of a topic share it
        for connection in reader.connections:
            key = connection.topic, register(store, connection)
            if key not in out:
                out[key] = writer.add_connection(*key, typestore=store,
                                                 offered_qos_profiles=LATCH if connection.ext.latching else [])
        for connection, time, message in reader.messages():
            name = ros2_name(connection.msgtype)
            writer.write(out[connection.topic, name], time, store.ros1_to_cdr(message, name))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or "--help" in sys.argv:
        sys.exit(__doc__)
    convert(*sys.argv[1:])
