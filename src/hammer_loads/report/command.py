"""Command lines: what report, budget, check and test_report share, and report itself."""
import argparse
import importlib
import os
import pathlib
import signal
import sys
import tempfile
import warnings
import xml.etree.ElementTree as ElementTree

from report import inputs, output
from report.database import Problem, one_line
from report.subjects import notes

WRONG_USAGE, FAILURE, INTERRUPTED = 2, 1, 130
HERE = pathlib.Path(__file__).resolve().parent


def package_version():
    """From package.xml: three levels up in the source, one up where it is installed."""
    for directory in (HERE.parent, HERE.parent.parent.parent):
        path = directory / "package.xml"
        if path.is_file():
            return ElementTree.parse(path).getroot().findtext("version")
    raise Problem(f"{HERE}: no package.xml above it; the installation is not whole")


class Usage(Problem):
    """Wrong usage; the command ends with code 2."""


class Parser(argparse.ArgumentParser):
    """Parser of a command whose inputs may be bags."""

    def __init__(self, files, **words):
        super().__init__(**words)
        self.add_argument("files", nargs="+", **files)
        inputs.add_bag_options(self)
        self.add_argument("--version", action="version", version=f"hammer_loads {package_version()}",
                          help="print the version and end")

    def error(self, message):
        self.exit(WRONG_USAGE, f"{self.prog}: {' '.join(message.split())} (--help shows the options)\n")


def parser():
    result = Parser(
        dict(metavar="FILE", help="a database of process_bag --db, a ledger, a fleet's merged file, or a bag; splits of one "
             "recording of the node count as one"),
        prog="report", description="One page, and tables, from what process_bag --db and the ledgers hold.",
        epilog="The page needs no other file and no network. Two or more machines are compared. Errors are one line "
               "each; exit code 1, or 2 for wrong usage.")
    result.add_argument("--html", metavar="OUT.html", help="page to write, which must not exist")
    result.add_argument("--csv", metavar="DIRECTORY", help="every table as CSV into a new directory")
    result.add_argument("--machine", metavar="NAME", help="of a fleet's merged file this machine alone")
    result.add_argument("--force", action="store_true", help="replace what this command wrote")
    return result


def run(given, folder):
    if given.html is None and given.csv is None:
        raise Usage("nothing to write: --html OUT.html, --csv DIRECTORY or both are needed")
    if given.html is not None:
        output.check_file(given.html, given.force)
    if given.csv is not None:
        output.check_directory(given.csv, [given.html] if given.html else [], given.force)
    databases = list(inputs.databases(given, folder))
    for note in notes(databases):
        print(one_line(f"note: {note}"), file=sys.stderr)
    if given.html is not None:
        from report import page  # here: tables and refusals need no pandas and no matplotlib
        content = page.page(databases, package_version(), given.machine)
        output.publish_file(given.html, content, given.force)
        print(f"{given.html}: {len(databases)} file{'s' if len(databases) > 1 else ''}, {len(content) / 1e6:.2f} MB")
    if given.csv is not None:
        output.publish_directory(given.csv, lambda part: output.write_tables(databases, part), given.force)
        print(f"{given.csv}: {len(os.listdir(given.csv))} tables")


def main(arguments, name="report"):
    """Exit code of the command of this name; its module has parser() and run(), which gets a folder for databases of bags."""
    module = importlib.import_module("report." + ("command" if name == "report" else name))
    options = module.parser()
    given = options.parse_args(arguments)
    warnings.simplefilter("ignore")  # of numpy: what is no number is shown as such; stderr has this command's own lines alone
    for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(ending) != signal.SIG_IGN:
            signal.signal(ending, signal.default_int_handler)
    try:
        if inputs.bag_options(given) and not any(map(inputs.is_bag, given.files)):
            raise Usage("--params, --urdf and topics are for bags; a database has its parameters")
        with tempfile.TemporaryDirectory(prefix=f"hammer_loads_{name}") as folder:
            module.run(given, folder)
        return 0
    except Usage as problem:
        options.error(str(problem))
    except Problem as problem:
        print(problem, file=sys.stderr)
        return FAILURE
    except OSError as error:
        print(one_line(f"{error.filename}: {error.strerror}"), file=sys.stderr)
        return FAILURE
    except (ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError, TypeError, ValueError) as error:
        # What stands in the tables is no number, too large, or missing where the page must have it.
        print(one_line(f"{', '.join(given.files)}: damaged, or not as this package writes it "
                       f"({type(error).__name__}: {error})"), file=sys.stderr)
        return FAILURE
    except KeyboardInterrupt:
        print("interrupted: nothing is written", file=sys.stderr)
        return INTERRUPTED
