#!/usr/bin/env python3
"""report, budget, check and test_report, by its name: pages and figures of recordings and ledgers."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SHARE = pathlib.Path("share") / "hammer_loads"
for home in (HERE.parent, HERE.parents[1] / SHARE, HERE.parent / SHARE):  # in the source, installed with ROS, without
    if (home / "report" / "command.py").is_file():
        sys.path.insert(0, str(home))
        break
sys.dont_write_bytecode = True  # the source tree stays as it is

name = pathlib.Path(sys.argv[0]).stem
try:
    from report.command import main  # the path must be set first
    sys.exit(main(sys.argv[1:], name if name in ("budget", "check", "test_report") else "report"))
except ImportError as error:
    sys.exit(f"{name}: {error}; needs the Python packages pandas, jinja2 and matplotlib")
