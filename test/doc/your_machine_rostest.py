#!/usr/bin/env python3
"""doc/your_machine.md as a stranger follows it: its own files and commands, against the machine of loader.py."""
import glob
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import genpy
import numpy as np
import rosbag
import rosgraph
import roslib.packages
import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import loader  # noqa: E402
import page  # noqa: E402

DEADLINE = 300.0  # [s] for what takes some seconds: only what hangs takes longer
SESSION = 90.0  # [s] of the machine's time that there are
UNSEEN = (6.0, 36.0)  # how fast it plays for a node that nobody looks at [-], how long it works at least [s of its time]
SEEN = (1.0, 9.0)
TOPICS = ["/loader2/drive", "/loader2/arm"]
RMS = 0.012  # of the peak; the promise of the page's title


def until(condition, what):
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, what
        rospy.rostime.wallsleep(0.01)


def installed():
    """The package as `cmake --install` leaves it, below a directory of its own; its setup.bash."""
    build = pathlib.Path(roslib.packages.find_node("hammer_loads", "process_bag")[0]).resolve().parents[3]
    root = tempfile.mkdtemp(prefix="hammer_loads_installed_")
    subprocess.run(["cmake", "--install", str(build)], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, DESTDIR=root))
    return root, next(path for path in pathlib.Path(root).rglob("setup.bash"))


class Loader:
    """The machine with its driver: a bag of what it publishes, played with its clock."""

    def __init__(self, bag):
        self.work, self.bag, self.player, self.now = loader.Work(SESSION, seed=3), bag, None, 0.0
        self.write()
        self.clock = rospy.Subscriber("/clock", Clock, self.on_clock)

    def on_clock(self, message):
        self.now = message.clock.to_sec() - loader.START

    def write(self):
        message = JointState()
        with rosbag.Bag(self.bag, "w") as bag:
            for topic, stamp, message.name, message.position in loader.messages(self.work, SESSION, seed=3):
                message.header.stamp = genpy.Time.from_sec(stamp)
                bag.write(topic, message, message.header.stamp)

    def start(self, rate, *options):
        self.now = float("inf")
        self.player = subprocess.Popen(["rosbag", "play", "--quiet", "--clock", "--hz=200", "--queue=10000",
                                        "--rate=%g" % rate, *options, self.bag], stdout=subprocess.DEVNULL)
        until(lambda: self.now < 5.0, "the clock begins anew")

    def stop(self):
        if self.player:
            self.player.send_signal(signal.SIGINT)
            self.player.wait(DEADLINE)
        self.player = None


