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


def database_of(bag, parameters, urdf, folder):
    """Path of a new database in the folder, named as the bag; what process_bag says goes to stderr."""
    if not os.path.isfile(bag):
        raise Problem(f"{bag}: " + ("is no regular file" if os.path.exists(bag) else "cannot be read: No such file"))
    place = pathlib.Path(folder) / str(len(os.listdir(folder)))
    place.mkdir()
    database = str(place / (pathlib.Path(bag).stem + ".sqlite"))
    arguments = [program(), "--no-bag", bag, "--db", database]
    for file in parameters:
        arguments += ["--params", file]
    if urdf is not None:
        arguments += ["--urdf", urdf]
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL)
    if done.returncode != 0:
        raise Problem(f"{bag}: {PROGRAM} ended with code {done.returncode}, there is no page")
    return database
