"""Inputs of the commands: databases, and bags, of which process_bag makes databases that are gone when the command ends."""
import os
import pathlib
import subprocess
import sys

from report.database import Database, Problem

TOPICS = {"crank-topic": "the crank's samples", "joint-states-topic": "the boom's joints", "imu-topic": "the hull's IMU",
          "pressures-topic": "the cylinders' pressures, a prefix", "reference-topic": "a measured load on the hull"}
HERE = pathlib.Path(__file__).resolve().parent
FOLDERS = [HERE.parents[2] / place / "lib" / "hammer_loads" for place in ("build/devel", "devel", "")]  # of source or prefix


def add_bag_options(parser):
    parser.add_argument("--params", action="append", default=[], metavar="FILE.yaml",
                        help="for bags: parameters, as of process_bag; may be repeated")
    parser.add_argument("--urdf", metavar="FILE.urdf", help="for bags: robot description")
    parser.add_argument("--reference", metavar="FILE.csv", help="for bags: a measured load of the hull, as of process_bag")
    for topic, words in TOPICS.items():
        parser.add_argument(f"--{topic}", metavar="TOPIC", help=f"for bags: of {words}; else as in their run_info")


def bag_options(given):
    """Options of process_bag that were given."""
    options = [word for file in given.params for word in ("--params", file)]
    for name in ("urdf", "reference", *TOPICS):
        value = getattr(given, name.replace("-", "_"))
        options += [f"--{name}", value] if value is not None else []
    return options


def program(name):
    """Path of a command: in the folder HAMMER_LOADS_PROGRAMS, else beside this command, in the build or the installation."""
    chosen = os.environ.get("HAMMER_LOADS_PROGRAMS")
    for folder in [chosen] if chosen else [pathlib.Path(sys.argv[0]).absolute().parent, *FOLDERS]:
        path = pathlib.Path(folder) / name
        if path.exists():
            return str(path)
    raise Problem(f"{path}: does not exist; needs the built command {name}, in the folder HAMMER_LOADS_PROGRAMS if set")


def is_bag(name):
    return name.endswith(".bag")


def recordings(bags):
    """Lists of bags: the splits of one recording in their order, as process_bag finds them; every other bag alone."""
    alone = [[bag] for bag in bags]
    if len(bags) < 2:
        return alone
    done = subprocess.run([program("process_bag"), "--recordings", *bags], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, encoding="utf-8", errors="surrogateescape")
    splits_of = {}
    for line in done.stdout.splitlines():
        number, _, bag = line.partition(" ")
        splits_of.setdefault(number, []).append(bag)
    found = list(splits_of.values())
    whole = done.returncode == 0 and sorted(bag for splits in found for bag in splits) == sorted(bags)
    return found if whole else alone


def process(splits, options, database, **streams):
    """The process_bag that has made the database, or that could not."""
    return subprocess.run([program("process_bag"), "--no-bag", *splits, "--db", database, *options],
                          stdout=subprocess.DEVNULL, **streams)


def database_of(splits, options, folder):
    """Path of a new database in the folder, named as the recording's first bag; the messages of process_bag go to stderr."""
    place = pathlib.Path(folder) / str(len(os.listdir(folder)))
    place.mkdir()
    database = str(place / (pathlib.Path(splits[0]).stem + ".sqlite"))
    done = process(splits, options, database)
    if done.returncode != 0:
        raise Problem(f"{splits[0]}: process_bag ended with code {done.returncode}, nothing is written")
    return database


def databases(given, folder):
    """Databases in the order of the files given; the splits of one recording are one, at the place of the first."""
    splits_of = {splits[0]: splits for splits in recordings(list(filter(is_bag, given.files)))}
    later = {bag for splits in splits_of.values() for bag in splits[1:]}
    for path in given.files:
        if not is_bag(path):
            yield Database(path)
        elif path not in later:
            yield Database(database_of(splits_of[path], bag_options(given), folder))
