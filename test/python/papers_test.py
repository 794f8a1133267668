"""The papers' figures as examples/papers.py gives them, beside Newton and Euler, the documents and the shipped boom."""
import os
import pathlib
import re
import sys
import tempfile
import unittest

import examples_test
import newton_euler
import support

import hammer_loads_py as hl
import numpy as np
from scipy import integrate, optimize

sys.path.insert(0, str(support.SOURCE / "examples"))
import design  # noqa: E402
import papers  # noqa: E402
import papers_impact  # noqa: E402
from working_turn import WHOLE, Turn  # noqa: E402

DOCUMENTS = support.SOURCE / "doc"
SHIPPED = hl.Hammer.from_yaml()


class Independent:
    """A revolution by loop closure and energy; at the blow by the loop's first and second derivatives."""

    def __init__(self, p, speed=None, energy=None):
        self.p = p
        l1, l2, l3 = (p[k] for k in ("crank_length_m", "rod_length_m", "rocker_length_m"))
        # l2 v = l3 u - l1 and l1 + l2 v^2 = l3 u^2
        both = np.roots([l3 * (l3 - l2), -2.0 * l1 * l3, l1 * (l1 + l2)])
        self.u_before, self.u_after = sorted(both)
        self.inertia, self.drive = p["rocker_inertia_about_pivot_kg_m2"], p["drive_inertia_kg_m2"]
        self.first = p["rocker_mass_kg"] * p["rocker_com_distance_m"]
        self.constant = speed
        self.torque = 0.0 if speed else energy / WHOLE
        self.at_blow = speed or np.sqrt(2.0 * energy / (self.inertia * (self.u_before ** 2 - self.u_after ** 2)))

    def motion(self, angle):
        """u, u', crank speed and acceleration; away from the blow."""
        linkage = newton_euler.Linkage(self.p, np.atleast_1d(angle), 1.0, 0.0)
        u, du = linkage.u, linkage.ua
        if self.constant:
            return u, du, self.constant + 0.0 * u, 0.0 * u
        whole = self.drive + self.inertia * u ** 2
        start = (self.drive + self.inertia * self.u_after ** 2) * self.at_blow ** 2
        w = np.sqrt((start + 2.0 * self.torque * np.atleast_1d(angle)) / whole)
        return u, du, w, (self.torque - self.inertia * u * du * w ** 2) / whole

    def force(self, angle, name):
        _, _, w, e = self.motion(angle)
        return newton_euler.loads(self.p, np.atleast_1d(angle), w, e, massless=True)[name][0]

    def momentum(self, angle):
        """Momentum of the rocker along x and z [N s]."""
        u, _, w, _ = self.motion(angle)
        linkage = newton_euler.Linkage(self.p, np.atleast_1d(angle), 1.0, 0.0)
        psi = np.angle(linkage.c - linkage.d)
        return (self.first * u * w * np.sin(psi))[0], (self.first * u * w * np.cos(psi))[0]

    def period(self):
        return integrate.quad(lambda a: 1.0 / self.motion(a)[2][0], 1e-5, WHOLE - 1e-5, limit=400,
                              epsabs=1e-13, epsrel=1e-12)[0] + 2e-5 / self.at_blow


