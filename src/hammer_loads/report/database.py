"""Databases of this package, opened for reading; every problem becomes one line with the file's name."""
import os
import sqlite3
import unicodedata
import urllib.parse

RECORDING, LEDGER, FLEET = "recording", "ledger", "fleet"
KINDS = {0x484C5242: RECORDING, 0x484C4C31: LEDGER, 0x484C5246: FLEET}
VERSION = 1  # of each kind
STEPS = 100000  # of SQLite's machine, some ms, between two looks for a signal
BUSY_S = 5.0  # a node that writes its ledger needs some ms


def one_line(text):
    """Text without line breaks and without codes that a terminal obeys."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") else c for c in str(text))


class Problem(Exception):
    """One line that names the file and the reason; the command ends with code 1."""

    def __str__(self):
        return one_line(super().__str__())


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
        # Python handles a signal in this function; an exception there ends the query.
        self._connection.set_progress_handler(lambda: 0, STEPS)
        self._guarded(self._connection.execute, "BEGIN")
        self.kind = self._kind()
        self._check_tables()

    def _check_file(self):
        if os.path.exists(self.path) and not os.path.isfile(self.path):
            raise Problem(f"{self.path}: is no regular file")
        try:
            with open(self.path, "rb") as file:
                if file.read(16) != b"SQLite format 3\0":
                    raise Problem(f"{self.path}: is no SQLite file")
        except OSError as error:
            raise Problem(f"{self.path}: cannot be read: {error.strerror}")

    def _kind(self):
        application, version = self.value("PRAGMA application_id"), self.value("PRAGMA user_version")
        kind = KINDS.get(application)
        if kind is None:
            raise Problem(f"{self.path}: is another database (application_id {application}), must be written by "
                          "process_bag --db, --ledger or the fleet")
        if version != VERSION:
            age = "an older" if version < VERSION else "a newer"
            raise Problem(f"{self.path}: {kind} of {age} version, {version}; this program reads version {VERSION}")
        return kind

    def _check_tables(self):
        """Refuses views: a name must stand for a table, whose rows end."""
        for name, kind in self.rows("SELECT name, type FROM sqlite_master WHERE type IN ('view', 'trigger') OR "
                                    "sql LIKE 'CREATE VIRTUAL%' ORDER BY name"):
            if (self.kind, kind, name) != (FLEET, "view", "parameters"):  # its own (fleet/merged_schema.sql)
                raise Problem(f"{self.path}: {kind} {name}: must hold tables alone, as this package writes them")

    def _guarded(self, call, *arguments, **options):
        try:
            return call(*arguments, **options)
        except (sqlite3.Error, OSError, OverflowError, UnicodeError, MemoryError) as error:  # pandas' is an OSError
            reason = " ".join(str(error.__cause__ or error).split())
            if reason == "interrupted":
                raise KeyboardInterrupt
            raise Problem(f"{self.path}: cannot be read: {reason}")

    def rows(self, sql, *values):
        """Iterates over tuples."""
        cursor = self._guarded(self._connection.execute, sql, values)
        while some := self._guarded(cursor.fetchmany, 1000):
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
        """First column of the first row; None without rows."""
        return next(self.rows(sql, *values), (None,))[0]

    def tables(self):
        return [name for name, in self.rows(
            "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite%' ORDER BY name")]

    def columns(self, table):
        return [row[1] for row in self.rows(f"PRAGMA table_info({quoted(table)})")]
