#!/usr/bin/env python3
"""The grapple node as a process: its exit codes, its errors, its log, and the log processed again."""
import glob
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rosgraph
import rospy
import rostest
import yaml
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from process_rostest import NodeProcess, command, eventually

CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', '..', 'config')
SAMPLES = 300


def claims():
    with open(os.path.join(CONFIG, 'grapple_claims.yaml')) as file:
        return yaml.safe_load(file)


class GrappleProcessTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()

    def tearDown(self):
        shutil.rmtree(self.directory, ignore_errors=True)

    def expect_refused(self, name, parameters):
        """The lines it ends with."""
        code, _, err = NodeProcess(name, parameters, 'grapple_node').wait()
        self.assertEqual(code, 1, err)
        published = rosgraph.Master('/test').getSystemState()[0]
        self.assertEqual([topic for topic, _ in published if topic.startswith('/%s/' % name)], [])
        return err.splitlines()

    def test_bad_parameters_are_reported_together_and_end_the_node(self):
        lines = self.expect_refused('bad_values', dict(
            claims(), log_enabled=False, bd_length_m=-0.29, slider_acceleration='guess', slider_opne_m=0.6))
        self.assertEqual([line.split(':')[0] for line in lines],
                         ['bd_length_m', 'slider_acceleration', 'slider_opne_m'], lines)

    def test_an_impossible_log_directory_is_refused(self):
        lines = self.expect_refused('bad_log', dict(claims(), log_enabled=True, log_directory='/proc/no/such'))
        self.assertEqual(len(lines), 1, lines)
        self.assertIn('log_directory', lines[0])

    def node_at_work(self, name, **parameters):
        """The node and a function that lets it work through some samples."""
        node = NodeProcess(name, dict(claims(), log_directory=self.directory, log_min_free_mb=0, log_outputs='all', **parameters),
                           'grapple_node')
        joints = rospy.Publisher('/%s/joints' % name, JointState, queue_size=1000)
        mechanisms = []
        subscriber = rospy.Subscriber('/%s/mechanism' % name, JointState, mechanisms.append, queue_size=None)
        self.assertTrue(eventually(lambda: joints.get_num_connections() > 0 and subscriber.get_num_connections() > 0))

        def work():
            before = len(mechanisms)
            for i in range(before, before + SAMPLES):
                message = JointState(name=['grapple_slider_joint'], position=[0.332 + 0.3 * math.sin(0.05 * i)],
                                     velocity=[0.1])
                message.header.stamp = rospy.Time(100.0 + 0.01 * i)
                joints.publish(message)
            self.assertTrue(eventually(lambda: len(mechanisms) >= before + SAMPLES), len(mechanisms))
        return node, work

    def bags(self):
        return sorted(glob.glob(self.directory + '/grapple_*.bag'), key=os.path.getmtime)

    def expect_same_again(self, name, path):
        """process_grapple over a log gives its outputs bit for bit."""
        again = os.path.join(self.directory, 'again.bag')
        parameters = os.path.join(self.directory, 'in_force.yaml')
        with rosbag.Bag(path) as bag:
            infos = [message for _, message, _ in bag.read_messages(topics=['/%s/run_info' % name])]
        self.assertEqual(len(infos), 1, path)
        with open(parameters, 'w') as file:
            file.write(infos[0].parameters_yaml)
        subprocess.run([command('process_grapple'), path, again, '--params', parameters,
                        '--joint-states-topic', '/%s/joints' % name, '--output-prefix', '/' + name], check=True)

        def outputs(bag_path):
            with rosbag.Bag(bag_path) as bag:
                return sorted((topic, time.to_nsec(), raw[1]) for topic, raw, time in bag.read_messages(raw=True)
                              if topic not in ('/%s/joints' % name, '/diagnostics'))

        logged = outputs(path)
        self.assertEqual(len(logged), 7 * SAMPLES + 1)
        self.assertTrue(logged == outputs(again))
        os.remove(again)

    def test_the_log_starts_splits_and_stops_on_request_and_each_bag_stands_alone(self):
        name = 'served'
        node, work = self.node_at_work(name, log_enabled=False)

        def request(what):
            return rospy.ServiceProxy('/%s/log/%s' % (name, what), Trigger)()
        work()
        self.assertEqual(self.bags(), [])
        self.assertFalse(request('split').success)
        self.assertTrue(request('start').success)
        self.assertFalse(request('start').success)
        work()
        self.assertTrue(request('split').success)
        work()
        self.assertTrue(request('stop').success)
        work()
        code, _, err = node.end(signal.SIGTERM)
        self.assertEqual(code, 0, err)
        self.assertEqual(len(self.bags()), 2, os.listdir(self.directory))
        for path in self.bags():
            self.expect_same_again(name, path)


if __name__ == '__main__':
    rospy.init_node('grapple_process_rostest')
    rostest.rosrun('hammer_loads', 'grapple_process', GrappleProcessTest, sys.argv)