class Figures(unittest.TestCase):
    """H, Q, T and the halves and the peak of Fx, to 1e-9."""

    def check(self, turn, truth):
        found = turn.half_sine()
        peak = optimize.minimize_scalar(lambda a: -truth.force(a, "force_z"), method="bounded",
                                        bounds=(found["angle"] - 0.01, found["angle"] + 0.01), options={"xatol": 1e-9})
        self.assertAlmostEqual(found["H"] / -peak.fun, 1.0, delta=1e-9)
        rise = max(z for z in turn.zeros(1) if z < found["angle"])
        rise = optimize.brentq(lambda a: truth.force(a, "force_z"), rise - 1e-3, rise + 1e-3, xtol=1e-13)
        impulse = truth.momentum(rise)[1] - truth.first * truth.u_before * truth.at_blow
        self.assertAlmostEqual(found["S"] / impulse, 1.0, delta=1e-9)
        self.assertAlmostEqual(found["mu"] * impulse / (2.0 * -peak.fun), 1.0, delta=2e-9)
        self.assertAlmostEqual(found["T"] / truth.period(), 1.0, delta=1e-9)
        self.assertAlmostEqual(found["t1"] / (truth.period() - np.pi * impulse / (2.0 * -peak.fun)), 1.0, delta=1e-8)
        # Along x the rocker has no momentum at the blow.
        zeros = [optimize.brentq(lambda a: truth.force(a, "force_x"), z - 1e-3, z + 1e-3, xtol=1e-13)
                 for z in turn.zeros(0)]
        at = [0.0] + [truth.momentum(z)[0] for z in zeros] + [0.0]
        parts = [before - after for before, after in zip(at, at[1:])]
        pushes, pulls = turn.halves_of_x()
        self.assertAlmostEqual(pushes / sum(p for p in parts if p > 0.0), 1.0, delta=1e-9)
        self.assertAlmostEqual(pulls / sum(p for p in parts if p < 0.0), 1.0, delta=1e-9)
        least = -truth.first * (truth.u_before * truth.at_blow) ** 2
        self.assertAlmostEqual(turn.extreme(0, -1.0)[0] / least, 1.0, delta=1e-9)

    def test_loads_at_the_papers_speed_are_those_of_an_independent_model(self):
        self.check(Turn.at_speed(SHIPPED, papers.SPEED), Independent(SHIPPED.parameters, speed=papers.SPEED))

    def test_loads_at_1000_joules_are_those_of_an_independent_model(self):
        self.check(Turn.at_energy(SHIPPED, papers.ENERGY), Independent(SHIPPED.parameters, energy=papers.ENERGY))

    def test_half_sine_is_that_of_the_package(self):
        found, own = Turn.at_speed(SHIPPED, papers.SPEED).half_sine(), SHIPPED.pulse(papers.SPEED, level="rocker")
        for key, name in (("H", "amplitude"), ("S", "impulse"), ("mu", "angular_frequency"), ("t1", "start")):
            self.assertAlmostEqual(found[key] / own[name], 1.0, delta=1e-10, msg=key)

    def test_printed_values_are_those_of_a_coarse_curve(self):
        """P0 read its curve at 350 deg."""
        at_350 = SHIPPED.wrenches(np.radians(350.0), papers.SPEED, level="rocker")["force_z"]
        self.assertAlmostEqual(at_350 / 39895.0, 1.0, delta=2e-4)


class Printed(unittest.TestCase):
    def test_reactions_hold_with_the_moment_about_the_centre_of_mass(self):
        angle = np.linspace(0.3, WHOLE - 0.05, 200)
        truth = newton_euler.loads(SHIPPED.parameters, angle, papers.SPEED, 0.0, massless=True)
        rod, _, _, x, z = papers.reactions(SHIPPED, angle, papers.SPEED, True)
        size = np.hypot(truth["R12_x"], truth["R12_z"])
        np.testing.assert_allclose(abs(rod), size, rtol=1e-8)
        np.testing.assert_allclose(x, truth["force_x"], atol=1e-9 * size.max())
        np.testing.assert_allclose(z, truth["force_z"], atol=1e-9 * size.max())

    def test_impulses_hold_where_the_errata_state_it(self):
        rocker, paper, lk, before = papers_impact.striking_rocker(SHIPPED)
        for z in (0.0, -0.005, -0.03):
            ours = papers_impact.impulses(rocker, lk, z, 0.2, before, 0.0)
            np.testing.assert_allclose(ours, papers_impact.printed_impact(*paper, (lk, z), 0.2, before), atol=1e-11)
        wrong = papers_impact.printed_impact(*paper, (lk, 0.02), 0.2, before)
        self.assertGreater(abs(papers_impact.impulses(rocker, lk, 0.02, 0.2, before, 0.0)[1] - wrong[1]), 1.0)


