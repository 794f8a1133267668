"""Sets the path of the Python modules, in the source or installed, and finds the package's commands."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDERS = (HERE.parent / "build" / "devel" / "lib" / "hammer_loads", HERE.parent / "devel" / "lib" / "hammer_loads",
           HERE.parent.parent.parent / "lib" / "hammer_loads")
sys.path[:0] = [str(home) for home in (HERE.parent / "src" / "hammer_loads", HERE.parent) if (home / "report").is_dir()]

from report import inputs  # noqa: E402  (the path must be set first)


def program(name):
    """Path of a command; HAMMER_LOADS_PROGRAMS names another folder."""
    return inputs.program(name, FOLDERS)


def recordings(bags):
    """Lists of bags: splits of one recording in their order; every other bag alone."""
    return inputs.recordings(bags, program("process_bag"))
