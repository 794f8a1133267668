"""The command check: what a stranger's first recording has wrong is named, and a sound one passes."""
import json
import math

import pytest

from support import DATA, SOURCE, assert_refused, needs_programs, report_here
from report.check import BY_KEY

SOUND = DATA / "mo100_1khz.bag"
SECONDS = 8.0  # of the sound recording that are altered


def check(*arguments):
    return report_here(*arguments, command="check")


@pytest.fixture
def altered(tmp_path):
    """The begin of the sound recording with change(position, velocity) at each crank sample."""
    def write(change):
        import rosbag
        path, begin = tmp_path / "altered.bag", None
        with rosbag.Bag(str(SOUND)) as source, rosbag.Bag(str(path), "w") as target:
            for topic, message, time in source.read_messages():
                begin = begin or time
                if (time - begin).to_sec() > SECONDS:
                    break
                if topic == "/hammer/crank" and message.position:
                    position, velocity = change(message.position[0], message.velocity[0] if message.velocity else None)
                    message.position, message.velocity = [position], [] if velocity is None else [velocity]
                target.write(topic, message, time)
        return path
    return write


def statuses(done):
    recording, = json.loads(done.stdout)["recordings"]
    return {line["check"]: line["status"] for line in recording["checks"]}, recording["verdict"]


@needs_programs
def test_sound_recording_has_no_line_that_is_wrong():
    done = check(SOUND, "--json")
    found, verdict = statuses(done)
    assert done.returncode == 0
    assert [found[name] for name in ("unit", "blows", "consistency")] == ["ok"] * 3
    assert len(found) >= 10
    assert verdict.startswith("usable")


@needs_programs
def test_text_fits_one_screen_and_states_the_action(altered):
    done = check(altered(lambda p, v: (math.degrees(p), math.degrees(v))))
    assert done.returncode == 1
    assert len(done.stdout.splitlines()) <= 14
    assert "wrong unit" in done.stdout and "radians" in done.stdout


@needs_programs
@pytest.mark.parametrize("name, change, expected", [
    ("unit", lambda p, v: (p / (2 * math.pi), v / (2 * math.pi)), ("wrong",)),
    ("direction", lambda p, v: (-p, -v), ("wrong",)),
    ("zero", lambda p, v: (p + math.radians(5.0), v), ("look", "wrong"))])
def test_wrong_unit_direction_and_zero_are_named(altered, name, change, expected):
    done = check(altered(change), "--json")
    found, _ = statuses(done)
    assert found[name] in expected
    assert done.returncode == ("wrong" in found.values())


def test_every_key_is_one_that_the_programs_give():
    source = "".join(path.read_text() for path in (SOURCE / "src").rglob("*.[ch]*") if path.suffix in (".cpp", ".h"))
    assert [key for key in BY_KEY if f'"{key}"' not in source] == []


def test_wrong_usage_is_refused():
    assert_refused(check("a.sqlite"), "must be a bag", code=2)
