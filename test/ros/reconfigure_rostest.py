#!/usr/bin/env python3
"""Parameters that may change while the node runs, and those that may not."""
import math
import shutil
import sys
import unittest

import rospy
import rostest
import yaml
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from hammer_loads.msg import RunInfo
from std_srvs.srv import Trigger

from node_session import (NodeSession, START, TURN, active_bags, closed_bags, crank_stamps, expect_reproduced,
                          messages, recorded, topics_in)
from process_rostest import eventually

PER_TURN = {'/hammer_loads/' + name for name in ('run_info', 'blow', 'pulse', 'turn_loads', 'load_cycles',
                                         'alarms')}
AT_START = {'log_enabled': True, 'output_rate_Hz': 0.0, 'tolerance': 0.5, 'withhold_above': 0.1}


def request(**changes):
    config = Config()
    for name, value in changes.items():
        if isinstance(value, bool):
            config.bools.append(BoolParameter(name, value))
        else:
            config.doubles.append(DoubleParameter(name, value))
    return config


def values(config):
    return {parameter.name: parameter.value for parameter in config.bools + config.doubles}


class ReconfigureTest(unittest.TestCase):
    """Each test leaves the node as it found it, but for the log."""

    @classmethod
    def setUpClass(cls):
        cls.directory = rospy.get_param('/hammer_loads/log_directory')
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.infos, cls.told = [], []
        cls.subscribers = [rospy.Subscriber('/hammer_loads/run_info', RunInfo, cls.infos.append),
                           rospy.Subscriber('/hammer_loads/parameter_updates', Config, cls.told.append)]
        cls.session = NodeSession()
        cls.files, cls.next = 0, 3.0
        assert eventually(lambda: cls.infos and cls.told)

    @classmethod
    def tearDownClass(cls):
        rospy.ServiceProxy('/hammer_loads/log/stop', Trigger)()
        assert eventually(lambda: not active_bags(cls.directory))

    def change(self, **changes):
        """Answer of the node."""
        return values(rospy.ServiceProxy('/hammer_loads/set_parameters', Reconfigure)(request(**changes)).config)

    def in_force(self, **changes):
        return dict(AT_START, **changes)

    def log(self, act):
        self.assertTrue(rospy.ServiceProxy('/hammer_loads/log/' + act, Trigger)().success)

    def wrenches_of(self, seconds, rate=1000.0):
        """Stamps [s] of the wrenches that the session's next seconds give, at a rate [Hz]."""
        before = len(self.session.wrenches)
        piece = recorded(self.next, self.next + seconds)
        type(self).next += seconds
        self.session.send(piece)
        last = crank_stamps(piece)[-1]
        # A slower output may end before the last sample.
        self.assertTrue(eventually(lambda: len(self.session.wrenches) > before and
                                   (last - self.session.wrenches[-1].header.stamp).to_sec() < 1.0 / rate))
        return [wrench.header.stamp.to_sec() for wrench in self.session.wrenches[before:]]

    def expect_rate(self, rate):
        """[Hz]"""
        stamps = self.wrenches_of(1.0, rate)
        steps = [b - a for a, b in zip(stamps, stamps[1:])]
        self.assertAlmostEqual(len(stamps), rate, delta=0.03 * rate + 2)
        self.assertAlmostEqual(sorted(steps)[len(steps) // 2], 1.0 / rate, delta=0.1 / rate)

    def closed(self, count):
        """Bags closed since the last call."""
        files = closed_bags(self.directory, self.files + count)
        self.assertEqual(len(files), self.files + count)
        type(self).files = len(files)
        return files[-count:]

    def test_1_the_output_rate_changes(self):
        self.expect_rate(1000.0)
        announced = len(self.infos)
        self.assertEqual(self.change(output_rate_Hz=50.0), self.in_force(output_rate_Hz=50.0))
        self.assertTrue(eventually(lambda: len(self.infos) > announced))
        self.assertEqual(yaml.safe_load(self.infos[-1].parameters_yaml)['output_rate_Hz'], 50.0)
        self.expect_rate(50.0)
        self.assertEqual(self.change(output_rate_Hz=0.0), self.in_force())
        self.expect_rate(1000.0)
        self.log('stop')
        files = self.closed(3)
        rates = []
        for path in files:
            infos = messages(path, '/hammer_loads/run_info')
            self.assertEqual(len(infos), 1, path)
            rates.append(yaml.safe_load(infos[0].parameters_yaml)['output_rate_Hz'])
            self.assertEqual(expect_reproduced(self, path, self.session), PER_TURN)
        self.assertEqual(rates, [0.0, 50.0, 0.0])
        self.log('start')

    def test_2_the_log_is_switched_off_and_on(self):
        self.assertEqual(self.change(log_enabled=False), self.in_force(log_enabled=False))
        self.closed(1)
        self.expect_rate(1000.0)
        self.assertEqual(active_bags(self.directory), [])
        self.assertEqual(self.change(log_enabled=True), self.in_force())
        self.expect_rate(1000.0)
        self.log('stop')
        path, = self.closed(1)
        expect_reproduced(self, path, self.session)
        self.assertEqual(topics_in(path) - PER_TURN - {'/diagnostics'}, {'/crank', '/joint_states'})
        self.log('start')

    def test_3_services_and_log_enabled_agree(self):
        self.log('stop')
        self.assertTrue(eventually(lambda: not values(self.told[-1])['log_enabled']))
        self.closed(1)
        self.assertEqual(self.change(tolerance=0.03), self.in_force(log_enabled=False, tolerance=0.03))
        self.assertEqual(active_bags(self.directory), [], 'another change does not start it')
        self.assertEqual(self.change(log_enabled=True, tolerance=0.5), self.in_force())
        self.assertEqual(len(active_bags(self.directory)), 1)

    def test_4_an_unchangeable_parameter_changes_nothing(self):
        self.expect_rate(1000.0)
        announced = len(self.infos)
        self.assertEqual(self.change(crank_length_m=0.01, stale_after_s=5.0, no_such_key=1.0), self.in_force())
        self.assertEqual(self.change(log_directory=True), self.in_force())
        self.assertEqual(self.change(output_rate_Hz=math.nan), self.in_force())
        self.assertEqual(self.change(), self.in_force())
        self.expect_rate(1000.0)
        self.assertEqual(rospy.get_param('/hammer_loads/output_rate_Hz'), 0.0)
        self.assertFalse(rospy.has_param('/hammer_loads/no_such_key'))
        self.log('stop')
        path, = self.closed(1)
        self.assertEqual(len(messages(path, '/hammer_loads/run_info')), 1)
        self.assertEqual(len(self.infos), announced)
        self.log('start')

    def test_5_a_value_beyond_a_bound_is_limited_and_reported(self):
        self.assertEqual(self.change(output_rate_Hz=-5.0), self.in_force())
        self.assertEqual(self.change(output_rate_Hz=1e9, tolerance=0.0, withhold_above=math.inf),
                         self.in_force(output_rate_Hz=1e4, tolerance=1e-9, withhold_above=10.0))
        self.assertTrue(eventually(lambda: values(self.told[-1])['output_rate_Hz'] == 1e4))
        self.assertTrue(eventually(lambda: yaml.safe_load(self.infos[-1].parameters_yaml)['tolerance'] == 1e-9))
        self.expect_rate(1e4)  # and the node still keeps up, and answers
        self.assertEqual(self.change(**AT_START), self.in_force())

    def test_6_output_is_back_within_a_turn(self):
        """A change forgets the estimate: what it costs is bounded."""
        self.expect_rate(1000.0)
        self.change(withhold_above=0.2)
        begin = START + self.next
        self.assertLess(self.wrenches_of(0.5)[0] - begin, TURN)
        self.change(withhold_above=0.1)


if __name__ == '__main__':
    rospy.init_node('reconfigure_rostest')
    rostest.rosrun('hammer_loads', 'reconfigure', ReconfigureTest, sys.argv)
