"""Shared by the tests of a running node: a recorded session as its input, its log, the log processed again."""
import glob
import os
import subprocess

import rosbag
import rospy
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from process_rostest import DATA, command, eventually

START = 1700000000.0  # [s] of the recorded session
TURN = 0.2  # [s]
PART = 150  # messages that may wait for the node
WITHHELD = 50  # samples, more than are withheld anywhere after a start or a drop-out


def recorded(begin, end):
    """Messages recorded between two instants [s] of the 1 kHz session: (is_crank, message) in order of arrival."""
    limits = {'start_time': rospy.Time.from_sec(START + begin), 'end_time': rospy.Time.from_sec(START + end)}
    with rosbag.Bag(os.path.join(DATA, 'mo100_1khz.bag')) as bag:
        return [(topic == '/hammer/crank', message) for topic, message, _ in bag.read_messages(**limits)]


def outside(piece, begin, end):
    """The piece without its crank samples between two instants [s]: a drop-out."""
    return [(is_crank, message) for is_crank, message in piece
            if not (is_crank and begin < message.header.stamp.to_sec() - START < end)]


def crank_stamps(piece):
    return [message.header.stamp for is_crank, message in piece if is_crank]


class NodeSession:
    """Feeds one node and keeps the stamps of its wrenches."""

    def __init__(self, node='/hammer_loads', crank='/crank', joints='/joint_states'):
        self.node, self.crank_topic, self.joint_topic = node, crank, joints
        self.wrenches = []
        self.subscriber = rospy.Subscriber(node + '/hull_wrench', WrenchStamped, self.wrenches.append, queue_size=None,
                                           tcp_nodelay=True)
        # Without queues, so that neither topic's thread can fall behind the other's.
        self.crank = rospy.Publisher(crank, JointState, queue_size=None)
        self.joints = rospy.Publisher(joints, JointState, queue_size=None)
        assert self.connected(), 'the node must be there'

    def connected(self):
        return eventually(lambda: self.crank.get_num_connections() > 0 and self.joints.get_num_connections() > 0 and
                          self.subscriber.get_num_connections() > 0)

    def connections(self):
        """Connections of each topic; a node that starts again has others."""
        return [set(topic.impl.connections) for topic in (self.crank, self.joints, self.subscriber)]

    def stamps(self):
        return [wrench.header.stamp for wrench in self.wrenches]

    def send(self, piece):
        for is_crank, message in piece:
            (self.crank if is_crank else self.joints).publish(message)

    def feed(self, piece):
        """Sends it and waits for the wrench of its last sample. In parts of which the node has taken one before the next
        is sent: of two connections it may read one to its end first."""
        for begin in range(0, len(piece), PART):
            part = piece[begin:begin + PART]
            known, late = len(self.wrenches), set(crank_stamps(part)[-WITHHELD:])
            self.send(part)
            assert not late or eventually(lambda: late.intersection(self.stamps()[known:])), 'no wrench of %s' % late
        last = crank_stamps(piece)[-1]
        assert eventually(lambda: self.wrenches and self.wrenches[-1].header.stamp == last), \
            '%s of %s' % (self.wrenches[-1:] and self.wrenches[-1].header.stamp, last)


def bags(directory):
    """Closed ones, in order of writing."""
    return sorted(glob.glob(os.path.join(directory, '*.bag')), key=lambda path: os.stat(path).st_mtime_ns)


def active_bags(directory):
    return glob.glob(os.path.join(directory, '*.bag.active'))


def closed_bags(directory, count):
    """Closed bags, once there are this many and none is being written; else those at the deadline."""
    eventually(lambda: len(bags(directory)) == count and not active_bags(directory))
    return bags(directory)


def entries(path, *topics):
    """(topic, record time [ns], serialised message), in time order."""
    with rosbag.Bag(path) as bag:
        return [(topic, time.to_nsec(), raw[1]) for topic, raw, time in bag.read_messages(topics or None, raw=True)]


def messages(path, topic):
    with rosbag.Bag(path) as bag:
        return [message for _, message, _ in bag.read_messages(topic)]


def topics_in(path):
    with rosbag.Bag(path) as bag:
        return set(bag.get_type_and_topic_info().topics)


def process_again(path, session):
    """process_bag over a log of the node, with the parameters in force then."""
    info = messages(path, session.node + '/run_info')[0]
    files = {'.yaml': info.parameters_yaml, '.urdf': info.robot_description}
    for ending, text in files.items():
        with open(path + ending, 'w') as file:
            file.write(text)
    arguments = [command('process_bag'), path, path + '.again', '--params', path + '.yaml', '--crank-topic',
                 session.crank_topic, '--joint-states-topic', session.joint_topic, '--output-prefix', session.node]
    subprocess.run(arguments + (['--urdf', path + '.urdf'] if info.robot_description else []), check=True)
    return path + '.again'


def expect_reproduced(test, path, session):
    """Every logged output again, bit for bit, at its record time. The topics it has."""
    logged = sorted(entries(path, *(topic for topic in topics_in(path) if topic.startswith(session.node + '/'))))
    again = sorted(entries(process_again(path, session), *{topic for topic, _, _ in logged}))
    test.assertEqual([(topic, time) for topic, time, _ in logged], [(topic, time) for topic, time, _ in again])
    test.assertTrue(logged == again, path)
    return {topic for topic, _, _ in logged}
