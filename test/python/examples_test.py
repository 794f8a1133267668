"""Each example as its user runs it, and what the design finds."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import support

import hammer_loads_py as hl
import numpy as np
import sample_database

EXAMPLES = support.SOURCE / "examples"
BAG = support.SOURCE / "test" / "data" / "mo100_100hz.bag"
sys.path.insert(0, str(EXAMPLES))
import design  # noqa: E402

try:
    import rosbag
except ImportError:
    rosbag = None


def run(name, *arguments):
    home = str(pathlib.Path(hl.__file__).parents[1])
    environment = dict(os.environ, PYTHONPATH=home + os.pathsep + os.environ.get("PYTHONPATH", ""))
    done = subprocess.run([sys.executable, str(EXAMPLES / name), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def is_picture(path):
    return path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" and path.stat().st_size > 5000


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.picture = pathlib.Path(self.folder.name) / "out.png"

    def test_turn_writes_figures_and_a_picture(self):
        out = run("turn.py", support.SOURCE / "config" / "hammer_mo100.yaml", "--png", self.picture)
        self.assertIn("amplitude: ", out)
        self.assertTrue(is_picture(self.picture))

    def test_own_geometry_names_the_change_point(self):
        lines = run("own_geometry.py").splitlines()
        self.assertEqual(lines[1].split()[0], "MO-100")
        self.assertIn("rod_length_m", lines[-1])

    def test_database(self):
        path = os.path.join(self.folder.name, "work.sqlite")
        sample_database.make(path, seconds=30.0)
        out = run("database.py", path, "--png", self.picture)
        self.assertIn("energy", out)
        self.assertTrue(is_picture(self.picture))

    @unittest.skipUnless("HAMMER_LOADS_PROGRAMS" in os.environ, "no process_bag: built without ROS")
    def test_a_bags_database_is_read(self):
        programs = os.environ["HAMMER_LOADS_PROGRAMS"]
        path = os.path.join(self.folder.name, "bag.sqlite")
        subprocess.run([os.path.join(programs, "process_bag"), str(BAG), "--no-bag", "--db", path], check=True,
                       stderr=subprocess.DEVNULL)
        tables = hl.read_database(path)
        self.assertEqual(len(tables["blows"]["turn"]), tables["runs"]["blows"][0])
        self.assertGreater(len(tables["blows"]["turn"]), 100)
        self.assertIn("energy", run("database.py", path))

    @unittest.skipIf(rosbag is None, "no rosbag on this machine")
    def test_design_improves_the_hammer_of_a_bag(self):
        rows = {line[:34].strip(): line[34:].split() for line in run("design.py", BAG).splitlines()}
        before, after = map(float, rows["boom load [N m/J]"])
        self.assertLess(after, 0.97 * before)
        for column in (0, 1):
            crank, rod, pivot, rocker = (float(rows[key + "_m"][column]) for key in
                                         ("crank_length", "rod_length", "pivot_distance", "rocker_length"))
            self.assertAlmostEqual(crank + rod, pivot + rocker, delta=3e-5)  # as printed


class Design(unittest.TestCase):
    hammer = hl.Hammer.from_yaml()
    poses = np.array([[-0.35, 1.2, -0.85], [-0.5, 1.0, -0.3], [0.1, 0.9, -1.4]])

    def levers(self):
        return design.levers_of(self.poses, design.offsets_of(support.SOURCE / "urdf" / "eo2621_mo100.urdf"))

    def test_levers_are_those_of_turned_links(self):
        """Complex numbers instead of matrices: a turn about +y by q is a factor e^(-i q) on x + i z."""
        boom, arm, hammer = 2.6, 1.7, 0.10 - 0.55j
        for pose, lever in zip(self.poses, self.levers()):
            q1, q12, q123 = np.cumsum(pose)
            hull = boom * np.exp(-1j * q1) + arm * np.exp(-1j * q12) + hammer * np.exp(-1j * q123)
            for j, joint in enumerate((0.0, boom * np.exp(-1j * q1), boom * np.exp(-1j * q1) + arm * np.exp(-1j * q12))):
                in_hull = (hull - joint) * np.exp(1j * q123)
                np.testing.assert_allclose(lever[j], [in_hull.real, in_hull.imag], atol=1e-14)

    def test_working_turn_has_the_impulses_of_a_turn(self):
        """The links' momentum along x is none at both its ends, that along z is what the blow takes."""
        x, z, _, weight = design.working_turn(self.hammer)
        self.assertAlmostEqual(weight.sum(), 1.0)
        self.assertAlmostEqual((x * weight).sum() / abs(x).max(), 0.0, delta=5e-3)
        self.assertGreater((z * weight).sum(), 0.0)

    def test_gradient_is_the_slope_of_the_load(self):
        levers, factors = self.levers(), np.array([0.98, 1.01, 1.02, 0.97, 1.0, 1.05, 0.99])
        told = design.gradient(self.hammer, factors, levers)
        for key, slope, step in zip(design.CHANGED, told, 1e-3 * np.eye(len(factors))):
            load = [design.boom_load(design.designed(self.hammer, factors + k * step), levers) for k in (-2, -1, 1, 2)]
            self.assertAlmostEqual(slope, np.dot([1.0, -8.0, 8.0, -1.0], load) / 12e-3, delta=1e-6 * abs(told).max(),
                                   msg=key)

    def test_found_design_is_better_and_keeps_the_change_point(self):
        levers = self.levers()
        found = design.best(self.hammer, levers, 0.05)
        self.assertLess(design.boom_load(found, levers), 0.99 * design.boom_load(self.hammer, levers))
        p = found.parameters
        self.assertAlmostEqual(p["crank_length_m"] + p["rod_length_m"], p["pivot_distance_m"] + p["rocker_length_m"],
                               delta=1e-15)
        self.assertEqual([note for note in found.notes if not note.startswith("standard deviations")], [])
        for key in design.CHANGED:
            self.assertLessEqual(abs(p[key] / self.hammer.parameters[key] - 1.0), 0.05 + 1e-9, key)
        blow = found.blow(20.0, level="rocker")
        self.assertLess(abs(blow["support_impulse_z"]), 1e-9 * blow["tool_impulse_z"])

    def test_the_ideal_centre_of_mass_is_the_papers(self):
        """P1 (18), and with friction, a face off the line and a rod's mass what momentum demands (doc/model.md, 5)."""
        x, z = design.ideal_centre_of_mass(mass=35.2, inertia_about_pivot=0.737, striking_point=(-0.1975, 0.0))
        self.assertAlmostEqual(x, -0.737 / (35.2 * 0.1975), delta=1e-6)
        self.assertAlmostEqual(z, 0.0, delta=1e-6)
        k, n, rod, f = (-0.19, -0.03), (-0.08, -0.09), 2.5, 0.15
        x, z = design.ideal_centre_of_mass(mass=35.2, inertia_about_pivot=0.737, striking_point=k, rod_joint=n,
                                           reduced_rod_mass=rod, friction=f)
        inertia = 0.737 + rod * (n[0] ** 2 + n[1] ** 2)
        # Before the blow K moves by w (-z, x), w > 0: along +x, so friction pushes the rocker along -x.
        along = inertia / (-k[0] + f * abs(k[1]))
        self.assertAlmostEqual(35.2 * x + rod * n[0], -along, delta=35e-6)
        self.assertAlmostEqual(35.2 * z + rod * n[1], -f * along, delta=35e-6)


if __name__ == "__main__":
    unittest.main()
