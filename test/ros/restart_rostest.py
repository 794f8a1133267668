#!/usr/bin/env python3
"""Two hammers under one master; the node of one is killed at work and started again by roslaunch."""
import os
import shutil
import signal
import subprocess
import sys
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from std_srvs.srv import Trigger

from node_session import (NodeSession, TURN, active_bags, bags, closed_bags, crank_stamps, entries, messages,
                          process_again, recorded, topics_in)
from process_rostest import NodeProcess, eventually

SLICE = 20  # messages, some 20 ms


class RestartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = rospy.get_param('/a/hammer_loads/log_directory')
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.a, cls.b = [NodeSession(ns + '/hammer_loads', ns + '/crank', ns + '/joint_states') for ns in ('/a', '/b')]

    def test_1_two_hammers_use_their_own_inputs(self):
        piece = recorded(3.0, 4.0)
        self.a.feed(piece)
        self.assertEqual(self.b.wrenches, [])
        self.b.feed(piece)
        self.assertEqual(self.a.stamps(), self.b.stamps())
        light, heavy = [max(w.wrench.force.z for w in session.wrenches) for session in (self.a, self.b)]
        self.assertGreater(light, 5000.0)
        self.assertAlmostEqual(heavy / light, 2.0, delta=0.1)  # the motion is the samples', but for their noise
        published, _, services = rosgraph.Master('/test').getSystemState()
        for ns in '/a', '/b':
            names = [name for name, nodes in published + services
                     if ns + '/hammer_loads' in nodes and name not in ('/diagnostics', '/rosout')]
            self.assertGreater(len(names), 12)
            self.assertEqual([name for name in names if not name.startswith(ns + '/hammer_loads/')], [])

    def kill(self):
        """Kills the node. Returns a function that reports whether the next one runs, however long roslaunch takes."""
        before = self.a.connections()
        uri = rosgraph.Master('/test').lookupNode('/a/hammer_loads')
        os.kill(ServerProxy(uri).getPid('/test')[2], signal.SIGKILL)
        return lambda: all(now - old for now, old in zip(self.a.connections(), before))

    def work(self, inputs, enough):
        """Runs both machines at about their pace until it is enough. Returns the messages sent."""
        sent = []
        while not enough(sent):
            piece = inputs[len(sent):len(sent) + SLICE]
            self.assertNotEqual(piece, [])
            self.a.send(piece)
            self.b.send(piece)
            sent += piece
            rospy.rostime.wallsleep(1e-3 * SLICE)
        return sent

    def test_2_a_killed_node_goes_on_at_its_restart(self):
        before_b = len(self.b.wrenches)
        inputs = recorded(4.0, 20.0)
        first_life = self.work(inputs, lambda sent: len(sent) > 1500)
        active, = active_bags(self.directory)
        answered = self.a.wrenches[-1].header.stamp
        lives_again = self.kill()
        self.a.wrenches.clear()
        sent = first_life + self.work(inputs[len(first_life):], lambda sent: len(sent) > 200)
        self.assertTrue(eventually(lives_again))
        sent += self.work(inputs[len(sent):], lambda _: len(self.a.wrenches) > 300)
        stamps = crank_stamps(sent)
        self.assertTrue(eventually(lambda: self.b.wrenches[-1].header.stamp == stamps[-1]))
        published = self.b.stamps()[before_b:]
        known = set(published)
        self.assertEqual(published, [stamp for stamp in stamps if stamp in known], 'in their order')
        self.assertGreater(len(published), 0.99 * len(stamps), 'the other lost nothing but samples beside a blow')
        self.assertTrue(rospy.ServiceProxy('/a/hammer_loads/log/stop', Trigger)().success)
        self.assertTrue(eventually(lambda: active_bags(self.directory) == [active]))
        self.expect_output_soon()
        self.expect_outputs_alone(known)
        self.expect_recovered(active, crank_stamps(recorded(3.0, 4.0) + first_life), answered)

    def expect_output_soon(self):
        """Within two turns of the first sample that the new life got."""
        path, = bags(self.directory)
        sample = messages(path, '/a/crank')[0].header.stamp
        wrench = messages(path, '/a/hammer_loads/hull_wrench')[0].header.stamp
        self.assertLess((wrench - sample).to_sec(), 2.0 * TURN)

    def expect_outputs_alone(self, stamps):
        """In the log of the other, which is to hold no inputs."""
        directory = rospy.get_param('/b/hammer_loads/log_directory')
        self.addCleanup(shutil.rmtree, directory)
        self.assertTrue(rospy.ServiceProxy('/b/hammer_loads/log/stop', Trigger)().success)
        path, = closed_bags(directory, 1)
        self.assertEqual({t for t in topics_in(path) if not t.startswith('/b/hammer_loads/')}, {'/diagnostics'})
        logged = {m.header.stamp for m in messages(path, '/b/hammer_loads/hull_wrench')}
        self.assertGreater(logged, stamps)

    def expect_recovered(self, active, sent, answered):
        """The first life's log but for its last second."""
        path = active[:-len('.active')]
        os.rename(active, path)
        subprocess.run(['rosbag', 'reindex', '--quiet', path], check=True, stdout=subprocess.DEVNULL)
        stamps = [m.header.stamp for m in messages(path, '/a/crank')]
        self.assertEqual(stamps, sent[:len(stamps)])
        self.assertLess((answered - stamps[-1]).to_sec(), 1.0)
        last = entries(path, '/a/crank')[-1][1]  # its outputs may be lost

        def outputs(file):
            return sorted(e for e in entries(file, *topics) if e[1] < last)
        topics = [topic for topic in topics_in(path) if topic.startswith('/a/hammer_loads/')]
        self.assertIn('/a/hammer_loads/hull_wrench', topics)
        self.assertTrue(outputs(path) == outputs(process_again(path, self.a)))

    def console_of(self, name, directory):
        """Errors of a node that ends well after it has begun, with a log in this directory."""
        node = NodeProcess(name, {'log_directory': directory, 'log_min_free_mb': 0})
        self.assertTrue(eventually(lambda: '/%s/hull_wrench' % name in dict(rosgraph.Master('/t').getTopicTypes())))
        code, _, err = node.end()
        self.assertEqual(code, 0, err)
        return err

    def test_3_an_unwritable_log_directory_costs_the_log_alone(self):
        err = self.console_of('unwritable', '/proc')
        self.assertIn("log_directory: '/proc', must be writable", err)
        self.assertIn('the node runs without a log', err)

    def test_4_an_unclosed_bag_is_reported_with_its_recovery(self):
        bag = os.path.join(self.directory, 'unclosed_2026-01-02-00-00-00_0.bag')
        with open(bag + '.active', 'w') as file:
            file.write('cut off')
        self.assertIn("mv '%s.active' '%s' && rosbag reindex '%s'" % (bag, bag, bag), self.console_of('unclosed', self.directory))
        self.assertTrue(os.path.exists(bag + '.active'))


if __name__ == '__main__':
    rospy.init_node('restart_rostest')
    rostest.rosrun('hammer_loads', 'restart', RestartTest, sys.argv)
