"""Bags of text, the fake process_bag, Snakemake; outcomes of bags, merged."""
import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
FLEET = SOURCE / "fleet"
sys.path[:0] = [str(HERE.parent / "report"), str(FLEET), str(SOURCE / "src" / "hammer_loads")]
import sample_database as sample  # noqa: E402  (the path must be set first)
from support import Reader, execute, report_here  # noqa: E402

REPORT = SOURCE / "src" / "hammer_loads" / "commands" / "report_main.py"
FAKE = HERE / "fake_process_bag.py"


class Fleet:
    """A run of the workflow in a folder, with a fake process_bag; a fake report as well, unless it is real."""

    def __init__(self, directory):
        self.directory, self.out, self.programs = directory, directory / "out", directory / "programs"
        self.programs.mkdir()
        for name in ("process_bag", "report"):
            (self.programs / name).symlink_to(FAKE)

    def use_real_report(self):
        (self.programs / "report").unlink()
        (self.programs / "report").symlink_to(REPORT)

    def calls(self):
        """Bags that ran since the last time this was asked."""
        path = self.programs / "calls.txt"
        lines = path.read_text().split() if path.exists() else []
        path.write_text("")
        return sorted(lines)

    def snakemake(self, bags, config=()):
        environment = dict(os.environ, HAMMER_LOADS_PROGRAMS=str(self.programs), PYTHONDONTWRITEBYTECODE="1",
                           XDG_CACHE_HOME=str(self.directory / "cache"), HOME=str(self.directory))
        return subprocess.run(
            [sys.executable, "-m", "snakemake", "-s", str(FLEET / "Snakefile"), "--cores", "2", "--nocolor",
             "--directory", str(self.directory), "--config", f"bags={bags}", f"out={self.out}", *config],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, env=environment)

    def run(self, bags, config=()):
        done = self.snakemake(bags, config)
        assert done.returncode == 0, done.stdout[-4000:]
        return done.stdout

    def bags(self):
        """{file name: (status, reason)} in the merged file."""
        rows = execute(self.out / "merged.sqlite", "SELECT bag, status, reason FROM bags")
        return {bag.rsplit("/", 1)[1]: (status, reason) for bag, status, reason in rows}


class Merged:
    """Outcomes of bags, merged in a folder."""

    def __init__(self, directory):
        self.directory, self.path = directory, directory / "merged.sqlite"
        (directory / "bags").mkdir()

    def add(self, name, machine="red", status="done", seconds=40.0, first=0, seed=1, reason="is no bag", sql=(), **options):
        """An outcome, with its database, to which the SQL is done."""
        path = self.directory / "bags" / (name + ".sqlite")
        outcome = {"machine": machine, "bag": f"/in/{name}.bag", "input_sha256": f"{name}{seed}{first}",
                   "parameters_sha256": "p", "status": status, "reason": None if status == "done" else reason}
        if status == "done":
            sample.make(path, options.pop("of", sample.Machine(machine)), seconds=seconds,
                        first_ns=(1700000000 + first) * 10**9, seed=seed, boom=False, classes=64, **options)
        if sql:
            execute(path, *sql)
        path.with_suffix(".json").write_text(json.dumps(outcome))
        return path.with_suffix(".json")

    def merge(self, *outcomes, target="merged.sqlite"):
        done = subprocess.run([sys.executable, str(FLEET / "merge.py"), str(self.directory / target)],
                              input="".join(f"{path}\n" for path in outcomes), capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout.split(": ")[-1].strip()

    def ask(self, sql, target="merged.sqlite"):
        return execute(self.directory / target, sql)

    def page(self, *options):
        out = self.directory / "page.html"
        done = report_here(self.path, "--html", out, "--force", *options)
        assert done.returncode == 0, done.stderr
        return Reader(out.read_text(encoding="utf-8"))
