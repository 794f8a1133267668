"""Every table of the files as CSV: TABLE.csv, ledgers' as ledger_TABLE.csv. The first line is a comment with the units,
the second the header; the first column is the file."""
import csv
import re

from report.database import LEDGER, Problem, one_line, quoted
from report.subjects import stem

COMMENT = "# hammer_loads"
# A spreadsheet runs what begins so; a text that it does not run begins with a quotation mark.
FORMULA = ("=", "+", "-", "@", "\t")


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
        units = {column: unit for source in sources for column, unit in units_of(*source)}
        with open(directory / name, "w", encoding="utf-8", newline="") as file:
            listed = ", ".join(f"{c} [{units.get(c, '-')}]" for c in ["file", *columns])
            file.write(one_line(f"{COMMENT}, units: {listed}") + "\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["file", *map(plain, columns)])
            for database, table in sources:
                writer.writerows(rows_of(database, table, columns))


def units_of(database, table):
    """(column, unit) by the table `columns`."""
    if "columns" in database.tables():
        yield from database.rows("SELECT column_name, unit FROM columns WHERE table_name = ?", table)


def rows_of(database, table, columns):
    present = database.columns(table)
    listed = ", ".join(quoted(c) if c in present else "NULL" for c in columns)
    order = ", ".join(map(quoted, present[:4]))
    for row in database.rows(f"SELECT {listed} FROM {quoted(table)} ORDER BY {order}"):
        yield [plain(stem(database.path)), *map(plain, row)]
