"""Sets the path of the Python package `report`, in the source or installed."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(home) for home in (HERE.parent / "src" / "hammer_loads", HERE.parent) if (home / "report").is_dir()]
