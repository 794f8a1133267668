"""The command under test, and the databases of sample_database.py."""
import html.parser
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path[:0] = [str(HERE), str(SOURCE / "src" / "hammer_loads")]
REPORT = SOURCE / "src" / "hammer_loads" / "commands" / "report_main.py"


def program(name):
    """A command of this build; nothing where none was built."""
    path = pathlib.Path(os.environ.get("HAMMER_LOADS_PROGRAMS", "")) / name
    return str(path) if os.environ.get("HAMMER_LOADS_PROGRAMS") and path.exists() else None


def report(*arguments):
    return subprocess.run([sys.executable, str(REPORT), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True)


class Reader(html.parser.HTMLParser):
    """A page as a browser without JavaScript reads it: visible text, tables by caption, ids, scripts."""

    def __init__(self, page):
        super().__init__()
        self.text, self.tables, self.ids, self.tags, self.scripts, self.links = "", {}, [], [], [], []
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
        if tag == "script":
            self.scripts.append("")

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
        if inside == "script":
            self.scripts[-1] += data
        elif inside == "caption":
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

    def charts(self):
        return json.loads(next(s for s in self.scripts if s.startswith("[")))


class ReportTest(unittest.TestCase):
    def setUp(self):
        self._directory = tempfile.TemporaryDirectory()
        self.addCleanup(self._directory.cleanup)
        self.directory = pathlib.Path(self._directory.name)

    def page_of(self, *files, options=(), note=""):
        """`note`: the one that the command gives."""
        out = self.directory / "page.html"
        outcome = report(*files, "--html", out, *options)
        self.assertEqual((outcome.returncode, outcome.stderr), (0, note and f"note: {note}\n"))
        return Reader(out.read_text(encoding="utf-8"))

    def assertRefused(self, outcome, *words, code=1):
        """Exit code, one line that holds the words, nothing on stdout."""
        self.assertEqual(outcome.returncode, code, outcome.stderr)
        self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
        self.assertEqual(outcome.stdout, "")
        for word in words:
            self.assertIn(str(word), outcome.stderr)
