#!/usr/bin/env python3
"""The ledger of live nodes: the numbers of their bags; its trouble is not the node's."""
import glob
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from hammer_loads.msg import LoadCycles
from sensor_msgs.msg import JointState

from node_session import recorded
from process_rostest import KNOWN_ZERO, NodeProcess, command, eventually

# Commits are counted in runs.pieces: one for each period live, one for a run from its bags.
TABLES = {'epochs': '*', 'channels': '*', 'runs': 'run, name, epoch, parameters, messages', 'days': '*',
          'tallies': '*', 'cycles': '*', 'residues': '*', 'marks': '*'}


def contents(path):
    with sqlite3.connect('file:%s?mode=ro' % path, uri=True) as ledger:
        return {table: sorted(ledger.execute('SELECT %s FROM %s' % (columns, table)).fetchall(), key=repr)
                for table, columns in TABLES.items()}


class LedgerTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.ledger = os.path.join(self.directory, 'machine.sqlite')
        self.statuses = {}
        self.diagnostics = rospy.Subscriber('/diagnostics', DiagnosticArray, self.take_diagnostics)

    def tearDown(self):
        self.diagnostics.unregister()
        shutil.rmtree(self.directory, ignore_errors=True)

    def take_diagnostics(self, message):
        for status in message.status:
            self.statuses[status.name] = status

    def life_of(self, name):
        """Text of the node's status of its count, empty before the first one."""
        texts = [s.message for n, s in self.statuses.items() if name in n and n.endswith('life')]
        return texts[0] if texts else ''

    def node(self, name, ledger, log=False):
        directory = os.path.join(self.directory, name)
        os.mkdir(directory)
        return NodeProcess(name, {'life_ledger': ledger, 'life_period_s': 1.0, 'log_enabled': log,
                                  'log_directory': directory, 'log_min_free_mb': 0, 'crank_zero_std_rad': KNOWN_ZERO})

    def count_bag_of(self, name, ledger):
        """Counts the node's recording."""
        bag, = glob.glob(os.path.join(self.directory, name, '*.bag'))
        return subprocess.run([command('process_bag'), '--no-bag', bag, '--ledger', ledger], check=True,
                              stderr=subprocess.PIPE, universal_newlines=True).stderr

    def send(self, name, begin, end):
        """Stamp of the last message."""
        crank = rospy.Publisher('/%s/crank' % name, JointState, queue_size=100000)
        joints = rospy.Publisher('/%s/joints' % name, JointState, queue_size=100000)
        self.assertTrue(eventually(lambda: crank.get_num_connections() > 0 and joints.get_num_connections() > 0))
        messages = recorded(begin, end)
        for is_crank, message in messages:
            (crank if is_crank else joints).publish(message)
        return messages[-1][1].header.stamp

    def feed(self, name, begin, end):
        """Until the count has seen the last of it, in periods of a second."""
        counts = []
        subscriber = rospy.Subscriber('/%s/load_cycles' % name, LoadCycles, counts.append)
        self.assertTrue(eventually(lambda: subscriber.get_num_connections() > 0))
        last = self.send(name, begin, end)
        self.assertTrue(eventually(lambda: counts and (last - counts[-1].header.stamp).to_sec() < 1.1))
        subscriber.unregister()
        return counts

    def test_the_bags_of_a_run_give_its_numbers_and_are_not_counted_again(self):
        node = self.node('counted', self.ledger, log=True)
        counts = self.feed('counted', 0.0, 8.0)
        code, _, err = node.end(signal.SIGINT)
        self.assertEqual(code, 0, err)
        self.assertGreater(len(counts), 4)
        self.assertGreater(counts[-1].turns, 10)
        self.assertEqual([c.name for c in counts[-1].channel],
                         ['hull_wrench/force_x', 'hull_wrench/force_z', 'hull_wrench/torque_y'])
        live = contents(self.ledger)
        self.assertGreater(sum(row[-1] for row in live['cycles']), 20)
        again = os.path.join(self.directory, 'again.sqlite')
        self.count_bag_of('counted', again)
        self.assertEqual(contents(again), live)
        self.assertIn('is in it already, not counted again', self.count_bag_of('counted', self.ledger))
        self.assertEqual(contents(self.ledger), live)

    def test_a_ledger_that_cannot_be_costs_the_ledger_alone(self):
        os.mkdir(self.ledger)
        node = self.node('without', self.ledger)
        self.feed('without', 0.0, 5.0)
        self.assertTrue(eventually(lambda: 'is no regular file' in self.life_of('without')), self.life_of('without'))
        code, out, err = node.end()
        self.assertEqual(code, 0, err)
        self.assertEqual((out + err).count('is no regular file'), 2, 'once when it is new, once at the end')


if __name__ == '__main__':
    rospy.init_node('ledger_rostest')
    rostest.rosrun('hammer_loads', 'ledger', LedgerTest, sys.argv)
