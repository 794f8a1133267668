"""Outputs of the commands: complete under their name, or not there at all; nothing of others is replaced. Tables become
TABLE.csv, those of ledgers ledger_TABLE.csv: the first line is a comment with the units, the second the header; the first
column is the file."""
import contextlib
import csv
import os
import pathlib
import re
import stat
import tempfile

from report.database import LEDGER, Problem, one_line, quoted
from report.subjects import stem

GENERATOR = b'<meta name="generator" content="hammer_loads report">'  # of every page's template
COMMENT = "# hammer_loads"
# A spreadsheet runs what begins so; a text that it does not run begins with a quotation mark.
FORMULA = ("=", "+", "-", "@", "\t")


def check_existing(name, force, is_kind, kind, foreign):
    """Raises unless the name is free, or may be replaced. foreign(name): why what is there must stay, or nothing."""
    if not os.path.lexists(name):
        return
    if not is_kind(os.lstat(name).st_mode):
        raise Problem(f"{name}: is no {kind}, must be a new one")
    if not force:
        raise Problem(f"{name}: exists already, must be a new {kind}; --force replaces one that this command wrote")
    if reason := foreign(name):
        raise Problem(f"{name}: --force does not replace it: {reason}")


def foreign_page(name):
    with open(name, "rb") as file:
        return None if GENERATOR in file.read(2000) else "it is no page of this command"


def foreign_entry(name):
    """Anything in a directory but tables of this command."""
    for path in sorted(pathlib.Path(name).iterdir()):
        is_own = path.suffix == ".csv" and path.is_file() and not path.is_symlink()
        if not (is_own and path.open("rb").read(len(COMMENT)) == COMMENT.encode()):
            return f"{path.name} is none of its tables"
    return None


def check_file(name, force):
    """An input is no page, and so it is never replaced."""
    check_existing(name, force, stat.S_ISREG, "regular file", foreign_page)


def check_directory(name, needed, force):
    """needed: paths of other outputs; a directory that holds them cannot be replaced. An input in it is none of the tables."""
    place = os.path.realpath(name)
    for held, path in (("the working directory", os.getcwd()), *((path, path) for path in needed)):
        if os.path.commonpath([place, os.path.realpath(path)]) == place:
            raise Problem(f"{name}: holds {held}, must be a directory of its own")
    check_existing(name, force, stat.S_ISDIR, "directory", foreign_entry)


@contextlib.contextmanager
def part_of(name):
    """Path beside the name for what shall get it; what is left there is removed."""
    try:
        with tempfile.TemporaryDirectory(dir=os.path.dirname(os.path.abspath(name)), prefix=".hammer_loads") as folder:
            yield pathlib.Path(folder) / "part"
    except OSError as error:
        raise Problem(f"{name}: cannot be written: {error.strerror}")


def publish_file(name, data, force):
    """Gives the bytes this name; a file that has appeared meanwhile is not replaced without force."""
    with part_of(name) as part:
        part.write_bytes(data)
        (os.replace if force else os.link)(part, name)


def publish_directory(name, fill, force):
    """fill(path) writes into a new directory, which then gets this name; a directory that is replaced steps aside first."""
    with part_of(name) as part:
        part.mkdir()
        fill(part)
        old = part.with_name("old")
        try:
            if os.path.lexists(name):
                if not force:
                    raise Problem(f"{name}: exists meanwhile, must be a new directory")
                os.rename(name, old)
            os.rename(part, name)
        finally:
            if old.is_dir() and not os.path.lexists(name):  # a signal came between
                os.rename(old, name)


def plain(value):
    """Numbers as they are; a text that a spreadsheet would take for a formula begins with '. No control characters."""
    if not isinstance(value, str):
        return value
    shown = "\n".join("\t".join(map(one_line, line.split("\t"))) for line in value.split("\n"))
    return "'" + shown if shown.startswith(FORMULA) else shown


def file_name(database, table):
    if not re.fullmatch("[A-Za-z0-9_]+", table):
        raise Problem(f"{database.path}: table {one_line(table)}: must be of letters, digits and _ to be a file's name")
    return ("ledger_" if database.kind == LEDGER else "") + table + ".csv"


def write_tables(databases, directory):
    """Writes equal tables of several files into one CSV; a column that a file lacks stays empty."""
    tables = {}
    for database in databases:
        for table in database.tables():
            tables.setdefault(file_name(database, table), []).append((database, table))
    for name, sources in tables.items():
        columns = list(dict.fromkeys(c for database, table in sources for c in database.columns(table)))
        units = {column: unit for database, table in sources for column, unit in database.rows(
            "SELECT column_name, unit FROM columns WHERE table_name = ?", table)}
        with open(directory / name, "w", encoding="utf-8", newline="") as file:
            listed = ", ".join(f"{c} [{units.get(c, '-')}]" for c in ["file", *columns])
            file.write(one_line(f"{COMMENT}, units: {listed}") + "\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["file", *map(plain, columns)])
            for database, table in sources:
                writer.writerows(rows_of(database, table, columns))


def rows_of(database, table, columns):
    present = database.columns(table)
    listed = ", ".join(quoted(c) if c in present else "NULL" for c in columns)
    order = ", ".join(map(quoted, present[:4]))
    for row in database.rows(f"SELECT {listed} FROM {quoted(table)} ORDER BY {order}"):
        yield [plain(stem(database.path)), *map(plain, row)]
