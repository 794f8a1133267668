"""Blocks of a page, in the order of a list: texts are paragraphs, lists are pictures beside each other, None is nothing. The
templates escape all text."""
from collections import namedtuple

CURVES = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"]  # colours of page.css

# The first column names the row. kind: classes of the table, `numbers` or `words`.
Table = namedtuple("Table", "caption header rows kind", defaults=("numbers",))
Note = namedtuple("Note", "words kind", defaults=("note",))  # paragraph of a kind of its own
Details = namedtuple("Details", "summary blocks")            # folded
Block = namedtuple("Block", "title blocks")                  # on one sheet of paper
Figures = namedtuple("Figures", "figures")                   # (name, value), large
Bars = namedtuple("Bars", "caption bars legend")             # (name, parts as (class, source, share)), and the keys of the classes


def folded(table, most, words):
    """The table, in details if it is long; None where there are no rows."""
    if table is None or not table.rows:
        return None
    return table if len(table.rows) <= most else Details(f"{len(table.rows)} {words}", [table])


def as_tables(tables):
    """Details with each of these tables."""
    return [Details(f"{table.caption} as a table", [table]) for table in tables]
