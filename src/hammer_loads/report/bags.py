"""Bags as inputs: process_bag makes a database of each, which is gone when the page is done."""
import os
import pathlib
import subprocess
import sys

from report.problem import Problem

PROGRAM = "process_bag"


def program():
    """Beside this command where it was built or installed; HAMMER_LOADS_PROGRAMS names another folder."""
    folder = os.environ.get("HAMMER_LOADS_PROGRAMS") or pathlib.Path(sys.argv[0]).absolute().parent
    path = pathlib.Path(folder) / PROGRAM
    if not path.exists():
        raise Problem(f"{path}: does not exist; a bag needs the built command {PROGRAM}")
    return str(path)


def is_bag(name):
    return name.endswith(".bag")


def recordings(bags, process_bag=None):
    """Lists of bags: the splits of one recording in their order, as process_bag finds them; every other bag alone.
    process_bag: path of that program."""
    if len(bags) < 2:
        return [[bag] for bag in bags]
    done = subprocess.run([process_bag or program(), "--recordings", *bags], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          encoding="utf-8", errors="surrogateescape")
    splits_of = {}
    for line in done.stdout.splitlines():
        number, _, bag = line.partition(" ")
        splits_of.setdefault(number, []).append(bag)
    found = list(splits_of.values())
    whole = done.returncode == 0 and sorted(bag for splits in found for bag in splits) == sorted(bags)
    return found if whole else [[bag] for bag in bags]


def process(splits, options, database, **streams):
    """The process_bag that has made the database, or that could not."""
    return subprocess.run([program(), "--no-bag", *splits, "--db", database, *options], stdout=subprocess.DEVNULL, **streams)


def database_of(splits, options, folder):
    """Path of a new database in the folder, named as the recording's first bag; the messages of process_bag go to stderr.
    options: of process_bag, for parameters and topics."""
    for bag in splits:
        if not os.path.isfile(bag):
            raise Problem(f"{bag}: " + ("is no regular file" if os.path.exists(bag) else "cannot be read: No such file"))
    place = pathlib.Path(folder) / str(len(os.listdir(folder)))
    place.mkdir()
    database = str(place / (pathlib.Path(splits[0]).stem + ".sqlite"))
    done = process(splits, options, database)
    if done.returncode != 0:
        raise Problem(f"{splits[0]}: {PROGRAM} ended with code {done.returncode}, nothing is written")
    return database
