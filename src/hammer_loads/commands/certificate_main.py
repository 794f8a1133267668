#!/usr/bin/env python3
"""certificate: what was measured, with which uncertainty, and how that is known, on one page."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SHARE = pathlib.Path("share") / "hammer_loads"
for home in (HERE.parent, HERE.parents[1] / SHARE, HERE.parent / SHARE):  # in the source, installed with ROS, without
    if (home / "report" / "certificate_command.py").is_file():
        sys.path.insert(0, str(home))
        break
sys.dont_write_bytecode = True  # the source tree stays as it is

from report.certificate_command import main  # noqa: E402  (the path must be set first)

sys.exit(main(sys.argv[1:]))
