#!/usr/bin/env python3
"""report, budget, check and test_report, by its name: pages and figures of recordings and ledgers."""
import importlib
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SHARE = pathlib.Path("share") / "hammer_loads"
for home in (HERE.parent, HERE.parents[1] / SHARE, HERE.parent / SHARE):  # in the source, installed with ROS, without
    if (home / "report" / "command.py").is_file():
        sys.path.insert(0, str(home))
        break
sys.dont_write_bytecode = True  # the source tree stays as it is

MODULES = {"report": "command", "budget": "budget", "check": "check", "test_report": "test_report"}
name = pathlib.Path(sys.argv[0]).stem
try:
    sys.exit(importlib.import_module("report." + MODULES.get(name, "command")).main(sys.argv[1:]))
except ImportError as error:
    sys.exit(f"{name}: {error}; needs the Python packages pandas, jinja2 and matplotlib")
