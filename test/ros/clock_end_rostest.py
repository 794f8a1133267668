#!/usr/bin/env python3
"""/clock at the end of ROS time, 2^32 s, and back: no node aborts, all report and go on."""
import shutil
import signal
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from grapple_process_rostest import claims
from process_rostest import NodeProcess, eventually

END = 2 ** 32  # [s]
LAST = (END - 1, 999999999)


class ClockEnd(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.clock = rospy.Publisher('/clock', Clock, queue_size=100, latch=True)
        self.told, self.slid = set(), set()
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics)
        rospy.Subscriber('/simulate_grapple/joints', JointState,
                         lambda m: self.slid.add((m.header.stamp.secs, m.header.stamp.nsecs)))

    def on_diagnostics(self, message):
        stamp = (message.header.stamp.secs, message.header.stamp.nsecs)
        self.told.update((status.name.split(':')[0], stamp) for status in message.status)

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

    def report_at(self, instant, nodes=('hammer_loads_node', 'grapple_node')):
        """The clock stands there until each of the nodes has reported at it."""
        return self.stands(instant, lambda: self.told >= {(node, instant) for node in nodes})

    def parameters(self):
        log = {'log_directory': self.directory, 'log_min_free_mb': 0}
        return {'hammer_loads_node': log, 'grapple_node': dict(claims(), **log)}

    def test_no_node_aborts(self):
        parameters = dict(self.parameters(), show_loads={}, simulate_hammer={},
                          simulate_grapple=dict(claims(), slider_joint='slider', period_s=1.0, rate_Hz=50.0))
        nodes = {program: NodeProcess(program, given, program) for program, given in parameters.items()}
        self.assertTrue(self.report_at((END - 20, 0)), 'the nodes follow the clock')
        self.run_over([(END - 10 + i // 4, 250000000 * (i % 4)) for i in range(40)])
        self.assertTrue(self.report_at(LAST), 'each reports there as well')
        self.run_over([(0, 1), LAST, (5, 0)])
        self.assertTrue(self.report_at((100, 0)), 'and go on')
        for program, node in nodes.items():
            self.assertIsNone(node.process.poll(), program)
            code, _, err = node.end(signal.SIGINT)
            self.assertEqual(code, 0, program + ': ' + err)

    def test_a_node_starts_there(self):
        self.clock.publish(Clock(rospy.Time(*LAST)))
        nodes = {program + '_late': NodeProcess(program + '_late', given, program)
                 for program, given in self.parameters().items()}
        self.assertTrue(self.report_at(LAST, nodes), [node.process.poll() for node in nodes.values()])
        for name, node in nodes.items():
            self.assertEqual(node.end(signal.SIGINT)[0], 0, name)


if __name__ == '__main__':
    rospy.init_node('clock_end_rostest')
    rostest.rosrun('hammer_loads', 'clock_end', ClockEnd, sys.argv)
