"""Machines of a page: each with its runs in one file, in the order of time. A database holds no path: names are those of the
given files."""
from collections import Counter
import itertools
import pathlib
import re

from report.cycles import Channel
from report.database import FLEET, LEDGER, RECORDING, Problem

MOST_TURNS_ONE_BY_ONE = 500000  # beyond: a run is a point, where the file has figures of runs


def stem(path):
    return pathlib.Path(path).stem


class Subject:
    def __init__(self, database, label, runs):
        self.database, self.label, self.runs = database, label, runs

    @property
    def first_ns(self):
        return min((r["first_stamp_ns"] for r in self.runs if r["first_stamp_ns"] is not None), default=None)

    @property
    def last_ns(self):
        return max((r["last_stamp_ns"] for r in self.runs if r["last_stamp_ns"] is not None), default=None)

    @property
    def hours(self):
        return self.total("duration") / 3600.0

    def total(self, name):
        return sum(run[name] or 0 for run in self.runs)

    def worst(self, name):
        """The value of the runs that is farthest from 0; None where none has one."""
        return max((run[name] for run in self.runs if run[name] is not None), key=abs, default=None)

    def recordings(self):
        """{run_id: name of the recording}; several runs of one name are numbered, bags of one name have their folder."""
        if self.database.kind == FLEET:
            bags = dict(self.database.rows("SELECT bag_id, bag FROM bags ORDER BY bag_id"))
            short = Counter(map(stem, bags.values()))
            names = {at: stem(bag) if short[stem(bag)] == 1 else str(pathlib.PurePath(bag).with_suffix(""))
                     for at, bag in bags.items()}
            named = [(run["run_id"], names.get(run["bag_id"], "?")) for run in self.runs]
        else:
            named = [(run["run_id"], stem(self.database.path)) for run in self.runs]
        count, seen, result = Counter(name for _, name in named), Counter(), {}
        for run_id, name in named:
            seen[name] += 1
            result[run_id] = f"{name}, run {seen[name]}" if count[name] > 1 else name
        return result

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
        tables = self.database.tables()
        if "run_figures" not in tables:
            return True
        return table in tables and self.total("turns") <= MOST_TURNS_ONE_BY_ONE and any(
            self.database.value(f"SELECT 1 FROM {table} WHERE run_id = ? LIMIT 1", run["run_id"]) for run in self.runs)

    def blows_without_energy(self):
        """Blows whose energy and restitution are withheld, since no value within their bounds fits: in no figure."""
        return len(self.frame("turn FROM blows WHERE {runs} AND energy IS NULL")) if self.has_rows("blows") else 0

    def failed_bags(self):
        """(bag, reason) of a merged file's bags that gave nothing."""
        if self.database.kind != FLEET:
            return []
        return list(self.database.rows(
            "SELECT bag, reason FROM bags WHERE machine = ? AND status <> 'done' ORDER BY bag", self.label))

    def pieces(self, name=None):
        """(run, Channel) of each counted channel of each run, or of the one with this name."""
        for run in self.runs:
            for row in self.database.records("SELECT * FROM channels WHERE run_id = ? AND counted AND name = coalesce(?, name) "
                                             "ORDER BY channel", run["run_id"], name):
                channel = Channel(row, run["equivalent_cycles_per_hour"])
                channel.add(row, (run["duration"] or 0.0) / 3600.0)
                read_cycles(channel, self.database, "", "run_id = ? AND channel = ?", run["run_id"], row["channel"])
                yield run, channel

    def counted_channels(self):
        """Channels with their cycles over all runs: pieces add exactly. A changed grid begins another channel."""
        if self.database.kind == FLEET:
            return list(self._sums())
        channels = {}
        for _, piece in self.pieces():
            key = (piece.name, *piece.count.grid)
            if key in channels:
                channels[key].join(piece)
            else:
                channels[key] = piece
        return list(channels.values())

    def _sums(self):
        """Channels of a merged file, which has the sums of each machine already."""
        per_hour = max((run["equivalent_cycles_per_hour"] or 0.0 for run in self.runs), default=0.0)
        for row in self.database.records("SELECT * FROM machine_channels WHERE machine = ? ORDER BY machine_channel", self.label):
            channel = Channel(row, per_hour)
            channel.add(row, row["hours"])
            read_cycles(channel, self.database, "machine_", "machine_channel = ?", row["machine_channel"])
            yield channel


def read_cycles(channel, database, prefix, condition, *place):
    """Adds the cycles and the residue in the tables with this prefix."""
    channel.count.add_closed(database.rows(f"SELECT steps, low, count FROM {prefix}cycles WHERE {condition}", *place))
    channel.count.join(c for c, in database.rows(
        f"SELECT class FROM {prefix}residues WHERE {condition} ORDER BY place", *place))


def by_number(name):
    """Machine 2 before machine 10."""
    return [(int(part), "") if part.isdigit() else (0, part) for part in re.split(r"([0-9]+)", name)]


def grouped(runs, key):
    """{value of the key: its runs}."""
    groups = {}
    for run in runs:
        groups.setdefault(run[key], []).append(run)
    return groups


def fleet_subjects(database, only_machine):
    """Every machine that has a bag, also one whose bags all failed."""
    names = [name for name, in database.rows("SELECT DISTINCT machine FROM bags")]
    if only_machine is not None and only_machine not in names:
        raise Problem(f"{database.path}: --machine {only_machine}: no bag of it")
    runs = grouped(database.records("SELECT runs.*, bags.machine AS owner FROM runs JOIN bags USING(bag_id) "
                                    "ORDER BY first_stamp_ns, run_key"), "owner")
    return [Subject(database, name, runs.get(name, [])) for name in sorted(names, key=by_number)
            if only_machine in (None, name)]


def subjects_of(database, only_machine=None):
    """A recording's machines, a merged file's machines; ledgers have none."""
    if database.kind == LEDGER:
        return []
    if database.kind == FLEET:
        return fleet_subjects(database, only_machine)
    if only_machine is not None:
        raise Problem(f"{database.path}: --machine is for merged files, this is a recording of one bag")
    groups = grouped(database.records("SELECT * FROM runs ORDER BY first_stamp_ns, run_id"), "machine") or {None: []}
    name = stem(database.path)
    return [Subject(database, name if len(groups) == 1 else f"{name}, machine {at}", runs)
            for at, runs in enumerate(groups.values(), 1)]


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
