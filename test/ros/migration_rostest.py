#!/usr/bin/env python3
"""Bags of older message definitions: process_bag names them, rosbag fix makes them readable."""
import inspect
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import genpy.dynamic
import rosbag
import rosbag.migration
import roslib.packages
import rospkg
import rospy
import rostest
from hammer_loads.msg import (Blow, BoomVibration, HullLoads, JointLoads, JointReactions, LoadCycles, Pulse, SectionLoads,
                              TurnLoads)
from geometry_msgs.msg import Vector3, Wrench
from sensor_msgs.msg import JointState

DATA = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'data')
RULES = os.path.join(DATA, '..', '..', 'migration', 'hammer_loads.bmr')
# As test/data/old_messages has them: before deviations and flags, before the flags of Blow, and before deviations had a
# common part.
KINDS = {kind._type.split('/')[1]: kind for kind in (
    Blow, BoomVibration, HullLoads, JointLoads, JointReactions, LoadCycles, Pulse, SectionLoads, TurnLoads)}
OLD = {'first': ('Blow', 'BoomVibration', 'HullLoads', 'JointLoads'), 'second': ('Blow', 'HullLoads'),
       'third': tuple(sorted(set(KINDS) - {'BoomVibration'}))}
# rosbag builds its rules with exec() and looks for them in locals(), which Python 3.13 does not fill any more (PEP 667).
ROSBAG_FIXES = sys.version_info < (3, 13) or 'return locals()[name]' not in inspect.getsource(rosbag.migration)
RULE = '=' * 80
PARTS = (RULE + '\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n' +
         RULE + '\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n' +
         RULE + '\nMSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n')


def old_class(version, name):
    """A message as it was before, and the class of its channels if it has any."""
    def definition(of):
        with open(os.path.join(DATA, 'old_messages', version, of + '.msg')) as file:
            return file.read()
    text = definition(name) + PARTS
    if name == 'LoadCycles':
        text += RULE + '\nMSG: hammer_loads/ChannelCycles\n' + definition('ChannelCycles')
    classes = genpy.dynamic.generate_dynamic('hammer_loads/' + name, text)
    return classes['hammer_loads/' + name], classes.get('hammer_loads/ChannelCycles')


def number_all(message, start, channel=None):
    """Every number different, so that none can be taken for another."""
    for i, (name, kind) in enumerate(zip(message.__slots__, message._slot_types)):
        if kind == 'float64':
            setattr(message, name, start + i)
        elif kind == 'float64[]':
            setattr(message, name, [start + i, start + i + 0.5])
        elif kind == 'string[]':
            setattr(message, name, [name + '_a', name + '_b'])
        elif kind in ('uint8', 'uint16', 'uint64'):
            setattr(message, name, 5)
        elif kind == 'string':
            setattr(message, name, name)
        elif kind == 'time':
            setattr(message, name, rospy.Time(99, i))
        elif kind == 'geometry_msgs/Vector3':
            getattr(message, name).y = start + i
        elif kind == 'geometry_msgs/Wrench[]':
            setattr(message, name, [Wrench(torque=Vector3(y=start + i + place)) for place in (0, 0.5)])
        elif kind == 'geometry_msgs/Vector3[]':
            setattr(message, name, [Vector3(y=start + i + place) for place in (0, 0.5)])
        elif kind == 'hammer_loads/ChannelCycles[]':
            setattr(message, name, [number_all(channel(), start + 50 + i), number_all(channel(), start + 70 + i)])
    if hasattr(message, 'header'):
        message.header.stamp = rospy.Time(100, 7)
        message.header.frame_id = 'hammer_hull'
    return message


def text_of(message, field, fields_of):
    """fields_of: the message whose parts say which of their fields count."""
    value, other = getattr(message, field), getattr(fields_of, field)
    if isinstance(value, (list, tuple)) and value and hasattr(value[0], '__slots__'):
        return str([[text_of(part, name, like) for name in like.__slots__] for part, like in zip(value, other)])
    return str(list(value) if isinstance(value, tuple) else value)


