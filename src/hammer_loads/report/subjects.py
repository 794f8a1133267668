"""Machines of a page: each with its runs in one file, in the order of time. A database holds no path: names are those of the
given files."""
from collections import Counter, defaultdict
import itertools
import pathlib
import re

from report.cycles import Channel, channels_of
from report.database import FLEET, LEDGER, RECORDING, Problem

MOST_TURNS_ONE_BY_ONE = 500000  # beyond: a run is a point, where the file has figures of runs


def stem(path):
    return pathlib.Path(path).stem


class Subject:
    def __init__(self, database, label, runs):
        self.database, self.label, self.runs = database, label, runs
        self.first_ns = min(self._known("first_stamp_ns"), default=None)
        self.last_ns = max(self._known("last_stamp_ns"), default=None)
        self.hours = self.total("duration") / 3600.0

    def _known(self, name):
        return [run[name] for run in self.runs if run[name] is not None]

    def total(self, name):
        return sum(self._known(name))

    def worst(self, name):
        """The value of the runs that is farthest from 0; None where none has one."""
        return max(self._known(name), key=abs, default=None)

    def recordings(self):
        """Names of the runs' recordings; several runs of one name are numbered, bags of one name have their folder."""
        bags = [run.get("bag", self.database.path) for run in self.runs]
        short = Counter(map(stem, set(bags)))
        names = [stem(bag) if short[stem(bag)] == 1 else str(pathlib.PurePath(bag).with_suffix("")) for bag in bags]
        count, numbers = Counter(names), defaultdict(itertools.count)
        return [f"{name}, run {next(numbers[name]) + 1}" if count[name] > 1 else name for name in names]

    def frame(self, sql, *values, text=()):
        """Rows of all runs in their order. sql: from the columns on, {runs} is its condition for the runs; `run` is added:
        the place of the run. Columns but those of text are numbers."""
        places = {run["run_id"]: place for place, run in enumerate(self.runs)}
        runs = f"run_id IN ({', '.join(str(int(run_id)) for run_id in places)})"
        rows = self.database.frame("SELECT run_id AS run, " + sql.format(runs=runs), *values)
        rows["run"] = rows.run.map(places)
        return rows.astype({name: float for name in rows if name not in ("run", *text)}).sort_values("run", kind="mergesort")

    def has_rows(self, table):
        """Returns True if values are those of revolutions; else of runs, as in a merged file."""
        if self.database.kind == RECORDING:
            return True
        return (table in self.database.tables() and self.total("turns") <= MOST_TURNS_ONE_BY_ONE
                and not self.frame(f"turn FROM {table} WHERE {{runs}} LIMIT 1").empty)

    def blows_without_energy(self):
        """Blows whose energy and restitution are withheld, since no value within their bounds fits: in no figure."""
        return len(self.frame("turn FROM blows WHERE {runs} AND energy IS NULL")) if self.has_rows("blows") else 0

    def failed_bags(self):
        """(bag, reason) of a merged file's bags that gave nothing."""
        if self.database.kind != FLEET:
            return []
        return list(self.database.rows(
            "SELECT bag, reason FROM bags WHERE machine = ? AND status <> 'done' ORDER BY bag", self.label))

    def counted_channels(self):
        """Channels with their cycles over all runs; a merged file has the sums of each machine already."""
        if self.database.kind == FLEET:
            return list(self._sums())
        return list(channels_of(self.database, "r.machine = ?", self.runs[0]["machine"])) if self.runs else []

    def _sums(self):
        rows = self.database.rows
        for row in self.database.records("SELECT * FROM machine_channels WHERE machine = ? ORDER BY machine_channel", self.label):
            at = row["machine_channel"]
            yield Channel(row, rows("SELECT steps, low, count FROM machine_cycles WHERE machine_channel = ?", at),
                          rows("SELECT class FROM machine_residues WHERE machine_channel = ? ORDER BY place", at))


def by_number(name):
    """Machine 2 before machine 10."""
    return [(int(part), "") if part.isdigit() else (0, part) for part in re.split(r"([0-9]+)", name)]


def fleet_subjects(database, only_machine):
    """Every machine that has a bag, also one whose bags all failed."""
    names = sorted((name for name, in database.rows("SELECT DISTINCT machine FROM bags")), key=by_number)
    if only_machine is not None and only_machine not in names:
        raise Problem(f"{database.path}: --machine {only_machine}: no bag of it")
    sql = "SELECT runs.*, bag FROM runs JOIN bags USING(bag_id) WHERE bags.machine = ? ORDER BY first_stamp_ns, run_key"
    return [Subject(database, name, database.records(sql, name)) for name in names if only_machine in (None, name)]


def subjects_of(database, only_machine=None):
    """A recording's machines, a merged file's machines; ledgers have none."""
    if database.kind == LEDGER:
        return []
    if database.kind == FLEET:
        return fleet_subjects(database, only_machine)
    if only_machine is not None:
        raise Problem(f"{database.path}: --machine is for merged files, this is a recording of one bag")
    runs, name = database.records("SELECT * FROM runs ORDER BY first_stamp_ns, run_id"), stem(database.path)
    machines = list(dict.fromkeys(run["machine"] for run in runs)) or [None]
    return [Subject(database, name if len(machines) == 1 else f"{name}, machine {at}",
                    [run for run in runs if run["machine"] == machine]) for at, machine in enumerate(machines, 1)]


def mixed_machines(subjects):
    """Lines for recordings with more than one machine: their cycles are never added."""
    counts = Counter(subject.database for subject in subjects if subject.database.kind == RECORDING)
    return [f"{stem(database.path)}: holds {count} machines (hammer, boom or their parameters differ); each stands alone"
            for database, count in counts.items() if count > 1]


def notes(databases):
    """Notes for the user of the command, one line each."""
    subjects = list(itertools.chain.from_iterable(map(subjects_of, databases)))
    return mixed_machines(subjects) + [f"{s.label}: {'no whole revolution' if s.runs else 'no run at all'}"
                                       for s in subjects if not s.total("turns")]
