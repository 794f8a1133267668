"""Machines of a page: each with its runs in one file, in the order of time."""
import re

from report.channel import Channel
from report.database import FLEET, LEDGER, RECORDING
from report.names import stem
from report.problem import Problem

MOST_TURNS_ONE_BY_ONE = 500000  # beyond: a run is a point, where the file has figures of runs


class Subject:
    def __init__(self, database, label, runs):
        self.database, self.label, self.runs = database, label, runs

    @property
    def first_ns(self):
        return min((r["first_stamp_ns"] for r in self.runs if r["first_stamp_ns"] is not None), default=None)

    @property
    def last_ns(self):
        return max((r["last_stamp_ns"] for r in self.runs if r["last_stamp_ns"] is not None), default=None)

    def total(self, name):
        return sum(run[name] or 0 for run in self.runs)

    @property
    def hours(self):
        return self.total("duration") / 3600.0

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
        if not self.has_rows("blows"):
            return 0
        return len(self.frame("turn FROM blows WHERE {runs} AND energy IS NULL"))

    def failed_bags(self):
        """(bag, reason) of a merged file's bags that gave nothing."""
        if self.database.kind != FLEET:
            return []
        return list(self.database.rows(
            "SELECT bag, reason FROM bags WHERE machine = ? AND status <> 'done' ORDER BY bag", self.label))

    def counted_channels(self):
        """Channels with their cycles over all runs: pieces add exactly. A changed grid begins another channel."""
        if self.database.kind == FLEET:
            return fleet_channels(self)
        channels = {}
        for run in self.runs:
            for row in self.database.records("SELECT * FROM channels WHERE run_id = ? AND counted ORDER BY channel",
                                             run["run_id"]):
                key = (row["name"], row["least"], row["greatest"], row["classes"])
                if key not in channels:
                    channels[key] = Channel.of(row, run["equivalent_cycles_per_hour"])
                add_piece(channels[key], self.database, run, row)
        return list(channels.values())


def add_piece(channel, database, run, row):
    place = (run["run_id"], row["channel"])
    channel.add_sums(row)
    channel.hours += (run["duration"] or 0.0) / 3600.0
    channel.count.add_closed(database.rows(
        "SELECT steps, low, count FROM cycles WHERE run_id = ? AND channel = ?", *place))
    channel.count.join([c for c, in database.rows(
        "SELECT class FROM residues WHERE run_id = ? AND channel = ? ORDER BY place", *place)])


def fleet_channels(subject):
    """A merged file has the sums of each machine already."""
    channels, database = [], subject.database
    per_hour = max((r["equivalent_cycles_per_hour"] or 0.0 for r in subject.runs), default=0.0)
    for row in database.records("SELECT * FROM machine_channels WHERE machine = ? ORDER BY machine_channel",
                                subject.label):
        channel = Channel.of(row, per_hour)
        channel.add_sums(row)
        channel.hours = row["hours"]
        at = row["machine_channel"]
        channel.count.add_closed(database.rows("SELECT steps, low, count FROM machine_cycles WHERE machine_channel = ?", at))
        channel.count.residue = [c for c, in database.rows(
            "SELECT class FROM machine_residues WHERE machine_channel = ? ORDER BY place", at)]
        channels.append(channel)
    return channels


def grouped(runs, key):
    groups = {}
    for run in runs:
        groups.setdefault(run[key], []).append(run)
    return groups


def by_number(name):
    """Machine 2 before machine 10."""
    return [(int(part), "") if part.isdigit() else (0, part) for part in re.split(r"([0-9]+)", name)]


def fleet_subjects(database, only_machine):
    """Every machine that has a bag, also one whose bags all failed."""
    names = [name for name, in database.rows("SELECT DISTINCT machine FROM bags ORDER BY machine")]
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
    groups = grouped(database.records("SELECT * FROM runs ORDER BY first_stamp_ns, run_id"), "machine")
    name = stem(database.path)
    if len(groups) < 2:
        return [Subject(database, name, runs) for runs in groups.values()] or [Subject(database, name, [])]
    return [Subject(database, f"{name}, machine {at}", runs) for at, runs in enumerate(groups.values(), 1)]


def mixed_machines(databases, subjects):
    """Lines for files with more than one machine: their cycles are never added."""
    lines = []
    for database in databases:
        count = sum(s.database is database for s in subjects)
        if count > 1 and database.kind == RECORDING:
            lines.append(f"{stem(database.path)}: holds {count} machines (hammer, boom or their parameters differ); "
                         "each stands alone")
    return lines


def notes(databases):
    """Notes for the user of the command, one line each."""
    subjects = [s for database in databases for s in subjects_of(database)]
    lines = mixed_machines(databases, subjects)
    return lines + [f"{s.label}: {'no whole revolution' if s.runs else 'no run at all'}" for s in subjects
                    if not s.total("turns")]
