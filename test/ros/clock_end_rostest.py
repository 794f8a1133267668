#!/usr/bin/env python3
"""/clock at the end of ROS time, 2^32 s, and back: no node aborts, all go on."""
import shutil
import signal
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import JointState

from grapple_process_rostest import claims
from process_rostest import NodeProcess, eventually

END = 2 ** 32  # [s]
LAST = (END - 1, 999999999)


class ClockEnd(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self.told, self.slid, self.warned = [], set(), set()
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.told.append)
        rospy.Subscriber('/simulate_grapple/joints', JointState,
                         lambda m: self.slid.add((m.header.stamp.secs, m.header.stamp.nsecs)))
        rospy.Subscriber('/rosout', Log, self.on_log)

    def on_log(self, message):
        if 'no diagnostics' in message.msg:
            self.warned.add(message.name)

    def tearDown(self):
        shutil.rmtree(self.directory, ignore_errors=True)

    def stands(self, instant, until):
        """The clock stands there until something holds."""
        def holds():
            self.clock.publish(Clock(rospy.Time(*instant)))
            return until()
        return eventually(holds)

    def run_over(self, instants):
        """Each stands until the simulated slider moves at it: the clock has come to the nodes."""
        for instant in instants:
            self.slid.clear()
            self.assertTrue(self.stands(instant, lambda at=instant: at in self.slid), instant)

    def heard(self, seconds):
        """The clock stands there until diagnostics say so."""
        return self.stands((seconds, 0), lambda: any(message.header.stamp.secs == seconds for message in self.told))

    def test_no_node_aborts(self):
        log = {'log_directory': self.directory, 'log_min_free_mb': 0}
        parameters = {'hammer_loads_node': log, 'show_loads': {}, 'simulate_hammer': {},
                      'grapple_node': dict(claims(), **log),
                      'simulate_grapple': dict(claims(), slider_joint='slider', period_s=1.0, rate_Hz=50.0)}
        nodes = {program: NodeProcess(program, given, program) for program, given in parameters.items()}
        self.assertTrue(self.heard(END - 20), 'the nodes follow the clock')
        self.run_over([(END - 10 + i // 4, 250000000 * (i % 4)) for i in range(40)])
        self.assertTrue(self.stands(LAST, lambda: {'/hammer_loads_node', '/grapple_node'} <= self.warned),
                        'each reports there as well')
        self.run_over([(0, 1), LAST, (5, 0)])
        self.assertTrue(self.heard(100), 'and go on')
        for program, node in nodes.items():
            self.assertIsNone(node.process.poll(), program)
            code, _, err = node.end(signal.SIGINT)
            self.assertEqual(code, 0, program + ': ' + err)


if __name__ == '__main__':
    rospy.init_node('clock_end_rostest')
    rostest.rosrun('hammer_loads', 'clock_end', ClockEnd, sys.argv)
