"""Takes outcomes of bags into a merged file: each run once, a bag that changed instead of its older self."""
import datetime
import json

from report.database import RECORDING, Database, Problem
from report.quantities import CYLINDERS, QUANTITIES, value_of

# Copied as they are, with another run_id.
COPIED = ["refusals", "warnings", "alarms", "reference", "channels", "cycles", "residues"]
OPTIONAL = {"turns": ["turns", "blows"]}
OUTCOME = ("machine", "bag", "input_sha256", "parameters_sha256", "status", "reason")


def of_stamp(stamp_ns):
    """Day and ISO week, UTC."""
    if stamp_ns is None:
        return None, None
    day = datetime.date(1970, 1, 1) + datetime.timedelta(days=stamp_ns // 86400000000000)
    year, week, _ = day.isocalendar()
    return day.isoformat(), f"{year}-W{week:02d}"


class Loader:
    """For one transaction of the store."""

    def __init__(self, store, rows=None):
        self.store, self.tables = store, COPIED + OPTIONAL.get(rows, [])

    def add(self, outcome_path):
        """True if the merged file changed."""
        with open(outcome_path, encoding="utf-8") as file:
            outcome = json.load(file)
        source = None
        try:
            source = self._source(outcome, outcome_path[:-len(".json")] + ".sqlite")
        except Problem as problem:
            outcome.update(status="failed", reason=str(problem))
        if self._is_known(outcome, source):
            return False
        # With the rows of the bag from before it or its parameters changed.
        self.store.rows("DELETE FROM bags WHERE machine = ? AND bag = ?", outcome["machine"], outcome["bag"])
        self.store.rows("SAVEPOINT before_the_bag")
        try:
            self._add_bag(outcome, source)
        except (Problem, self.store.Refusal) as problem:
            self.store.rows("ROLLBACK TO SAVEPOINT before_the_bag")
            outcome.update(status="failed", reason=" ".join(str(problem).split()))
            self._add_bag(outcome, None)
        self.store.rows("RELEASE SAVEPOINT before_the_bag")
        self.store.insert("stale_machines", [(outcome["machine"],)], unless_there=True)
        return True

    def _source(self, outcome, path):
        """Database of an outcome; nothing for a bag that gave none. A recording that is in under another name counts once."""
        if outcome["status"] != "done":
            return None
        source = Database(path)
        if source.kind != RECORDING:
            raise Problem(f"{path}: is no result of process_bag")
        for key in run_keys(source):
            other = self.store.row("SELECT bags.machine, bag FROM bags JOIN runs USING(bag_id) WHERE run_key = ?", key)
            if other is not None and tuple(other) != (outcome["machine"], outcome["bag"]):
                outcome.update(status="twice", reason=f"same recording and parameters as {other[1]} of {other[0]}")
                return None
        return source

    def _is_known(self, outcome, source):
        found = self.store.row("SELECT * FROM bags WHERE machine = ? AND bag = ?", outcome["machine"], outcome["bag"])
        if found is None or tuple(found[1:]) != tuple(outcome[name] for name in OUTCOME):
            return False
        runs = self.store.rows("SELECT run_key FROM runs WHERE bag_id = ? ORDER BY run_id", found[0])
        return [key for key, in runs] == (run_keys(source) if source else [])

    def _add_bag(self, outcome, source):
        """source: its database, or nothing."""
        bag_id, = self.store.row("SELECT coalesce(max(bag_id), 0) + 1 FROM bags")
        self.store.insert("bags", [(bag_id, *(outcome[name] for name in OUTCOME))])
        if source is None:
            return
        shift, = self.store.row("SELECT coalesce(max(run_id), 0) FROM runs")
        for run in source.records("SELECT * FROM runs ORDER BY run_id"):
            self._add_run(source, run, bag_id, shift + run["run_id"])
        for table in self.tables:
            self._copy(source, table, shift)
        self._describe(source)

    def _add_run(self, source, run, bag_id, run_id):
        own = run["run_id"]
        self._add_parameters(source, run)
        day, week = of_stamp(run["first_stamp_ns"])
        run.update(run_id=run_id, bag_id=bag_id, day=day, week=week)
        names = [name for name in self.store.columns("runs") if name in run]
        self.store.insert("runs", [[run[name] for name in names]], names)
        self.store.insert("run_figures", figures(source, own, run_id))
        self.store.insert("run_cylinders", [
            (run_id, *row) for row in source.rows("SELECT " + CYLINDERS.format(runs="run_id = ?"), own)])

    def _add_parameters(self, source, run):
        key = (run["parameters_sha256"], run["version"])
        self.store.insert("parameter_sets", [(key[0], run["parameters_yaml"])], unless_there=True)
        rows = source.rows("SELECT key, value, shipped FROM parameters WHERE run_id = ?", run["run_id"])
        self.store.insert("parameter_values", ((*key, *row) for row in rows), unless_there=True)

    def _copy(self, source, table, shift):
        columns = source.columns(table)
        if table not in COPIED:
            self._make_rows_of_turns(table, [c for c in columns if c not in ("run_id", "turn", "stamp_ns")])
        known = self.store.columns(table)
        names = [name for name in columns if name in known]
        listed = ", ".join(f"run_id + {shift}" if name == "run_id" else name for name in names)
        self.store.insert(table, source.rows(f"SELECT {listed} FROM {table}"), names)

    def _make_rows_of_turns(self, table, fields):
        """Tables of turns have a column for each field of a message: as the first bag has them, later ones are added."""
        self.store.rows(f"CREATE TABLE IF NOT EXISTS {table}(run_id INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, "
                        "turn BIGINT NOT NULL, stamp_ns BIGINT, PRIMARY KEY(run_id, turn))")
        known = self.store.columns(table)
        for name in fields:
            if name not in known:
                self.store.rows(f"ALTER TABLE {table} ADD COLUMN {name} DOUBLE PRECISION")

    def _describe(self, source):
        """Units and descriptions of the columns that were copied."""
        self.store.insert("columns", [
            row for row in source.rows("SELECT table_name, column_name, unit, description FROM columns")
            if row[0] in ("runs", *self.tables) and row[1] in self.store.columns(row[0])], unless_there=True)


def run_keys(source):
    return [key for key, in source.rows("SELECT run_key FROM runs ORDER BY run_id")]


def figures(source, own, run_id):
    """Figures of each quantity over all revolutions: count, least, mean, greatest, total."""
    for quantity in QUANTITIES:
        value = value_of(quantity)
        row = next(source.rows(f"SELECT count({value}), min({value}), avg({value}), max({value}), sum({value}) "
                               f"FROM {quantity.table} WHERE run_id = ?", own))
        yield (run_id, quantity.key, *row)
