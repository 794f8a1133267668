"""Helpers of the module's tests."""
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
# Of this build, else as PYTHONPATH has it.
sys.path[:0] = [str(HERE), str(HERE.parent / "report"), *filter(None, [os.environ.get("HAMMER_LOADS_MODULES")])]


def message(call, *arguments, **options):
    """The text of the ValueError that a call must raise."""
    try:
        call(*arguments, **options)
    except ValueError as error:
        return str(error)
    raise AssertionError("raised nothing")
