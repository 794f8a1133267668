#!/usr/bin/env python3
"""Processor time of the live node for one subscriber of each topic, on the machine of the demo without a log, as a table.

Each topic is subscribed for two seconds between two seconds without a subscriber, several times in one run; the table has
the median of the differences. It needs a build whose setup file has been sourced."""
import argparse
import os
import socket
import statistics
import subprocess
import time
import xmlrpc.client

import rosgraph
import rospy

TOPICS = ["hull_wrench", "hull_loads", "joint_loads", "section_loads", "joint_reactions", "boom_vibration", "pin_forces",
          "blow", "pulse", "turn_loads"]
WINDOW = 2.0  # [s]


def free_port():
    with socket.socket() as one:
        one.bind(("localhost", 0))
        return one.getsockname()[1]


class Node:
    """The hammer's node, whose processor time is read."""

    def __init__(self):
        address = rosgraph.Master("/live_cost").lookupNode("/hammer_loads")
        _, _, self.process = xmlrpc.client.ServerProxy(address).getPid("/live_cost")

    def share(self):
        """Load of one processor over a window [%]."""
        before, begin = self.ticks(), time.monotonic()
        time.sleep(WINDOW)
        return 100.0 * (self.ticks() - before) / os.sysconf("SC_CLK_TCK") / (time.monotonic() - begin)

    def ticks(self):
        with open(f"/proc/{self.process}/stat", encoding="ascii") as stat:
            return sum(int(field) for field in stat.read().rsplit(")", 1)[1].split()[11:13])


class Traffic:
    """Counts the messages of a subscriber and their bytes."""

    def __init__(self):
        self.messages, self.size = 0, 0

    def take(self, message):
        self.messages += 1
        self.size += len(message._buff)


def measure(node, rounds):
    traffic = {topic: Traffic() for topic in TOPICS}
    added, alone = {topic: [] for topic in TOPICS}, []
    for _ in range(rounds):
        before = node.share()
        for topic in TOPICS:
            subscriber = rospy.Subscriber("/hammer_loads/" + topic, rospy.AnyMsg, traffic[topic].take, queue_size=None)
            share = node.share()
            subscriber.unregister()
            after = node.share()
            added[topic].append(share - 0.5 * (before + after))
            alone.append(after)
            before = after
    return added, alone, traffic


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="of all topics, 44 s each (default 5)")
    rounds = parser.parse_args().rounds
    port = free_port()
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    with subprocess.Popen(["roslaunch", "-p", str(port), "hammer_loads", "demo.launch", "log:=false"],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as launch:
        try:
            while not rosgraph.is_master_online():
                time.sleep(0.2)
            rospy.init_node("live_cost", anonymous=True, disable_signals=True)
            rospy.wait_for_message("/hammer_loads/turn_loads", rospy.AnyMsg, timeout=60)
            added, alone, traffic = measure(Node(), rounds)
        finally:
            launch.terminate()
    print("| topic | messages per second | kB per second | processor time of the node |")
    print("|---|---|---|---|")
    print(f"| without a subscriber | | | {statistics.median(alone):.1f} % |")
    for topic in TOPICS:
        seconds = rounds * WINDOW
        print(f"| `~{topic}` | {traffic[topic].messages / seconds:.0f} | {1e-3 * traffic[topic].size / seconds:.0f} | "
              f"{statistics.median(added[topic]):+.1f} % |")


if __name__ == "__main__":
    main()