@unittest.skipUnless("HAMMER_LOADS_PROGRAMS" in os.environ, "no process_bag and grapple_table: built without ROS")
class Documents(unittest.TestCase):
    """A user's run of the example writes the values that the documents show."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        for name in ("model.md", "papers.md"):  # with empty tables
            text = (DOCUMENTS / name).read_text(encoding="utf-8")
            text = re.sub("(<!-- papers: \\S+ -->\n).*?(<!-- /papers -->)", r"\1\2", text, flags=re.S)
            (cls.folder / name).write_text(text, encoding="utf-8")
        cls.printed = examples_test.run("papers.py", "--documents", cls.folder, "--pictures", cls.folder)

    def test_show_every_table(self):
        for name in ("model.md", "papers.md"):
            written, shown = ((f / name).read_text(encoding="utf-8") for f in (self.folder, DOCUMENTS))
            self.assertEqual(written, shown)
        for name in papers.BLOCKS:
            self.assertIn(f"{name}\n| ", self.printed)

    def test_show_every_picture(self):
        drawn = {path.name for path in self.folder.glob("*.png")}
        self.assertEqual(drawn, {path.name for path in DOCUMENTS.glob("papers_*.png")})
        text = "".join(path.read_text(encoding="utf-8") for path in DOCUMENTS.glob("*.md"))
        for name in drawn:
            self.assertIn(f"]({name})", text)
            self.assertTrue(examples_test.is_picture(self.folder / name))


class Boom(unittest.TestCase):
    boom = papers.shipped_boom()
    pose = dict(zip(papers.PITCH_JOINTS, papers.POSES[0]))

    def test_a_rigid_boom_gives_the_torques_of_turned_links(self):
        offsets = design.offsets_of(support.SOURCE / "urdf" / "eo2621_mo100.urdf")
        levers = design.levers_of(np.array([papers.POSES[0]]), offsets)
        x, z, y = np.array([3e3, -2e3, 0.0]), np.array([8e3, 1e3, -5e2]), np.array([-700.0, 0.0, 90.0])
        found = self.boom.loads(self.pose, [0.0, 0.1, 0.2], x, z, y, compliant=False)
        for j, joint in enumerate(papers.PITCH_JOINTS):
            expected = y + levers[0, j, 1] * x - levers[0, j, 0] * z
            np.testing.assert_allclose(found[joint + "_torque_Nm"], expected, atol=1e-9)

    def test_an_elastic_boom_comes_to_rest_under_a_lasting_load(self):
        time = np.linspace(0.0, 40.0, 8001)
        one = np.ones_like(time)
        rigid = self.boom.loads(self.pose, [0.0], [2e3], [8e3], [-500.0], compliant=False)
        moving = self.boom.loads(self.pose, time, 2e3 * one, 8e3 * one, -500.0 * one)
        for name in rigid:
            size = abs(moving[name]).max()
            self.assertAlmostEqual(moving[name][-1], rigid[name][0], delta=1e-6 * size + 1e-6, msg=name)
        joint = "boom_joint_torque_Nm"
        self.assertGreater(np.ptp(moving[joint]), 0.5 * abs(rigid[joint][0]))

    def test_wrong_input_is_named(self):
        load = ([0.0, 1.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0])
        self.assertIn("elbow", support.message(self.boom.loads, {"elbow": 0.1}, *load))
        self.assertIn("time", support.message(self.boom.loads, self.pose, [1.0, 0.0], *load[1:]))
        self.assertIn("nothing.urdf", support.message(hl.Boom.from_yaml, "nothing.urdf"))
        self.assertEqual(len(self.boom.frequencies(self.pose)), 3)


if __name__ == "__main__":
    unittest.main()
