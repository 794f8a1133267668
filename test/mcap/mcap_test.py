"""Every message of a log against what an independent reader finds in the MCAP made of it."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import rosbag

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from mcap_reader import Mcap  # noqa: E402

PROGRAMS = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"])
SESSION = HERE.parent / "data" / "mo100_100hz.bag"


def run(*command):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True)


class McapTest(unittest.TestCase):
    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.directory)
        self.mcap = self.directory / "out.mcap"

    def test_holds_every_message_of_the_bag(self):
        log = self.directory / "log.bag"
        for made in (run(PROGRAMS / "process_bag", SESSION, log), run(PROGRAMS / "to_mcap", log, self.mcap)):
            self.assertEqual(made.returncode, 0, made.stderr)
        read = Mcap(self.mcap)
        with rosbag.Bag(str(log)) as bag:
            expected = [(topic, time.to_nsec(), raw[1]) for topic, raw, time in bag.read_messages(raw=True)]
            connections = {c.topic: (c.datatype, c.msg_def, c.md5sum, c.header.get("latching") in ("1", b"1"))
                           for c in bag._get_connections()}
        self.assertGreater(len(expected), 1000)
        self.assertEqual(read.profile, "ros1")
        found = [(read.channels[channel][1], time, content) for channel, time, content in read.messages]
        self.assertTrue(sorted(found) == sorted(expected))
        channels = {}
        for schema, topic, encoding, metadata in read.channels.values():
            kind, schema_encoding, definition = read.schemas[schema]
            self.assertEqual((encoding, schema_encoding), ("ros1", "ros1msg"))
            channels[topic] = kind, definition, metadata["md5sum"], metadata.get("latching") == "true"
        self.assertEqual(channels, connections)
        self.assertTrue(any(connection[-1] for connection in connections.values()))

    def test_states_what_it_holds(self):
        self.assertEqual(run(PROGRAMS / "to_mcap", SESSION, self.mcap).returncode, 0)
        read = Mcap(self.mcap)
        times = [time for _, time, _ in read.messages]
        self.assertEqual(read.statistics, [len(times), len(read.schemas), len(read.channels), 0, 0, len(read.chunks),
                                           min(times), max(times)])
        self.assertEqual(sum(read.counts.values()), len(times))

    def test_overwrites_only_what_it_wrote(self):
        command = PROGRAMS / "to_mcap", SESSION, self.mcap
        self.assertEqual(run(*command).returncode, 0)
        self.assertIn("exists already", run(*command).stderr)
        self.assertEqual(run(*command, "--force").returncode, 0)
        self.mcap.write_text("notes")
        self.assertIn("no MCAP of this command", run(*command, "--force").stderr)
        self.assertEqual(self.mcap.read_text(), "notes")


if __name__ == "__main__":
    unittest.main()
