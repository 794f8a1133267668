#!/usr/bin/env python3
"""Boom loads that rviz draws; checks also that the node uses every sensor of the simulated machine."""
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from hammer_loads.msg import HullLoads, JointLoads, JointReactions, SectionLoads
from tf2_msgs.msg import TFMessage

from process_rostest import eventually

SECTIONS, JOINTS = ('boom_foot', 'boom_middle', 'arm_middle'), ('boom_joint', 'arm_joint', 'hammer_joint')


class DisplayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frames, cls.shown, cls.given, cls.texts = {}, {}, {}, []
        cls.flags = {'hull': 0, 'joints': 0}
        rospy.Subscriber('/tf_static', TFMessage, lambda m: cls.frames.update({t.child_frame_id: t for t in m.transforms}))
        for kind, names in (('section', SECTIONS), ('joint', JOINTS)):
            for name in names:
                rospy.Subscriber('/show_loads/%s/%s' % (kind, name), WrenchStamped, cls.shown.setdefault(kind + '/' + name, []).append)
        rospy.Subscriber('/hammer_loads/section_loads', SectionLoads, lambda m: cls.take(m, 'section/', m.section))
        rospy.Subscriber('/hammer_loads/joint_reactions', JointReactions, lambda m: cls.take(m, 'joint/', m.joint))
        rospy.Subscriber('/hammer_loads/hull_loads', HullLoads, lambda m: cls.flag('hull', m.flags))
        rospy.Subscriber('/hammer_loads/joint_loads', JointLoads, lambda m: cls.flag('joints', m.flags))
        # Marker without its Python package: the text is what is printable at the end of the bytes.
        rospy.Subscriber('/show_loads/text', rospy.AnyMsg, lambda m: cls.texts.append(m._buff.decode('latin-1')))
        assert eventually(lambda: any('blows/s' in text for text in cls.texts))
        assert eventually(lambda: all(len(told) > 10 for told in cls.shown.values()))

    @classmethod
    def take(cls, message, kind, parts):
        for part in parts:
            cls.given[kind + part.name, message.header.stamp] = part.load

    @classmethod
    def flag(cls, source, flags):
        cls.flags[source] |= flags

    def test_every_frame_is_where_the_cut_or_the_joint_is(self):
        for child, parent, x in (('section/boom_foot', 'boom_link', 0.50), ('section/boom_middle', 'boom_link', 1.10),
                                 ('section/arm_middle', 'arm_link', 0.80), ('joint/arm_joint', 'boom_link', 2.60),
                                 ('joint/hammer_joint', 'arm_link', 1.70)):
            frame = self.frames[child]
            self.assertEqual(frame.header.frame_id, parent)
            self.assertAlmostEqual(frame.transform.translation.x, x)
            self.assertAlmostEqual(frame.transform.rotation.w, 1.0)

    def test_every_shown_load_was_published(self):
        compared = 0
        for frame, told in self.shown.items():
            for message in list(told):
                self.assertEqual(message.header.frame_id, frame)
                load = self.given.get((frame, message.header.stamp))
                if load is not None:
                    self.assertEqual(message.wrench, load)
                    compared += 1
        self.assertGreater(compared, 30)

    def test_the_node_uses_the_hulls_imu_and_the_cylinders_pressures(self):
        self.assertTrue(self.flags['hull'] & HullLoads.FLAG_HULL_MOTION)
        self.assertTrue(self.flags['joints'] & JointLoads.FLAG_MEASURED)


if __name__ == '__main__':
    rospy.init_node('display_rostest')
    rostest.rosrun('hammer_loads', 'display', DisplayTest, sys.argv)