class Migration(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.directory)
        self.old = self.path('old.bag')
        self.messages = {}
        with rosbag.Bag(self.old, 'w') as bag:
            for i, (version, name) in enumerate((v, n) for v, names in OLD.items() for n in names):
                message_class, channel = old_class(version, name)
                message = number_all(message_class(), 1000.0 * (i + 1), channel)
                self.messages[version, name] = message
                bag.write('/%s/%s' % (version, name), message, rospy.Time(100 + i))

    def path(self, name):
        return os.path.join(self.directory, name)

    def run_command(self, *arguments):
        done = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return done.returncode, done.stdout

    def fix(self):
        """Messages of the new bag by version and name."""
        if not ROSBAG_FIXES:
            self.skipTest('this rosbag cannot fix bags')
        code, text = self.run_command('rosbag', 'fix', '-n', self.old, self.path('new.bag'), RULES)
        self.assertEqual(code, 0, text)
        found = {}
        with rosbag.Bag(self.path('new.bag')) as bag:
            for topic, message, time in bag.read_messages():
                found[tuple(topic.split('/')[1:])] = message
                self.assertEqual(time, rospy.Time(100 + len(found) - 1))
        return found

    def test_fix_keeps_what_was_recorded(self):
        found = self.fix()
        self.assertEqual(set(found), set(self.messages))
        for key, message in self.messages.items():
            self.assertEqual(found[key]._md5sum, KINDS[key[1]]._md5sum)
            self.assertNotEqual(message._md5sum, found[key]._md5sum, key)
            for field in message.__slots__:
                self.assertEqual(text_of(found[key], field, message), text_of(message, field, message), (key, field))

    def test_flags_that_did_not_exist_do_not_hold(self):
        found = self.fix()
        for version in ('first', 'second'):
            self.assertEqual(found[version, 'Blow'].flags, 0, version)
            self.assertFalse(found[version, 'HullLoads'].flags & HullLoads.FLAG_INCONSISTENT, version)

    def test_common_parts_are_not_known(self):
        found = {name: message for (version, name), message in self.fix().items() if version == 'third'}
        for name, field in (('Blow', 'energy_common_deviation_J'), ('HullLoads', 'force_z_common_deviation_N'),
                            ('Pulse', 'impulse_deviation_Ns'), ('Pulse', 'turn_impulse_z_common_deviation_Ns')):
            self.assertEqual(str(getattr(found[name], field)), 'nan', (name, field))
        for name, field in (('TurnLoads', 'maximum_common_deviation'),
                            ('JointLoads', 'total_torque_common_deviation_Nm'),
                            ('JointLoads', 'cylinder_force_common_deviation_N')):
            self.assertEqual(str(getattr(found[name], field)), '(nan, nan)', (name, field))
        self.assertEqual(str(found['SectionLoads'].load_common_deviation[1].torque.z), 'nan')
        self.assertEqual(str(found['JointReactions'].load_common_deviation[0].force.x), 'nan')
        self.assertEqual([str(c.damage_common_deviation) for c in found['LoadCycles'].channel], ['nan', 'nan'])
        self.assertEqual(len(found['LoadCycles'].channel[0].equivalent_range_common_deviation), 2)
        self.assertEqual(found['Blow'].struck, Blow.STRUCK_UNKNOWN)

    def test_what_was_not_recorded_is_not_a_number(self):
        found = {name: message for (version, name), message in self.fix().items() if version == 'first'}
        self.assertEqual(str(found['Blow'].restitution_deviation), 'nan')
        self.assertEqual(str(found['HullLoads'].consistency), 'nan')
        self.assertEqual(found['HullLoads'].drive_reaction_y_Nm, 0.0)
        self.assertEqual(found['HullLoads'].sample_stamp, rospy.Time(100, 7))
        self.assertEqual(str(found['JointLoads'].cylinder_force_deviation_N), '(nan, nan)')
        self.assertEqual(found['JointLoads'].cylinder_flags, (0, 0))
        self.assertEqual(str(found['BoomVibration'].damping_ratio), '(nan, nan)')

    def test_process_bag_names_them_and_the_command(self):
        with rosbag.Bag(os.path.join(DATA, 'mo100_100hz.bag')) as session, rosbag.Bag(self.old, 'a') as bag:
            for topic, message, time in session.read_messages(raw=True):
                bag.write(topic, message, time, raw=True)
        process_bag = roslib.packages.find_node('hammer_loads', 'process_bag')[0]
        code, text = self.run_command(process_bag, '--no-bag', self.old, '--db', self.path('out.sqlite'))
        self.assertEqual(code, 0, text)
        warning = [line for line in text.splitlines() if 'another version' in line]
        self.assertEqual(len(warning), 1, text)
        for version, name in self.messages:
            self.assertIn('/%s/%s (hammer_loads/%s)' % (version, name, name), warning[0])
        if not ROSBAG_FIXES:
            self.skipTest('this rosbag cannot fix bags')
        # The command that it names is the one that helps.
        fix = warning[0].split('`')[1].replace('NEW.bag', self.path('new.bag'))
        code, text = self.run_command(*fix.split())
        self.assertEqual(code, 0, text)
        code, text = self.run_command('rosbag', 'check', '-n', self.path('new.bag'))
        self.assertIn('not need any migrations', text)

    def test_the_package_exports_its_rules(self):
        export = rospkg.RosPack().get_manifest('hammer_loads').get_export('rosbag', 'migration_rule_file')
        self.assertEqual(export, ['migration/hammer_loads.bmr'])
        self.assertTrue(os.path.isfile(os.path.join(rospkg.RosPack().get_path('hammer_loads'), export[0])))


if __name__ == '__main__':
    rostest.rosrun('hammer_loads', 'migration', Migration)
