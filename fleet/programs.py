"""Locations of the package's programs, in the source's build or installed, and of its Python modules."""
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
PLACES = (HERE.parent / "build" / "devel" / "lib" / "hammer_loads", HERE.parent / "devel" / "lib" / "hammer_loads",
          HERE.parent.parent.parent / "lib" / "hammer_loads")
for home in (HERE.parent / "src" / "hammer_loads", HERE.parent):  # in the source, installed
    if (home / "report").is_dir():
        sys.path.insert(0, str(home))
        break

from report import bags as inputs  # noqa: E402  (the path must be set first)


def program(name):
    """Path; HAMMER_LOADS_PROGRAMS names another folder."""
    given = os.environ.get("HAMMER_LOADS_PROGRAMS")
    for place in ([pathlib.Path(given)] if given else PLACES):
        if (place / name).exists():
            return str(place / name)
    raise FileNotFoundError(f"{name}: not built; build the package, or name the folder in HAMMER_LOADS_PROGRAMS")


def recordings(bags):
    """Lists of bags: splits of one recording in their order; every other bag alone."""
    return inputs.recordings(bags, program("process_bag"))
