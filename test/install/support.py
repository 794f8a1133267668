"""The build under test, and commands as a user's shell runs them."""
import os
import pathlib
import re
import subprocess

import pytest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
PROGRAMS = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"])
BUILD = PROGRAMS.parents[2]
LIBRARIES = PROGRAMS.parent
CACHE = dict(re.findall(r"^(\w+):\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.M))
PREFIX = pathlib.Path(CACHE["CMAKE_INSTALL_PREFIX"])
OF_ROS = ("CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH", "PKG_CONFIG_PATH", "PYTHONPATH", "LD_LIBRARY_PATH")


def run(command, **options):
    """The finished command of bash, whose environment leads to no build; what it says is in stdout."""
    environment = {name: value for name, value in os.environ.items() if name not in OF_ROS}
    return subprocess.run(["bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          env=environment, **options)


def said(command, **options):
    """Output of a command that must end well."""
    done = run(command, **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}"
    return done.stdout


def configure(source, build, *options):
    return f'cmake -G "{CACHE["CMAKE_GENERATOR"]}" -S {source} -B {build} {" ".join(map(str, options))}'


needs_own_prefix = pytest.mark.skipif(BUILD not in PREFIX.parents, reason=f"{PREFIX} is not of this build")
