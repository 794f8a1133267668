"""Reads a database of this package; every problem becomes one line with the file's name."""
import os
import sqlite3
import stat
import urllib.parse

from report.problem import Problem

RECORDING, LEDGER, FLEET = "recording", "ledger", "fleet"
KINDS = {0x484C5242: RECORDING, 0x484C4C31: LEDGER, 0x484C5246: FLEET}
VERSIONS = {RECORDING: (1,), LEDGER: (1,), FLEET: (1,)}
STEPS = 100000  # of SQLite's machine, some ms, between two looks for a signal
BUSY_S = 5.0  # a node that writes its ledger needs some ms


class Interrupt:
    """A signal that must end the command; SQLite stops by it within a query as well."""

    came = False

    @classmethod
    def handler(cls, *_):
        cls.came = True
        raise KeyboardInterrupt


def quoted(name):
    """Name quoted for SQL."""
    return '"' + name.replace('"', '""') + '"'


class Database:
    """Opened for reading; all queries see the file at the same instant."""

    def __init__(self, path):
        self.path = str(path)
        self._check_file()
        address = "file:" + urllib.parse.quote(os.path.abspath(self.path)) + "?mode=ro"
        self._connection = self._guarded(sqlite3.connect, address, uri=True, isolation_level=None, timeout=BUSY_S)
        self._connection.text_factory = lambda data: data.decode("utf-8", "replace")
        self._connection.set_progress_handler(lambda: int(Interrupt.came), STEPS)
        self._guarded(self._connection.execute, "BEGIN")
        self.kind = self._kind()
        self._check_tables()

    def _check_tables(self):
        """Refuses views: a name must stand for a table, whose rows end."""
        for name, kind in self.rows("SELECT name, type FROM sqlite_master WHERE type IN ('view', 'trigger') OR "
                                    "sql LIKE 'CREATE VIRTUAL%' ORDER BY name"):
            if self.kind == FLEET and (kind, name) == ("view", "parameters"):
                continue  # its own (fleet/merged_schema.sql)
            raise Problem(f"{self.path}: {kind} {name}: must hold tables alone, as this package writes them")

    def _check_file(self):
        try:
            mode = os.stat(self.path).st_mode
            if not stat.S_ISREG(mode):
                raise Problem(f"{self.path}: is no regular file")
            with open(self.path, "rb") as file:
                if file.read(16) != b"SQLite format 3\0":
                    raise Problem(f"{self.path}: is no SQLite file")
        except OSError as error:
            raise Problem(f"{self.path}: cannot be read: {error.strerror}")

    def _kind(self):
        application = self.value("PRAGMA application_id")
        kind = KINDS.get(application)
        if kind is None:
            raise Problem(f"{self.path}: is another database (application_id {application}), must be written by "
                          "process_bag --db, --ledger or the fleet")
        version, known = self.value("PRAGMA user_version"), VERSIONS[kind]
        if version not in known:
            age = "an older" if version < known[0] else "a newer"
            raise Problem(f"{self.path}: {kind} of {age} version, {version}; this program reads version {known[-1]}")
        self.version = version
        return kind

    def _guarded(self, call, *arguments, **options):
        try:
            return call(*arguments, **options)
        except (sqlite3.Error, OSError, OverflowError, UnicodeError, MemoryError) as error:  # pandas' is an OSError
            if Interrupt.came:
                raise KeyboardInterrupt
            raise Problem(f"{self.path}: cannot be read: {' '.join(str(error.__cause__ or error).split())}")

    def rows(self, sql, *values):
        """Iterates over tuples."""
        cursor = self._guarded(self._connection.execute, sql, values)
        while True:
            some = self._guarded(cursor.fetchmany, 1000)
            if not some:
                return
            yield from some

    def frame(self, sql, *values):
        """All rows as a pandas.DataFrame."""
        from pandas import read_sql_query  # here: what reads no numbers (a fleet's jobs, CSV, refusals) is fast without
        return self._guarded(read_sql_query, sql, self._connection, params=values)

    def records(self, sql, *values):
        """All rows as dictionaries by the columns' names."""
        cursor = self._guarded(self._connection.execute, sql, values)
        names = [column[0] for column in cursor.description]
        return [dict(zip(names, row)) for row in self._guarded(cursor.fetchall)]

    def value(self, sql, *values):
        row = self._guarded(self._guarded(self._connection.execute, sql, values).fetchone)
        return row[0] if row else None

    def tables(self):
        return [name for name, in self.rows(
            "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite%' ORDER BY name")]

    def columns(self, table):
        return [row[1] for row in self.rows(f"PRAGMA table_info({quoted(table)})")]
