"""Command line of report."""
import argparse
import os
import pathlib
import signal
import sys
import tempfile
import warnings
import xml.etree.ElementTree as ElementTree

from report import bags, csv_tables, output
from report.database import Database, Interrupt
from report.problem import Problem, one_line
from report.subjects import notes

TOPICS = {"crank-topic": "the crank's samples", "joint-states-topic": "the boom's joints", "imu-topic": "the hull's IMU",
          "pressures-topic": "the cylinders' pressures, a prefix", "reference-topic": "a measured load on the hull"}
WRONG_USAGE, FAILURE, INTERRUPTED = 2, 1, 130
HERE = pathlib.Path(__file__).resolve().parent


def package_version():
    """From package.xml: three levels up in the source, one up where it is installed."""
    for directory in (HERE.parent, HERE.parent.parent.parent):
        path = directory / "package.xml"
        if path.is_file():
            return ElementTree.parse(path).getroot().findtext("version")
    raise Problem(f"{HERE}: no package.xml above it; the installation is not whole")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(WRONG_USAGE, f"{self.prog}: {' '.join(message.split())} (--help shows the options)\n")


class Version(argparse.Action):
    def __call__(self, parser, *_):
        print(f"hammer_loads {package_version()}")
        parser.exit(0)


def parser():
    result = Parser(
        prog="report", description="One page, and tables, from what process_bag --db and the ledgers hold.",
        epilog="The page needs no other file and no network. Two or more machines are compared. Errors are one line "
               "each; exit code 1, or 2 for wrong usage.")
    result.add_argument("files", nargs="+", metavar="FILE",
                        help="a database of process_bag --db, a ledger, a fleet's merged file, or a bag; splits of one "
                             "recording of the node count as one")
    result.add_argument("--html", metavar="OUT.html", help="page to write, which must not exist")
    result.add_argument("--csv", metavar="DIRECTORY", help="every table as CSV into a new directory")
    result.add_argument("--machine", metavar="NAME", help="of a fleet's merged file this machine alone")
    add_bag_options(result)
    result.add_argument("--force", action="store_true", help="replace what this command wrote")
    return result


def add_bag_options(to):
    to.add_argument("--params", action="append", default=[], metavar="FILE.yaml",
                    help="for bags: parameters, as of process_bag; may be repeated")
    to.add_argument("--urdf", metavar="FILE.urdf", help="for bags: robot description")
    to.add_argument("--reference", metavar="FILE.csv",
                    help="for bags: a measured load of the hull, as of process_bag")
    for topic, of in TOPICS.items():
        to.add_argument(f"--{topic}", metavar="TOPIC", help=f"for bags: of {of}; else as in their run_info")
    to.add_argument("--version", action=Version, nargs=0, help="print the version and end")


def run(given):
    if given.html is not None:
        output.check_file(given.html, given.files, given.force, output.why_page_must_stay)
    if given.csv is not None:
        needed = [*given.files, *([given.html] if given.html else [])]
        output.check_directory(given.csv, needed, given.force, csv_tables.why_directory_must_stay)
    with tempfile.TemporaryDirectory(prefix="hammer_loads_report") as folder:
        write(given, [Database(path) for path in databases(given, folder)])


def bag_options(given):
    """Options of process_bag that were given."""
    options = [word for file in given.params for word in ("--params", file)]
    for name in ("urdf", "reference", *TOPICS):
        value = getattr(given, name.replace("-", "_"))
        options += [f"--{name}", value] if value is not None else []
    return options


def databases(given, folder):
    """Paths in the order of the files given; the splits of one recording are one, at the place of the first."""
    splits_of = {splits[0]: splits for splits in bags.recordings(list(filter(bags.is_bag, given.files)))}
    later = {bag for splits in splits_of.values() for bag in splits[1:]}
    for path in given.files:
        if not bags.is_bag(path):
            yield path
        elif path not in later:
            yield bags.database_of(splits_of[path], bag_options(given), folder)


def write(given, databases):
    for note in notes(databases):
        print(one_line(f"note: {note}"), file=sys.stderr)
    if given.html is not None:
        from report import page  # here: tables and refusals need no pandas and no matplotlib
        content = page.page(databases, package_version(), given.machine)
        output.publish_file(given.html, content, given.force)
        print(f"{given.html}: {len(databases)} file{'s' if len(databases) > 1 else ''}, {len(content) / 1e6:.2f} MB")
    if given.csv is not None:
        output.publish_directory(given.csv, lambda part: csv_tables.write_tables(databases, part), given.force)
        print(f"{given.csv}: {len(os.listdir(given.csv))} tables")


def main(arguments):
    """Exit code."""
    options = parser()
    given = options.parse_args(arguments)
    if given.html is None and given.csv is None:
        options.error("nothing to write: --html OUT.html, --csv DIRECTORY or both are needed")
    return guarded(run, given, options)


def guarded(run, given, options):
    """Exit code of run(given)."""
    if bag_options(given) and not any(map(bags.is_bag, given.files)):
        options.error("--params, --urdf and topics are for bags; a database has its parameters")
    warnings.simplefilter("ignore")  # of numpy: what is no number is shown as such; stderr has this command's own lines alone
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(name) != signal.SIG_IGN:
            signal.signal(name, Interrupt.handler)
    try:
        run(given)
        return 0
    except Problem as problem:
        print(problem, file=sys.stderr)
        return FAILURE
    except (ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError, TypeError, ValueError) as error:
        # What stands in the tables is no number, too large, or missing where the page must have it.
        print(one_line(f"{', '.join(given.files)}: damaged, or not as this package writes it "
                       f"({type(error).__name__}: {error})"), file=sys.stderr)
        return FAILURE
    except KeyboardInterrupt:
        print("interrupted: nothing is written", file=sys.stderr)
        return INTERRUPTED
