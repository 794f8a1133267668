#!/usr/bin/env python3
"""The log in runs: services start, stop and split it, simulated time that runs back begins anew; each bag stands alone
and process_bag gives its outputs again. Run against the node and against the nodelet."""
import copy
import os
import shutil
import subprocess
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from node_session import (NodeSession, START, active_bags, bags, closed_bags, entries, expect_reproduced, messages,
                          outside, recorded)
from process_rostest import eventually

OUTPUTS = ['blow', 'boom_vibration', 'boom_wrench/arm_link', 'boom_wrench/gauge', 'hull_loads', 'hull_wrench',
           'joint_loads', 'joint_reactions', 'load_cycles', 'mechanism', 'pulse', 'run_info', 'section_loads', 'turn_loads']
FIRST, REWOUND = 0, 2  # which bag holds what


def transform_to(frame):
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = 'hammer_hull', frame
    transform.transform.translation.z = -0.5
    transform.transform.rotation.w = 1.0
    return TFMessage([transform])


class RunsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = rospy.get_param('/hammer_loads/log_directory')
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=1000, tcp_nodelay=True)
        cls.transforms = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        cls.transforms.publish(transform_to('gauge'))
        cls.session = NodeSession()
        cls.sent, cls.answers = [], []
        assert eventually(lambda: cls.clock.get_num_connections() > 0 and cls.transforms.get_num_connections() > 0)
        cls.record()

    @classmethod
    def call(cls, act):
        answer = rospy.ServiceProxy('/hammer_loads/log/' + act, Trigger)()
        cls.answers.append((act, answer.success, answer.message))

    @classmethod
    def feed(cls, piece):
        """In simulated time."""
        cls.sent += [message for is_crank, message in piece if is_crank]
        cls.clock.publish(piece[0][1].header.stamp)
        cls.session.feed(piece)

    @classmethod
    def record(cls):
        bad = copy.deepcopy(recorded(3.5, 3.51))
        bad[0][1].position = [float('nan')] * len(bad[0][1].position)
        cls.feed(recorded(3.0, 3.5) + bad[:1] + outside(recorded(3.51, 5.0), 4.2, 4.6))
        cls.call('split')
        cls.feed(recorded(5.0, 6.0))
        cls.run_back(3.0)
        cls.feed(recorded(3.0, 4.5))
        cls.call('start')
        cls.call('stop')
        cls.call('stop')
        cls.call('split')
        cls.session.feed(recorded(4.5, 5.0))
        cls.without_directory()
        cls.call('start')
        cls.feed(recorded(5.0, 6.0))
        cls.call('stop')
        cls.files = closed_bags(cls.directory, 4)

    @classmethod
    def run_back(cls, instant):
        """Until the node has noticed: a bag is closed. Joint states are its input meanwhile."""
        closed = len(bags(cls.directory))
        joints = [entry for entry in recorded(instant, instant + 0.1) if not entry[0]]

        def noticed():
            cls.clock.publish(rospy.Time.from_sec(START + instant))
            cls.session.send(joints)
            return len(bags(cls.directory)) > closed
        assert eventually(noticed)

    @classmethod
    def without_directory(cls):
        """The log closes its bag behind the answer to `stop`, and needs the directory until then."""
        assert eventually(lambda: not active_bags(cls.directory))
        aside = cls.directory + '_aside'
        os.rename(cls.directory, aside)
        cls.call('start')
        os.rename(aside, cls.directory)

    def test_services_report_their_action_or_the_reason_against_it(self):
        self.assertEqual(
            [(act, success) for act, success, _ in self.answers],
            [('split', True), ('start', False), ('stop', True), ('stop', False), ('split', False), ('start', False),
             ('start', True), ('stop', True)])
        says = [message for _, _, message in self.answers]
        self.assertIn('already', says[1])
        self.assertIn('was not recording', says[3])
        self.assertIn('log_directory', says[5])
        self.assertEqual(len(says[5].splitlines()), 1)

    def test_each_bag_stands_alone(self):
        self.assertEqual(len(self.files), 4, self.files)
        info = subprocess.run(['rosbag', 'info', '--yaml'] + self.files, check=True, stdout=subprocess.PIPE,
                              universal_newlines=True).stdout
        self.assertEqual(info.count('indexed: True'), 4, info)
        for path in self.files:
            infos = entries(path, '/hammer_loads/run_info')
            statics = entries(path, '/tf_static')
            crank = entries(path, '/crank')
            self.assertEqual((len(infos), len(statics)), (1, 1), path)
            self.assertLessEqual(max(infos[0][1], statics[0][1]), crank[0][1])
            first = min(time for _, time, _ in entries(path, '/crank', '/joint_states'))
            self.assertEqual(messages(path, '/hammer_loads/run_info')[0].header.stamp.to_nsec(), first,
                             'stamped with its first input')

    def test_nothing_that_was_sent_is_missing(self):
        logged = [m.header.stamp for path in self.files for m in messages(path, '/crank')]
        self.assertEqual(logged, [m.header.stamp for m in self.sent])

    def test_process_bag_gives_each_bag_again_bit_for_bit(self):
        for path in self.files:
            topics = expect_reproduced(self, path, self.session)
            self.assertEqual(sorted(topics), ['/hammer_loads/' + name for name in OUTPUTS], path)

    def test_drop_out_and_bad_sample_withhold_some_wrenches(self):
        crank = len(entries(self.files[FIRST], '/crank'))
        wrenches = len(entries(self.files[FIRST], '/hammer_loads/hull_wrench'))
        self.assertGreater(crank, 1500)
        self.assertLess(wrenches, crank)
        self.assertGreater(wrenches, 0.97 * crank)

    def test_a_run_begins_without_memory_of_the_one_before(self):
        """Equal samples are taken, once at the start of the node and once after time ran back."""
        def beginning(path):
            return [m for m in messages(path, '/hammer_loads/hull_wrench') if m.header.stamp.to_sec() < START + 3.4]
        first, again = beginning(self.files[FIRST]), beginning(self.files[REWOUND])
        self.assertGreater(len(first), 350)
        self.assertEqual([m.header.stamp for m in first], [m.header.stamp for m in again])


if __name__ == '__main__':
    rospy.init_node('runs_rostest')
    rostest.rosrun('hammer_loads', 'runs', RunsTest, sys.argv)
