"""Measurements of real machines, where HAMMER_LOADS_REAL_DATA says; commands of this build."""
import functools
import os
import pathlib
import subprocess
import sys
import tempfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CRANE = ROOT / "examples" / "loader_crane"
DAY = ["Dual1SineRun_230425", "Dual2SineTest_230425", "JibSineTest_230425", "MainSineTest_230425",
       "RampDisturbanceTest_230425"]
FAULTY = "DefectXSensor_09052025"


def real_data():
    folder = os.environ.get("HAMMER_LOADS_REAL_DATA")
    if not folder:
        pytest.skip("HAMMER_LOADS_REAL_DATA is not set")
    return pathlib.Path(folder).resolve()


def run(command, *arguments):
    program = pathlib.Path(os.environ["HAMMER_LOADS_PROGRAMS"]) / command
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False, timeout=600)


@functools.lru_cache(maxsize=None)
def crane_bags():
    """A folder with the crane's bags and stroke tables."""
    source = real_data() / "loader_crane"
    folder = pathlib.Path(tempfile.mkdtemp(prefix="loader_crane_"))
    done = subprocess.run([sys.executable, CRANE / "convert", source, folder], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    return folder


def weigh(names, output):
    bags = [crane_bags() / f"{name}.bag" for name in names]
    return run("calibrate", "--boom", *bags, "--params", CRANE / "boom.yaml", "--urdf", CRANE / "crane.urdf", "--write",
               output)
