#!/usr/bin/env python3
"""The installed node runs with the installed parameters and publishes the installed messages."""
import unittest

import rospy
import rostest
from hammer_loads.msg import RunInfo


class Use(unittest.TestCase):
    def test_node_explains_itself(self):
        rospy.init_node('use')
        info = rospy.wait_for_message('/hammer_loads/run_info', RunInfo, timeout=120)
        self.assertIn('crank_length_m', info.parameters_yaml)


if __name__ == '__main__':
    rostest.rosrun('use_package', 'use', Use)
