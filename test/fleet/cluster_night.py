"""The fleet over a real Slurm and into a real PostgreSQL: 200 bags, two jobs killed, one bag broken, three changed.

HAMMER_LOADS_PROGRAMS: folder of the built process_bag and report.
"""
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag

from cluster import Postgres, Slurm
from fleet_support import FLEET, SOURCE

RECORDED = SOURCE / "test" / "data" / "mo100_100hz.bag"
BAGS, MACHINES, SECONDS, BROKEN = 200, 5, 6.0, 77


def copy_of(bag, shift_s):
    """Some seconds of the recorded session, later by some time: a recording of its own."""
    import genpy
    shift, begin = genpy.Duration.from_sec(shift_s), None
    with rosbag.Bag(str(RECORDED)) as source, rosbag.Bag(str(bag), "w") as copy:
        for topic, message, stamp in source.read_messages():
            begin = begin or stamp
            if (stamp - begin).to_sec() > SECONDS:
                break
            if hasattr(message, "header"):
                message.header.stamp += shift
            copy.write(topic, message, stamp + shift)


class Cluster(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = pathlib.Path(tempfile.mkdtemp(prefix="fleet", dir="/tmp"))
        cls.directory.chmod(0o755)
        cls.addClassCleanup(shutil.rmtree, str(cls.directory), ignore_errors=True)
        cls.slurm = Slurm(cls.directory / "s")
        cls.addClassCleanup(cls.slurm.stop)
        cls.postgres = Postgres(cls.directory / "p")
        cls.addClassCleanup(cls.postgres.stop)
        cls.bags = cls.directory / "bags"
        for i in range(BAGS):
            (cls.bags / f"machine{i % MACHINES}").mkdir(parents=True, exist_ok=True)
            copy_of(cls.bag(i), 100.0 * i)
        broken = cls.bag(BROKEN)
        broken.write_bytes(broken.read_bytes()[:5000])

    @classmethod
    def bag(cls, i):
        return cls.bags / f"machine{i % MACHINES}" / f"{i:03d}.bag"

    def start(self, out, *config):
        log = open(self.directory / "snakemake.log", "w")
        self.addCleanup(log.close)
        return subprocess.Popen(
            [sys.executable, "-m", "snakemake", "-s", str(FLEET / "Snakefile"), "--profile", str(FLEET / "slurm"),
             "--nocolor", "--directory", str(self.directory), "--config", f"bags={self.bags}", f"out={out}", *config],
            stdout=log, stderr=subprocess.STDOUT, env=self.slurm.environment)

    def end(self, running):
        code = running.wait(timeout=1200)
        text = (self.directory / "snakemake.log").read_text()
        self.assertEqual(code, 0, text[-6000:])
        return text

    def jobs_of_bags(self, text):
        """Bags that Snakemake was to run."""
        return int(re.search(r"^bag +(\d+)", text, re.M).group(1))

    def kill_two(self):
        """Two jobs at work, with SIGKILL: nothing of them can say so."""
        killed, deadline = set(), time.monotonic() + 300.0
        while len(killed) < 2:
            self.assertLess(time.monotonic(), deadline, "no job to kill")
            for job in self.slurm.ask("squeue", "-h", "-t", "RUNNING", "-o", "%A").split():
                if job not in killed and len(killed) < 2:
                    self.slurm.ask("scancel", "--signal=KILL", "--full", job)
                    killed.add(job)
            time.sleep(0.5)

    def ask(self, out, sql):
        db = sqlite3.connect(str(out / "merged.sqlite"))
        rows = db.execute(sql).fetchall()
        db.close()
        return rows

    def test_jobs_survive_a_working_day(self):
        out = self.directory / "out"
        running = self.start(out)
        self.kill_two()
        text = self.end(running)
        self.assertEqual(self.jobs_of_bags(text), BAGS)
        self.assertGreaterEqual(text.count("Trying to restart job"), 2)
        self.assertLess(len(set(re.findall(r"external jobid '(\d+)'", text))), BAGS / 2)  # several bags a job
        self.assertEqual(dict(self.ask(out, "SELECT status, count(*) FROM bags GROUP BY status")),
                         {"done": BAGS - 1, "failed": 1})
        self.assertTrue(self.ask(out, "SELECT reason FROM bags WHERE status = 'failed'")[0][0])
        self.assertEqual(self.ask(out, "SELECT count(*) FROM runs"), [(BAGS - 1,)])
        self.assertEqual(len(list((out / "pages").glob("*.html"))), MACHINES + 1)

        changed = (3, 50, BROKEN)
        for i in changed:
            copy_of(self.bag(i), 100.0 * i + 40.0)
        text = self.end(self.start(out))
        self.assertEqual(self.jobs_of_bags(text), len(changed))
        self.assertEqual(self.ask(out, "SELECT status, count(*) FROM bags GROUP BY status"), [("done", BAGS)])
        self.check_postgres(out)

    def check_postgres(self, out):
        """Two loaders at once, half of the bags each, give the figures of the file."""
        outcomes = sorted(str(path) for path in (out / "bags").glob("*.json"))
        halves = [subprocess.Popen([sys.executable, str(FLEET / "merge.py"), self.postgres.url], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, universal_newlines=True) for _ in range(2)]
        for at, half in enumerate(halves):
            half.stdin.write("".join(path + "\n" for path in outcomes[at::2]))
            half.stdin.close()
        for half in halves:
            self.assertEqual(half.wait(timeout=300), 0)
            half.stdout.close()
        for query in sorted(path.stem for path in FLEET.glob("queries/*.sql")):
            answers = []
            for target in (self.postgres.url, str(out / "merged.sqlite")):
                done = subprocess.run([sys.executable, str(FLEET / "query"), query, target], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""), query)
                answers.append([line.split() for line in done.stdout.lower().splitlines()])
            self.assertEqual(*answers, query)


if __name__ == "__main__":
    unittest.main()
