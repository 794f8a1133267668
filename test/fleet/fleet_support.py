"""Bags of text, the fake process_bag, Snakemake; outcomes of bags, merged."""
import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
FLEET = SOURCE / "fleet"
sys.path[:0] = [str(HERE.parent / "report"), str(FLEET), str(SOURCE / "src" / "hammer_loads")]
import sample_database as sample  # noqa: E402  (the path must be set first)


def link_programs(folder):
    """The fake process_bag and the real report."""
    folder.mkdir()
    (folder / "process_bag").symlink_to(HERE / "fake_process_bag.py")
    (folder / "report").symlink_to(SOURCE / "src" / "hammer_loads" / "commands" / "report_main.py")
    return folder


class FleetTest(unittest.TestCase):
    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, str(self.directory))
        self.programs = link_programs(self.directory / "programs")
        self.out = self.directory / "out"

    def calls(self):
        """Bags that ran since the last time this was asked."""
        path = self.programs / "calls.txt"
        lines = path.read_text().split() if path.exists() else []
        path.write_text("")
        return sorted(lines)

    def snakemake(self, bags, *options, config=()):
        environment = dict(os.environ, HAMMER_LOADS_PROGRAMS=str(self.programs), PYTHONDONTWRITEBYTECODE="1",
                           XDG_CACHE_HOME=str(self.directory / "cache"), HOME=str(self.directory))
        return subprocess.run(
            [sys.executable, "-m", "snakemake", "-s", str(FLEET / "Snakefile"), "--cores", "2", "--nocolor",
             "--directory", str(self.directory), *options, "--config", f"bags={bags}", f"out={self.out}", *config],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, env=environment)

    def run_fleet(self, bags, *options, config=()):
        done = self.snakemake(bags, *options, config=config)
        self.assertEqual(done.returncode, 0, done.stdout[-4000:])
        return done.stdout


class MergeTest(FleetTest):
    """Outcomes of bags, merged."""

    def add(self, name, machine="red", status="done", seconds=40.0, first=0, seed=1, reason="is no bag", **options):
        """An outcome, with its database."""
        folder = self.directory / "bags"
        folder.mkdir(exist_ok=True)
        outcome = {"machine": machine, "bag": f"/in/{name}.bag", "input_sha256": f"{name}{seed}{first}",
                   "parameters_sha256": "p", "status": status, "reason": None if status == "done" else reason}
        if status == "done":
            sample.make(folder / (name + ".sqlite"), options.pop("of", sample.Machine(machine)), seconds=seconds,
                        first_ns=(1700000000 + first) * 10**9, seed=seed, boom=False, classes=64, **options)
        path = folder / (name + ".json")
        path.write_text(json.dumps(outcome))
        return path

    def merge(self, *outcomes, target="merged.sqlite", options=()):
        done = subprocess.run([sys.executable, str(FLEET / "merge.py"), str(self.directory / target), *options],
                              input="".join(f"{path}\n" for path in outcomes), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.split(": ")[-1].strip()

    def ask(self, sql, target="merged.sqlite"):
        db = sqlite3.connect(str(self.directory / target))
        rows = db.execute(sql).fetchall()
        db.close()
        return rows
