"""Scripts explain themselves and then do nothing else."""
import os
import subprocess
import sys

import pytest

from support import SOURCE, run, said

SCRIPTS = [path for path in sorted((SOURCE / "scripts").iterdir()) if path.is_file() and os.access(path, os.X_OK)]

# As roslaunch: starts a process, hears SIGINT, ends the process with SIGINT.
PARENT = """
import signal, subprocess, sys
class Interrupted(Exception): pass
def hear(*_): raise Interrupted
signal.signal(signal.SIGINT, hear)
child = subprocess.Popen(sys.argv[1:], start_new_session=True)
try:
    print('ended by itself', child.wait(timeout=120))
except Interrupted:
    alive = child.poll() is None
    child.send_signal(signal.SIGINT)
    print('interrupted', alive, child.wait(timeout=120))
"""


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_each_explains_itself_on_help(script):
    text = said(f"{script} --help")
    assert len(text) > 60
    assert "installing:" not in text


@pytest.mark.parametrize("command, end", [("true", "interrupted True 0\n"), ("false", "ended by itself 1\n")])
def test_the_good_end_of_a_command_ends_all_and_a_bad_one_is_its_own(command, end):
    """A command that ended well lives on until it is interrupted."""
    done = subprocess.run([sys.executable, "-c", PARENT, str(SOURCE / "scripts" / "then_end"), command], stdout=subprocess.PIPE)
    assert done.stdout.decode() == end


def test_test_refuses_a_room_that_does_not_exist():
    done = run(f"{SOURCE}/scripts/test no_such_room")
    assert done.returncode == 2
    assert "no_such_room: must be a folder of" in done.stdout
