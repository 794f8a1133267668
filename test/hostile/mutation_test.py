"""Mutated inputs of every command: it ends in time by itself, says why in lines, and writes nothing beside its output.

HAMMER_LOADS_MUTATIONS: how many in all; HAMMER_LOADS_SEED: others. The parsers alone, with sanitizers: test/fuzz.
"""
import os
import pathlib
import random
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ.get("HAMMER_LOADS_PROGRAMS", SOURCE / "build" / "devel" / "lib" / "hammer_loads"))
MUTATIONS = int(os.environ.get("HAMMER_LOADS_MUTATIONS", "70"))
SEED = int(os.environ.get("HAMMER_LOADS_SEED", "1"))
LONGEST_S = 60  # some hundred times what a good input takes
MOST_MEMORY_KB = 1000000
NUMBERS = ["1e-12", "1e300", "-1e300", "1e9", "-1", "0", "nan", ".inf", "1e999", "9223372036854775808", "4294967296", "",
           "=1+1", "[1, 2]", "{a: b}", "text", "0x10", "1e-300", "true"]
BAG = SOURCE / "test" / "data" / "mo100_100hz.bag"
STATES = ("crank_angle_rad,crank_speed_rad_s,crank_accel_rad_s2,hull_pitch_rad,gravity_m_s2\n" +
          "".join(f"{0.1 * i},30,{i - 30},0.1,9.81\n" for i in range(60)))
SERIES = "".join(f"{(i * 7919) % 1009 - 500}\n" for i in range(300))


def run(arguments, stdin=None, folder=None):
    limited = ["bash", "-c", f'ulimit -v {4 * MOST_MEMORY_KB}; exec "$0" "$@"', *map(str, arguments)]
    return subprocess.run(limited, stdin=stdin or subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=LONGEST_S, cwd=str(folder))


def mutated_bytes(draw, data):
    data = bytearray(data)
    for _ in range(draw.choice((1, 3, 10, 50))):
        at, length = draw.randrange(len(data)), draw.choice((1, 4, 8))
        data[at:at + length] = draw.choice((bytes(length), b"\xff" * length, bytes(draw.randrange(256) for _ in range(length))))
    if draw.random() < 0.2:
        del data[draw.randrange(len(data)):]
    return bytes(data)


def mutated_text(draw, text, separator):
    """Fields become odd ones; lines are lost, doubled or damaged."""
    lines = text.splitlines(keepends=True)
    for _ in range(draw.choice((1, 1, 3, 10))):
        at = draw.randrange(len(lines))
        kind = draw.randrange(6)
        if kind < 3:
            fields = lines[at].rstrip("\n").split(separator)
            fields[draw.randrange(len(fields)) if separator == "," else -1] = draw.choice(NUMBERS)
            lines[at] = separator.join(fields) + "\n"
        elif kind == 3:
            del lines[at:at + draw.choice((1, 5))]
        elif kind == 4:
            lines.insert(at, lines[draw.randrange(len(lines))])
        if not lines:
            lines = ["\n"]
    data = "".join(lines).encode()
    return mutated_bytes(draw, data) if draw.random() < 0.2 else data


class Mutations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, str(cls.home))
        for option in ("--db", "--ledger"):
            done = run([PROGRAMS / "process_bag", "--no-bag", BAG, option, cls.home / (option[2:] + ".sqlite")], folder=cls.home)
            assert done.returncode == 0, done.stderr
        cls.good = {name: (cls.home / f"{name}.sqlite").read_bytes() for name in ("db", "ledger")}
        cls.good["bag"] = BAG.read_bytes()
        cls.yaml = "".join((SOURCE / "config" / f"{name}.yaml").read_text() for name in ("hammer_mo100", "pipeline", "life"))
        cls.good["yaml"] = "".join(line for line in cls.yaml.splitlines(keepends=True) if line[0] not in "#\n").encode()
        cls.good["states"], cls.good["series"] = STATES.encode(), SERIES.encode()

    def write(self, name, data):
        path = self.home / name
        path.write_bytes(data)
        return path

    def mutated(self, draw, kind):
        data = self.good[kind]
        if kind == "yaml":
            return mutated_text(draw, data.decode(), ":")
        if kind in ("states", "series"):
            return mutated_text(draw, data.decode(), ",")
        return mutated_bytes(draw, data)

    def command(self, kind, folder, file):
        """(arguments, what stdin is, names of outputs)"""
        if kind == "bag":
            return [PROGRAMS / "process_bag", file, folder / "out.bag"], None, {"out.bag"}
        if kind == "yaml":
            return [PROGRAMS / "process_bag", "--no-bag", BAG, "--db", folder / "out.sqlite", "--params", file], None, {"out.sqlite"}
        if kind == "ledger":
            return [PROGRAMS / "life", file, "--json"], None, set()
        if kind == "db":
            return [PROGRAMS / "report", file, "--csv", folder / "csv"], None, {"csv"}
        if kind == "states":
            return [PROGRAMS / "evaluate"], file, set()
        return [PROGRAMS / "count_cycles", "--exact"], file, set()

    def outcome(self, kind, data):
        """Exit code of the command on these bytes."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=str(self.home)))
        file = folder / f"in.{ {'db': 'sqlite', 'ledger': 'sqlite'}.get(kind, kind) }"
        file.write_bytes(data)
        arguments, stdin, outputs = self.command(kind, folder, file)
        with open(stdin or os.devnull, "rb") as given:
            done = run(arguments, given, folder)
        said = done.stderr.decode("utf-8", "replace")
        self.assertIn(done.returncode, (0, 1, 2), f"{kind}: {said[-2000:]}")
        for word in ("Traceback", "terminate called", "Sanitizer", "runtime error"):
            self.assertNotIn(word, said)
        self.assertFalse([c for c in said if ord(c) < 32 and c not in "\n\t"], f"{kind}: {said!r}")
        if done.returncode != 0:
            self.assertTrue(said.strip(), kind)
        left = set(os.listdir(folder)) - {file.name}
        self.assertLessEqual(left, outputs if done.returncode == 0 else set(), f"{kind}: {said}")
        if kind != "ledger":
            self.assertEqual(file.read_bytes(), data, "an input was changed")
        shutil.rmtree(str(folder))
        return done.returncode

    def test_mutations_of_each_kind_are_survived(self):
        kinds = ["bag", "yaml", "ledger", "db", "states", "series"]
        draw, before, problems = random.Random(SEED), None, []
        for kind in kinds:
            self.assertEqual(self.outcome(kind, self.good[kind]), 0, f"{kind}: the good one")
            before = before or sorted(p.name for p in self.home.iterdir())
        ends, there = {kind: set() for kind in kinds}, set(self.home.iterdir())
        for i in range(MUTATIONS):
            kind = kinds[i % len(kinds)]
            data = self.mutated(draw, kind)
            try:
                ends[kind].add(self.outcome(kind, data))
            except (AssertionError, subprocess.TimeoutExpired) as error:
                kept = pathlib.Path(tempfile.gettempdir()) / f"mutation_{SEED}_{i}.{kind}"
                kept.write_bytes(data)
                problems.append(f"{kept}: {error}"[:600])
                for left in set(self.home.iterdir()) - there:
                    shutil.rmtree(str(left))
        self.assertEqual(problems, [])
        self.assertEqual(sorted(p.name for p in self.home.iterdir()), before)
        for kind in kinds:
            self.assertTrue(ends[kind], kind)


if __name__ == "__main__":
    unittest.main()
