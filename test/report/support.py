"""The command under test, and the databases of sample_database.py."""
import contextlib
import html.parser
import io
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import pytest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path[:0] = [str(HERE), str(SOURCE / "src" / "hammer_loads")]
import sample_database  # noqa: E402  (the path must be set first)

PAGES = {}  # by the files and options
DATA = SOURCE / "test" / "data"
REPORT = SOURCE / "src" / "hammer_loads" / "commands" / "report_main.py"


def program(name):
    """A command of this build; nothing where none was built."""
    path = pathlib.Path(os.environ.get("HAMMER_LOADS_PROGRAMS", "")) / name
    return str(path) if os.environ.get("HAMMER_LOADS_PROGRAMS") and path.exists() else None


needs_programs = pytest.mark.skipif(not (program("process_bag") and program("life")), reason="needs the built commands")


def report_here(*arguments, command="report"):
    """The finished command, in this process: without a second to start each."""
    from report.command import main  # here: the path is set above
    out, err = io.StringIO(), io.StringIO()
    signals = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.getsignal(name) for name in signals]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main([str(argument) for argument in arguments], command)
    except SystemExit as exit_:
        code = exit_.code
    finally:
        for name, handler in zip(signals, before):
            signal.signal(name, handler)
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())


def report(*arguments, **options):
    """The finished command, as a process of its own."""
    return subprocess.run([sys.executable, str(REPORT), *map(str, arguments)], capture_output=True, text=True, **options)


def page_of(*files, options=(), note=""):
    """The page as a Reader. note: the one that the command gives. The same files give the same page: it is made once."""
    key = (*((file.name, file.read_bytes()) for file in files), *map(str, options))
    if key not in PAGES:
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "page.html"
            done = report_here(*files, "--html", out, *options)
            assert (done.returncode, done.stderr) == (0, note and f"note: {note}\n")
            PAGES[key] = Reader(out.read_text(encoding="utf-8"))
    return PAGES[key]


def assert_refused(done, *words, code=1):
    """Exit code, one line that holds the words, nothing on stdout."""
    assert (done.returncode, done.stderr.count("\n"), done.stdout) == (code, 1, ""), done.stderr
    for word in words:
        assert str(word) in done.stderr


def execute(path, *statements):
    """Rows of the last statement."""
    with contextlib.closing(sqlite3.connect(str(path), isolation_level=None)) as database:
        return [database.execute(statement).fetchall() for statement in statements][-1]


def with_budget(path, rows):
    """The database, with rows of its table budget: quantity, value, std, source, share."""
    with contextlib.closing(sqlite3.connect(str(path))) as database, database:
        database.executemany("INSERT INTO budget VALUES(1,?,?,?,?,?,?)",
                             [(quantity, sample_database.unit_of(quantity), *row) for quantity, *row in rows])
    return path


def elements(tree, tag):
    return [element for element in tree.iter() if element.tag == tag]


class Drawn:
    """A picture of a page: its curves in the numbers of its axes."""

    def __init__(self, svg):
        self.tree = ElementTree.fromstring(svg.replace("xlink:", ""))
        self.title = self.tree.get("aria-label")
        ticks = [self._tick(group) for group in elements(self.tree, "g") if len(group) == 3 and elements(group[2], "text")]
        self.x, self.y = ([tick[1:] for tick in ticks if tick and tick[0] == axis] for axis in "xy")

    @staticmethod
    def _points(path):
        """Subpaths of an element."""
        pieces = path.get("d").split("M")[1:]
        numbers = [[float(number) for number in re.findall(r"-?[0-9.]+", piece)] for piece in pieces]
        return [list(zip(piece[::2], piece[1::2])) for piece in numbers]

    def _tick(self, group):
        """(axis, number, place); nothing for what is no line of the grid."""
        label, paths = elements(group[2], "text")[0].text, elements(group[0], "path")
        if not paths:
            return None
        (x0, y0), (x1, y1) = self._points(paths[0])[0]
        return ("x", value(label), x0) if x0 == x1 else ("y", value(label), y0)

    @staticmethod
    def _scaled(ticks, place):
        (low, at_low), (high, at_high) = ticks[0], ticks[-1]
        return low + (place - at_low) / (at_high - at_low) * (high - low)

    def curves(self, kind):
        """Unbroken pieces of the lines or bands of this class: lists of (x, y)."""
        return [[(self._scaled(self.x, x), self._scaled(self.y, y)) for x, y in piece]
                for group in elements(self.tree, "g") if group.get("class") == kind
                for path in elements(group, "path") for piece in self._points(path)]

    def range_of(self, axis):
        """Least and greatest number of the axis "x" or "y"."""
        ticks, length = (self.x, "width") if axis == "x" else (self.y, "height")
        frame = [point for path in elements(self.tree, "rect") for point in
                 (float(path.get(axis)), float(path.get(axis)) + float(path.get(length)))]
        return sorted(self._scaled(ticks, place) for place in (min(frame), max(frame)))

    def classes(self, kind):
        """Classes of everything drawn of this kind, each once."""
        classes = [group.get("class") or "" for group in elements(self.tree, "g")]
        return list(dict.fromkeys(c for c in classes if c.startswith(kind)))


def value(text):
    return float(text.replace("\u202f", "").replace("\u2212", "-").split()[0])


class Reader(html.parser.HTMLParser):
    """A page as a browser without JavaScript reads it: visible text, tables by caption, ids."""

    def __init__(self, page):
        super().__init__()
        self.size = len(page)
        self.pictures = [Drawn(svg) for svg in re.findall(r"<svg.*?</svg>", page, re.DOTALL)]
        self.text, self.tables, self.ids, self.tags, self.links = "", {}, [], [], []
        self.pieces = []  # (tag, text) of every piece of text
        self.open, self._rows, self._caption, self._cell = [], None, "", None
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.tags.append((tag, given))
        self.ids += [given["id"]] if "id" in given else []
        self.links += [given["href"]] if "href" in given else []
        if tag not in ("meta", "link", "br", "path", "rect", "input"):
            self.open.append(tag)
        if tag == "table":
            self._rows, self._caption = [], ""
        if tag == "tr":
            self._rows.append([])
        if tag in ("td", "th"):
            self._rows[-1].append("")

    def handle_endtag(self, tag):
        if tag in ("path", "rect"):
            return
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()
        if tag == "table":
            self.tables.setdefault(self._caption, []).append(self._rows)
            self._rows = None

    def handle_data(self, data):
        inside = self.open[-1] if self.open else ""
        if inside == "caption":
            self._caption += data
        elif self._rows and any(tag in ("td", "th") for tag in self.open[-3:]):
            self._rows[-1][-1] += data
        if inside not in ("script", "style"):
            self.text += data
            self.pieces.append((inside, data))

    def table(self, caption, at=0):
        """{first column: {header: cell}}."""
        header, *rows = self.tables[caption][at]
        return {row[0]: dict(zip(header[1:], row[1:])) for row in rows}

    def drawn(self, title):
        """The picture whose title begins so."""
        return next(picture for picture in self.pictures if picture.title.startswith(title))
