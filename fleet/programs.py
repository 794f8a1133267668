"""Where the package's programs are: beside the source's build, or installed."""
import os
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
PLACES = (HERE.parent / "build" / "devel" / "lib" / "hammer_loads", HERE.parent / "devel" / "lib" / "hammer_loads",
          HERE.parents[2] / "lib" / "hammer_loads")


def program(name):
    """Path; HAMMER_LOADS_PROGRAMS names another folder."""
    given = os.environ.get("HAMMER_LOADS_PROGRAMS")
    for place in ([pathlib.Path(given)] if given else PLACES):
        if (place / name).exists():
            return str(place / name)
    raise FileNotFoundError(f"{name}: not built; build the package, or name the folder in HAMMER_LOADS_PROGRAMS")
