#!/usr/bin/env python3
"""The node as a process: its exit codes, its errors, its log after an ordinary end."""
import ctypes
import glob
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rosgraph
import roslaunch.config
import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

DEADLINE = 120.0  # [s] for what takes a second at most: only a node that hangs takes longer, however busy the computer is
KNOWN_ZERO = 0.003  # [rad]: no sample is withheld for the zero
DATA = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'data')


def eventually(condition):
    deadline = time.monotonic() + DEADLINE
    while not condition():
        if time.monotonic() > deadline:
            return False
        rospy.rostime.wallsleep(0.01)
    return True


def command(name):
    """A program of this package, built or installed."""
    return roslib.packages.find_node('hammer_loads', name)[0]


def end_with_parent():
    """In a new process: it is killed with the one that began it, however that ends."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class NodeProcess:
    """A node of this package under a name of its own. It does not outlive the test, whatever becomes of that."""

    def __init__(self, name, parameters, program='hammer_loads_node'):
        self.name = name
        for key, value in parameters.items():
            rospy.set_param('/%s/%s' % (name, key), value)
        self.process = subprocess.Popen(
            [command(program), '__name:=' + name, 'crank:=/%s/crank' % name,
             'joint_states:=/%s/joints' % name],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, preexec_fn=end_with_parent)

    def end(self, sign=signal.SIGINT):
        self.process.send_signal(sign)
        out, err = self.process.communicate(timeout=DEADLINE)
        return self.process.returncode, out, err

    def wait(self):
        out, err = self.process.communicate(timeout=DEADLINE)
        return self.process.returncode, out, err


class ProcessTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()

    def tearDown(self):
        shutil.rmtree(self.directory, ignore_errors=True)

    def published_topics(self, name):
        published = rosgraph.Master('/test').getSystemState()[0]
        return [topic for topic, _ in published if topic.startswith('/%s/' % name)]

    def expect_refused(self, name, parameters, *words):
        parameters.setdefault('log_enabled', False)
        code, _, err = NodeProcess(name, parameters).wait()
        self.assertEqual(code, 1, err)
        for word in words:
            self.assertIn(word, err)
        self.assertEqual(self.published_topics(name), [])
        return err

    def test_wrong_parameters_are_reported_together_and_end_the_node(self):
        err = self.expect_refused('bad_values', {'stale_after_s': -1.0, 'level': 'finest', 'no_such_key': 1},
                                  'stale_after_s', 'level', 'no_such_key')
        self.assertEqual(len(err.strip().splitlines()), 3, err)

    def test_an_impossible_log_directory_is_refused(self):
        self.expect_refused('bad_log', {'log_enabled': True, 'log_directory': '/proc/no/such'}, 'log_directory')

    def test_the_machine_of_the_demo_publishes_where_the_node_listens_in_any_namespace(self):
        launch = os.path.join(self.directory, 'in_a_namespace.launch')
        with open(launch, 'w') as file:
            file.write('<launch><group ns="loader2"><include file="$(find hammer_loads)/launch/demo.launch"/></group></launch>')
        nodes = {node.name: dict(node.remap_args) for node in roslaunch.config.load_config_default([launch], None).nodes}
        for topic in ('crank', 'joint_states', 'hull_imu', 'cylinder_pressures'):
            published = nodes['simulate_hammer'].get(topic, '')
            self.assertTrue(published.startswith('/'), topic)
            self.assertEqual(nodes['hammer_loads'].get(topic), published)

    def reported_after_the_crank(self, name):
        """A node that has heard the crank stand and has reported since; who publishes its joints; its reports since."""
        reports = []

        def take(message):
            reports.extend(s.message for s in message.status if s.name == name + ': inputs')
        node = NodeProcess(name, {'log_enabled': False, 'diagnostic_period': 2.0})
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, take)
        crank = rospy.Publisher('/%s/crank' % name, JointState, queue_size=10)
        joints = rospy.Publisher('/%s/joints' % name, JointState, queue_size=10)
        self.assertTrue(eventually(lambda: crank.get_num_connections() and joints.get_num_connections() and
                                   subscriber.get_num_connections()))
        for i in range(2):
            stamp = rospy.Time(1.0 + 1e-3 * i)
            crank.publish(JointState(header=Header(stamp=stamp), name=['hammer_crank_joint'], position=[3.0]))
        self.assertTrue(eventually(lambda: any('no angle of' in report for report in reports)))
        del reports[:]
        return node, joints, reports

    def test_joints_that_never_come_are_on_the_console(self):
        node, _, reports = self.reported_after_the_crank('no_joints')
        self.assertTrue(eventually(lambda: len(reports) > 1))
        self.assertIn('no angle of', node.end()[2])

    def test_joints_that_begin_later_than_the_crank_are_not(self):
        node, joints, reports = self.reported_after_the_crank('late_joints')
        names = ['boom_joint', 'arm_joint', 'hammer_joint']
        joints.publish(JointState(header=Header(stamp=rospy.Time(1.0)), name=names, position=[0.0, 0.0, 0.0]))
        self.assertTrue(eventually(lambda: len(reports) > 1))
        self.assertNotIn('no angle of', node.end()[2])

    def publish_session(self, name, seconds):
        """Replays the start of the 1 kHz session and waits for the last wrench. Returns the numbers of samples and of
        wrenches: samples beside a blow have none."""
        wrenches = []
        subscriber = rospy.Subscriber('/%s/hull_wrench' % name, WrenchStamped, lambda m: wrenches.append(m),
                                      queue_size=None, tcp_nodelay=True)
        crank = rospy.Publisher('/%s/crank' % name, JointState, queue_size=100000)
        joints = rospy.Publisher('/%s/joints' % name, JointState, queue_size=10000)
        self.assertTrue(eventually(lambda: crank.get_num_connections() > 0 and joints.get_num_connections() > 0 and
                                   subscriber.get_num_connections() > 0))
        sent = 0
        with rosbag.Bag(os.path.join(DATA, 'mo100_1khz.bag')) as bag:
            first = None
            for topic, message, stamp in bag.read_messages():
                first = first or stamp
                if (stamp - first).to_sec() > seconds:
                    break
                if topic == '/hammer/crank':
                    crank.publish(message)
                    sent, last = sent + 1, message.header.stamp
                else:
                    joints.publish(message)
        self.assertTrue(eventually(lambda: wrenches and wrenches[-1].header.stamp == last))
        self.assertGreater(len(wrenches), 0.99 * sent)
        return sent, len(wrenches)

    def messages_in(self, path):
        """Numbers of messages of a bag by topic."""
        with rosbag.Bag(path) as bag:
            return {topic: info.message_count for topic, info in bag.get_type_and_topic_info().topics.items()}

    def test_the_log_is_whole_after_sigint_sigterm_and_a_closed_terminal(self):
        for name, sign in (('log_int', signal.SIGINT), ('log_term', signal.SIGTERM), ('log_hup', signal.SIGHUP)):
            node = NodeProcess(name, {'log_enabled': True, 'log_directory': self.directory, 'log_min_free_mb': 0,
                                      'crank_zero_std_rad': KNOWN_ZERO})
            sent, received = self.publish_session(name, 4.0)
            code, _, err = node.end(sign)
            self.assertEqual(code, 0, err)
            path, = glob.glob(self.directory + '/*')
            self.assertTrue(path.endswith('.bag'), path)
            subprocess.run(['rosbag', 'check', path], check=True, stdout=subprocess.DEVNULL)
            info = subprocess.run(['rosbag', 'info', path], check=True, stdout=subprocess.PIPE,
                                  universal_newlines=True).stdout
            self.assertIn('compression:  lz4', info)
            topics = self.messages_in(path)
            self.assertEqual(topics['/%s/crank' % name], sent)
            self.assertEqual(topics['/%s/hull_wrench' % name], received)
            self.assertEqual(topics['/%s/run_info' % name], 1)
            self.assertGreater(topics['/%s/joints' % name], 100)
            os.remove(path)

    def test_messages_that_a_full_queue_drops_are_counted(self):
        """The node stands while they come, and reads them faster than it works when it goes on."""
        name, sent, counts, dropped = 'overloaded', 40000, {}, []

        def take(message):
            for status in message.status:
                values = {value.key: value.value for value in status.values}
                counts.update(values if status.name == name + ': crank' else {})
                dropped.extend(int(value) for key, value in values.items() if key == 'never came: /%s/crank' % name)
        node = NodeProcess(name, {'log_enabled': False, 'diagnostic_period': 0.1})
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, take)
        crank = rospy.Publisher('/%s/crank' % name, JointState, queue_size=sent)
        self.assertTrue(eventually(lambda: crank.get_num_connections() and counts))
        # The node's threads share one core; the one that works yields to the one that reads.
        core = {min(os.sched_getaffinity(0))}
        for thread in os.listdir('/proc/%d/task' % node.process.pid):
            os.sched_setaffinity(int(thread), core)
        os.setpriority(os.PRIO_PROCESS, node.process.pid, 19)

        def send(number):
            stamp = rospy.Time.from_sec(1000.0 + 1e-3 * number)
            crank.publish(JointState(header=Header(stamp=stamp), name=['hammer_crank_joint'], position=[3.0]))

        def heard():
            return int(counts['accepted']) + sum(int(value) for key, value in counts.items() if key.startswith('refused'))
        send(0)
        self.assertTrue(eventually(lambda: heard() == 1))
        total = 1
        while not dropped and total < 5 * sent:  # a busy computer delivers so slowly that the node keeps up
            node.process.send_signal(signal.SIGSTOP)
            for i in range(total, total + sent):
                send(i)
            total += sent
            node.process.send_signal(signal.SIGCONT)
            self.assertTrue(eventually(lambda: heard() + (dropped[-1] if dropped else 0) == total), (dropped[-1:], heard()))
        self.assertTrue(dropped)
        self.assertIn('messages never came', node.end()[2])
        subscriber.unregister()

    def test_a_log_that_a_full_disk_stopped_goes_on_when_there_is_room(self):
        name, states = 'full_disk', []
        if subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=64m', 'none', self.directory], stderr=subprocess.DEVNULL).returncode:
            self.skipTest('cannot mount a tmpfs')
        self.addCleanup(subprocess.run, ['umount', '-l', self.directory])

        def take(message):
            states.extend(status.message for status in message.status if status.name == name + ': log')
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, take)
        node = NodeProcess(name, {'log_enabled': True, 'log_directory': self.directory, 'log_min_free_mb': 10,
                                  'crank_zero_std_rad': KNOWN_ZERO, 'diagnostic_period': 0.1})
        self.assertTrue(eventually(lambda: 'recording' in states))
        other = os.path.join(self.directory, 'other')
        with open(other, 'wb') as file:
            file.write(bytes(60000000))
        self.assertTrue(eventually(lambda: any(state.startswith('stopped: ') for state in states)))
        os.remove(other)
        self.assertTrue(eventually(lambda: states[-1] == 'recording'))
        sent, received = self.publish_session(name, 4.0)
        self.assertEqual(node.end()[0], 0)
        subscriber.unregister()
        bags = sorted(glob.glob(self.directory + '/*'))
        self.assertEqual(len(bags), 2, bags)
        topics = self.messages_in(bags[-1])
        self.assertEqual(topics['/%s/crank' % name], sent)
        self.assertEqual(topics['/%s/hull_wrench' % name], received)


if __name__ == '__main__':
    rospy.init_node('process_rostest')
    rostest.rosrun('hammer_loads', 'process', ProcessTest, sys.argv)
