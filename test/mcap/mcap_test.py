"""Every message of a log against what the official reader finds in the MCAP made of it. Needs node, npm and, for the first
time, network: without them it fails. Only a node that is too old for that reader (Debian 11) makes it skip."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import genpy
import rosbag

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"])
SESSION = HERE.parent / "data" / "mo100_100hz.bag"


def run(*command, **options):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, **options)


def node_version():
    return int(run("node", "--version").stdout.lstrip("v").split(".")[0])


def plain(value):
    if isinstance(value, genpy.Message):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"sec": value.secs, "nsec": value.nsecs}
    if isinstance(value, (list, tuple, bytes)):
        return [plain(one) for one in value]
    if isinstance(value, int) and abs(value) >= 2**53:
        return str(value)  # as read.js
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    return value


def key(row):
    return int(row[1]), row[0]


class Mcap(unittest.TestCase):
    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.directory)
        self.mcap = self.directory / "out.mcap"

    @unittest.skipIf(node_version() < 14, "the official reader is written for node 14 and later")
    def test_every_message_by_the_official_reader(self):
        for name in ("package.json", "package-lock.json", "read.js"):
            shutil.copy(HERE / name, self.directory)
        installed = run("npm", "ci", "--no-audit", "--no-fund", cwd=self.directory)
        self.assertEqual(installed.returncode, 0, installed.stderr)
        log = self.directory / "log.bag"
        made = run(PROGRAMS / "process_bag", SESSION, log)
        self.assertEqual(made.returncode, 0, made.stderr)
        made = run(PROGRAMS / "to_mcap", log, self.mcap)
        self.assertEqual(made.returncode, 0, made.stderr)
        read = run("node", "read.js", self.mcap, cwd=self.directory)
        self.assertEqual(read.returncode, 0, read.stderr)
        head, *rows = [json.loads(line) for line in read.stdout.splitlines()]
        with rosbag.Bag(str(log)) as bag:
            expected = [[topic, str(time.to_nsec()), plain(message)] for topic, message, time in bag.read_messages()]
            connections = {c.topic: (c.datatype, c.md5sum, c.header.get("latching") in ("1", b"1"))
                           for c in bag._get_connections()}
        self.assertGreater(len(expected), 1000)
        self.assertEqual((head["profile"], head["streamed"], head["messages"], head["complete"]),
                         ("ros1", len(expected), str(len(expected)), True))
        self.assertTrue(sorted(rows, key=key) == sorted(expected, key=key))
        self.assertEqual({c["topic"]: (c["type"], c["metadata"]["md5sum"], c["metadata"].get("latching") == "true")
                          for c in head["channels"]}, connections)
        self.assertEqual({tuple(c["encodings"]) for c in head["channels"]}, {("ros1", "ros1msg")})
        self.assertTrue(any(latched for _, _, latched in connections.values()))

    def test_overwriting(self):
        command = PROGRAMS / "to_mcap", SESSION, self.mcap
        self.assertEqual(run(*command).returncode, 0)
        self.assertIn("exists already", run(*command).stderr)
        self.assertEqual(run(*command, "--force").returncode, 0)
        self.mcap.write_text("notes")
        self.assertIn("no MCAP of this command", run(*command, "--force").stderr)
        self.assertEqual(self.mcap.read_text(), "notes")


if __name__ == "__main__":
    unittest.main()
