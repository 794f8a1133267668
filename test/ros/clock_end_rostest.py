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
from rosgraph_msgs.msg import Clock

from grapple_process_rostest import claims
from process_rostest import NodeProcess, eventually

END = 2 ** 32  # [s]


class ClockEnd(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self.told = []
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.told.append)

    def tearDown(self):
        shutil.rmtree(self.directory, ignore_errors=True)

    def show(self, seconds, nanoseconds=0):
        self.clock.publish(Clock(rospy.Time(seconds, nanoseconds)))

    def run_over(self, instants):
        """Each stands for longer than any timer's period."""
        for instant in instants:
            self.show(*instant)
            rospy.rostime.wallsleep(0.1)

    def heard(self, seconds):
        """The clock stands there until diagnostics say so."""
        def told():
            self.show(seconds)
            return any(message.header.stamp.secs == seconds for message in self.told)
        return eventually(told)

    def test_no_node_aborts(self):
        log = {'log_directory': self.directory, 'log_min_free_mb': 0}
        parameters = {'hammer_loads_node': log, 'show_loads': {}, 'simulate_hammer': {},
                      'grapple_node': dict(claims(), **log),
                      'simulate_grapple': dict(claims(), slider_joint='slider', period_s=1.0, rate_Hz=50.0)}
        nodes = {program: NodeProcess(program, given, program) for program, given in parameters.items()}
        self.assertTrue(self.heard(END - 20), 'the nodes follow the clock')
        self.run_over([(END - 10 + i // 4, 250000000 * (i % 4)) for i in range(40)] + [(END - 1, 999999999)] * 3)
        self.run_over([(0, 1), (END - 1, 999999999), (5, 0)])
        self.assertTrue(self.heard(100), 'and go on')
        for program, node in nodes.items():
            self.assertIsNone(node.process.poll(), program)
            code, _, err = node.end(signal.SIGINT)
            self.assertEqual(code, 0, program + ': ' + err)


if __name__ == '__main__':
    rospy.init_node('clock_end_rostest')
    rostest.rosrun('hammer_loads', 'clock_end', ClockEnd, sys.argv)
