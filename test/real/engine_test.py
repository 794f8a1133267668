"""The crank of a one-cylinder engine, fired and coasting, is no hammer's: every command refuses it."""
import lzma

import numpy as np
import pytest

import support


@pytest.fixture(scope="module", params=["E0NOLOAD2", "ENGINEOFF3"])
def engine_bag(request, tmp_path_factory):
    import rosbag
    import rospy
    from sensor_msgs.msg import JointState
    source = support.real_data() / "engine" / f"{request.param}.csv.xz"
    time, angle = np.loadtxt(lzma.open(source, "rt"), delimiter=",", skiprows=1).T
    path = tmp_path_factory.mktemp("engine") / f"{request.param}.bag"
    with rosbag.Bag(str(path), "w") as bag:
        for t, a in zip(time, angle):
            message = JointState(name=["hammer_crank_joint"], position=[a])
            message.header.stamp = rospy.Time.from_sec(1000.0 + t)
            bag.write("/hammer/crank", message, message.header.stamp)
    return path


def test_process_bag_publishes_no_wrench(engine_bag, tmp_path):
    done = support.run("process_bag", engine_bag, tmp_path / "out.bag")
    print(done.stdout, done.stderr)
    assert done.returncode == 1
    assert "no wrench" in done.stderr or "nothing" in done.stderr


def test_calibrate_refuses(engine_bag, tmp_path):
    done = support.run("calibrate", engine_bag, "--write", tmp_path / "found.yaml")
    print(done.stdout, done.stderr)
    assert done.returncode == 1
    assert not (tmp_path / "found.yaml").exists()
