"""Command line of certificate."""
import tempfile

from report import output, page
from report.certificate import certificate
from report.command import Parser, add_bag_options, databases, guarded, package_version
from report.database import RECORDING, Database
from report.problem import Problem
from report.subjects import subjects_of


def parser():
    result = Parser(
        prog="certificate", description="A test certificate of one recording: results with their uncertainty, inputs, checks, method.",
        epilog="One page of A4; the same bags, parameters and version give the same bytes. Words and rules are those of "
               "JCGM 100:2008. Errors are one line each; exit code 1, or 2 for wrong usage.")
    result.add_argument("files", nargs="+", metavar="FILE",
                        help="bags of one machine, or a database of process_bag --db; splits of one recording count as one")
    result.add_argument("--html", required=True, metavar="OUT.html", help="page to write, which must not exist")
    result.add_argument("--machine", metavar="NAME", help="of a file with more than one")
    result.add_argument("--force", action="store_true", help="replace a page of this package")
    add_bag_options(result)
    return result


def the_subject(paths, machine):
    found = [s for path in paths for s in subjects_of(Database(path), machine) if s.database.kind == RECORDING]
    if len(found) != 1:
        raise Problem(f"a certificate is of one machine's recording, not of {len(found)}"
                      + (": " + ", ".join(s.label for s in found) if found else ""))
    return found[0]


def run(given):
    output.check_file(given.html, given.files, given.force, page.why_page_must_stay)
    with tempfile.TemporaryDirectory(prefix="hammer_loads_certificate") as folder:
        content = certificate(the_subject(databases(given, folder), given.machine), package_version())
    output.publish_file(given.html, content, given.force)
    print(f"{given.html}: {len(content) / 1e3:.0f} kB")


def main(arguments):
    """Exit code."""
    options = parser()
    return guarded(run, options.parse_args(arguments), options)
