"""Where the package's programs are: beside the source's build, or installed."""
import os
import pathlib
import subprocess

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


def recordings(bags):
    """Lists of bags: splits of one recording in their order, as process_bag finds them; every other bag alone."""
    done = subprocess.run([program("process_bag"), "--recordings", *bags], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, encoding="utf-8", errors="surrogateescape")
    splits_of = {}
    for line in done.stdout.splitlines():
        number, _, bag = line.partition(" ")
        splits_of.setdefault(number, []).append(bag)
    found = list(splits_of.values())
    whole = done.returncode == 0 and sorted(bag for splits in found for bag in splits) == sorted(bags)
    return found if whole else [[bag] for bag in bags]
