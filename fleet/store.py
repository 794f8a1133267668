"""A merged file: SQLite by a path, PostgreSQL by a connection URL; the same statements for both."""
import os
import pathlib
import re
import sqlite3

from report.database import Problem

APPLICATION_ID, VERSION = 0x484C5246, 1
SCHEMA = pathlib.Path(__file__).resolve().parent / "merged_schema.sql"


def column_texts():
    """Rows of the table `columns` by the comments of the schema."""
    table, texts = None, []
    for line in SCHEMA.read_text(encoding="utf-8").splitlines():
        if begins := re.match(r"CREATE TABLE (\w+)\(", line):
            table = begins[1]
        elif column := re.match(r"\s+(\w+) .*-- \[([^\]]+)\] (.+)", line):
            texts.append((table, *column.groups()))
    return texts


class Store:
    """Opened for writing: a new one gets its tables. One writer at a time; another one waits."""

    def rows(self, sql, *values):
        cursor = self._connection.cursor()
        cursor.execute(sql.replace("?", self._mark), values)
        return cursor

    def row(self, sql, *values):
        return self.rows(sql, *values).fetchone()

    def insert(self, table, rows, columns=(), unless_there=False):
        """columns: of the rows, else all of the table. unless_there: a row whose key is in stays as it is."""
        columns = columns or self.columns(table)
        values = f"VALUES({', '.join([self._mark] * len(columns))})" + unless_there * " ON CONFLICT DO NOTHING"
        self._execute_many(self._connection.cursor(), f"INSERT INTO {table}({', '.join(columns)}) {values}", rows)

    def commit(self):
        self._connection.commit()

    def close(self):
        self._connection.close()

    def _make_tables(self):
        for statement in filter(str.strip, SCHEMA.read_text(encoding="utf-8").split(";\n")):
            self.rows(statement)
        self.insert("columns", column_texts())


class SqliteStore(Store):
    Refusal = sqlite3.IntegrityError  # of a row
    _mark = "?"
    _execute_many = staticmethod(sqlite3.Cursor.executemany)

    def __init__(self, path):
        self.name = path
        if os.path.lexists(path) and not os.path.isfile(path):
            raise Problem(f"{path}: is no regular file")
        try:
            self._connection = sqlite3.connect(path, isolation_level=None, timeout=60.0)
            self._connection.execute("PRAGMA synchronous = NORMAL")
            self._connection.execute("PRAGMA foreign_keys = ON")
            self.begin()
            self._check()
        except sqlite3.Error as error:
            raise Problem(f"{path}: {error}")
        self.commit()

    def _check(self):
        application, = self.row("PRAGMA application_id")
        version, = self.row("PRAGMA user_version")
        if application == 0 and self.row("SELECT count(*) FROM sqlite_master") == (0,):
            self._make_tables()
            self.rows(f"PRAGMA application_id = {APPLICATION_ID}")
            self.rows(f"PRAGMA user_version = {VERSION}")
        elif application != APPLICATION_ID:
            raise Problem(f"{self.name}: is another database, no merged file")
        elif version != VERSION:
            raise Problem(f"{self.name}: merged file of version {version}, this program writes version {VERSION}")

    def begin(self):
        self.rows("BEGIN IMMEDIATE")

    def columns(self, table):
        """Names of the columns; nothing for a table that is not there."""
        return [row[1] for row in self.rows(f"PRAGMA table_info({table})")]


class PostgresStore(Store):
    """Tables are made in the first schema of the search path."""

    _mark = "%s"

    def __init__(self, url):
        import psycopg2
        import psycopg2.extras
        self.name, self.Refusal, self._execute_many = "PostgreSQL", psycopg2.IntegrityError, psycopg2.extras.execute_batch
        try:
            self._connection = psycopg2.connect(url)
        except psycopg2.Error as error:
            raise Problem(f"PostgreSQL: {' '.join(str(error).split())}")
        self.begin()
        if not self.columns("bags"):
            self._make_tables()
        self.commit()

    def begin(self):
        self.rows("SELECT pg_advisory_xact_lock(?)", APPLICATION_ID)

    def columns(self, table):
        """Names of the columns; nothing for a table that is not there."""
        return [name for name, in self.rows("SELECT column_name FROM information_schema.columns WHERE table_name = ? "
                                            "AND table_schema = current_schema() ORDER BY ordinal_position", table)]


def opened(target):
    return PostgresStore(target) if target.startswith(("postgresql://", "postgres://")) else SqliteStore(target)
