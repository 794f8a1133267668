#!/usr/bin/env python3
"""report: one page, and tables, from what process_bag --db and the ledgers hold."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SHARE = pathlib.Path("share") / "hammer_loads"
for home in (HERE.parent, HERE.parents[1] / SHARE, HERE.parent / SHARE):  # in the source, installed with ROS, without
    if (home / "report" / "command.py").is_file():
        sys.path.insert(0, str(home))
        break
sys.dont_write_bytecode = True  # the source tree stays as it is

from report.command import main  # noqa: E402  (the path must be set first)

sys.exit(main(sys.argv[1:]))