class Stranger:
    """Does what the page says, in an empty directory."""

    def __init__(self, directory, setup, machine, parts):
        self.directory, self.machine, self.parts = pathlib.Path(directory), machine, parts
        ros = ". /opt/ros/noetic/setup.bash; " if os.path.exists("/opt/ros/noetic/setup.bash") else ""
        self.begin = ("unset ROS_PACKAGE_PATH CMAKE_PREFIX_PATH PYTHONPATH LD_LIBRARY_PATH; %s. %s; set -e\n"
                      % (ros, setup))
        self.launched, self.console, self.said, self.consoles = None, None, "", []

    def follow(self):
        try:
            for at, part in enumerate(self.parts):
                self.do(part, self.parts[at + 1:])
        finally:
            self.machine.stop()
            if self.launched:
                self.launched.kill()

    def do(self, part, later):
        if isinstance(part, page.File):
            (self.directory / part.name).write_text(part.text)
        elif isinstance(part, page.Shows):
            if self.said:
                missing = page.missing(part, self.said)
                assert not missing, "not said: %s\nsaid:\n%s" % (missing, self.said)
            else:
                until(lambda: not page.missing(part, self.console.read_text()), "on the console: %s" % part.lines)
        elif isinstance(part, page.Stop):
            self.end()
        elif part.lines[0].startswith("roslaunch loader2"):
            self.launch(part.lines[0], later)
        else:
            self.run(part.lines)

    def run(self, lines):
        alone = "rostopic" in lines[0] and not self.launched
        if alone:
            self.machine.start(1.0)
        done = subprocess.run(["bash", "-c", self.begin + "\n".join(lines)], cwd=self.directory, timeout=DEADLINE,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        if alone:
            self.machine.stop()
        assert done.returncode == 0, "%s\n%s" % (lines, done.stdout)
        self.said = done.stdout
        print("\n".join(lines) + "\n" + self.said, flush=True)

    def launch(self, line, later):
        looks = any(isinstance(part, page.Commands) for part in later[:later.index(page.Stop())])
        rate, self.least = SEEN if looks else UNSEEN
        if not self.consoles:  # many launch a first time too early, which leaves a bag without work
            self.launch_node(line, self.directory / "console_early.txt")
            self.end_node()
        self.said, self.console = "", self.directory / ("console_%d.txt" % len(self.consoles))
        self.consoles.append(self.console)
        self.launch_node(line, self.console)
        self.machine.start(rate, "--wait-for-subscribers")

    def launch_node(self, line, console):
        with open(console, "w") as output:
            self.launched = subprocess.Popen(["bash", "-c", self.begin + "exec " + line], cwd=self.directory,
                                             stdout=output, stderr=subprocess.STDOUT)
        until(lambda: all(self.subscribed(topic) for topic in TOPICS), "the node must listen")

    @staticmethod
    def subscribed(topic):
        subscribers = dict(rosgraph.Master("/test").getSystemState()[1])
        return "/loader2/hammer_loads" in subscribers.get(topic, [])

    def end(self):
        until(lambda: self.machine.now > self.least, "the machine must work on")
        self.machine.stop()
        self.end_node()

    def end_node(self):
        self.launched.send_signal(signal.SIGINT)
        self.launched.wait(DEADLINE)
        self.launched, self.said = None, ""


def values(bags, topic, *fields):
    """Values of a directory: stamps since the machine's start, and a column for each field."""
    rows = []
    for bag in sorted(bags.iterdir()):
        for _, message, _ in rosbag.Bag(str(bag)).read_messages("/loader2/hammer_loads/" + topic):
            stamp = message.header.stamp
            row = [stamp.secs - int(loader.START) + 1e-9 * stamp.nsecs]
            for field in fields:
                value = message
                for name in field.split("."):
                    value = getattr(value, name)
                row.append(value)
            rows.append(row)
    return np.array(rows).T


class YourMachine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root, setup = installed()
        cls.addClassCleanup(shutil.rmtree, cls.root)
        cls.directory = pathlib.Path(tempfile.mkdtemp(prefix="hammer_loads_page_"))
        cls.addClassCleanup(shutil.rmtree, str(cls.directory))
        cls.machine = Loader(str(cls.directory / "loader2"))
        text = (HERE.parents[1] / "doc" / "your_machine.md").read_text()
        here = cls.directory / "empty"
        here.mkdir()
        cls.stranger = Stranger(here, setup, cls.machine, page.parts_of(text))
        cls.stranger.follow()
        cls.here = here

    def test_each_launch_has_left_a_bag(self):
        self.assertEqual([len(list((self.here / name).iterdir())) for name in ("first", "work")], [2, 1])

    def test_nothing_is_published_of_a_crank_that_turns_backward(self):
        """But the weight while it stands, and half a turn, which tells the two directions apart."""
        told = values(self.here / "first", "hull_wrench", "wrench.force.z")
        angle = self.machine.work.at(told[0])[0]
        self.assertLess((angle - self.machine.work.angle[0]).max(), np.pi + self.machine.work.speed.max() / loader.RATE)

    def test_live_loads_are_the_true_ones(self):
        told = values(self.here / "work", "hull_wrench", "wrench.force.x", "wrench.force.z", "wrench.torque.y")
        told = told[:, told[0] > loader.STANDS + 1.0]
        self.assertGreater(told.shape[1], 0.98 * loader.RATE * (SEEN[1] - loader.STANDS - 1.0))
        for true, seen, name in zip(self.machine.work.wrench(told[0]), told[1:], ("force x", "force z", "moment y")):
            rms = np.sqrt(np.mean((true - seen)**2)) / abs(true).max()
            print("%s: %.2f %% of the peak rms" % (name, 100 * rms))
            self.assertLess(rms, RMS, name)

    def test_deviations_hold(self):
        told = values(self.here / "work", "hull_loads", "force_z", "force_z_std")
        told = told[:, told[0] > loader.STANDS + 1.0]
        within = abs(self.machine.work.wrench(told[0])[1] - told[1]) < 2.0 * told[2]
        print("%.1f %% within two deviations" % (100 * within.mean()))
        self.assertGreater(within.mean(), 0.88)

    def test_blows_are_the_true_ones(self):
        told = values(self.here / "work", "blow", "energy", "energy_std")
        told = told[:, told[0] > loader.STANDS + 1.0]
        true = np.array(self.machine.work.blows).T
        true = true[:, (true[0] > told[0][0] - 0.05) & (true[0] < told[0][-1] + 0.05)]
        self.assertEqual(told.shape[1], true.shape[1])
        self.assertLess(abs(told[0] - true[0]).max(), 1e-3)
        self.assertLess(np.sqrt(np.mean((told[1] / true[1] - 1.0)**2)), 0.05)

    def test_console_has_no_warning_after_the_calibration(self):
        before, after = (console.read_text() for console in self.stranger.consoles)
        # class_loader of Debian 13 has a warning of its own at each end of a bag's writer.
        after = "\n".join(line for line in after.splitlines() if "class_loader.ClassLoader: SEVERE WARNING" not in line)
        self.assertIn("WARN", before)
        self.assertNotIn("WARN", after)
        self.assertNotIn("ERROR", after)

    def test_the_log_gives_the_loads_again(self):
        def raw(bag, topic):
            return [message[1] for _, message, _ in rosbag.Bag(str(bag)).read_messages(topic, raw=True)]
        work, = (self.here / "work").iterdir()
        live, again = raw(work, "/loader2/hammer_loads/hull_wrench"), raw(self.here / "again.bag", "/hammer_loads/hull_wrench")
        self.assertGreater(len(live), 1000)
        self.assertTrue(live == again)

    def test_the_page_of_results_is_there(self):
        self.assertGreater((self.here / "work.html").stat().st_size, 10000)
        self.assertEqual(len(glob.glob(str(self.here / "calibration.*"))), 2)


if __name__ == "__main__":
    rospy.init_node("your_machine_rostest", disable_signals=True)
    rostest.rosrun("hammer_loads", "your_machine", YourMachine, sys.argv)
