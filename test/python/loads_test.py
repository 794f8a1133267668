"""Loads of many states against Newton and Euler in Python."""
import threading
import time
import unittest

import support  # noqa: F401  (the path must be set first)

import hammer_loads_py as hl
import newton_euler
import numpy as np

RANDOM = np.random.default_rng(20)
ANGLE = RANDOM.uniform(0.05, 2 * np.pi - 0.05, 500)
SPEED = RANDOM.uniform(-50.0, 50.0, 500)
ACCELERATION = RANDOM.uniform(-3e3, 3e3, 500)
PITCH = RANDOM.uniform(-1.5, 1.5, 500)
WRENCH = ["force_x", "force_z", "torque_y"]


class Loads(unittest.TestCase):
    hammer = hl.Hammer.from_yaml()

    def assert_like(self, got, right, names=None):
        """To 1e-11 of the column's largest value: next to the blow the circles nearly touch, and their intersection loses digits."""
        for name in names or right:
            size = abs(right[name]).max()
            self.assertGreater(size, 0.0, name)
            self.assertLess(abs(got[name] - right[name]).max() / size, 1e-11, name)

    def test_equals_newton_and_euler(self):
        got = self.hammer.wrenches(ANGLE, SPEED, ACCELERATION, level="linkage", pins=True)
        right = newton_euler.loads(self.hammer.parameters, ANGLE, SPEED, ACCELERATION)
        self.assertEqual(sorted(got), sorted(right))
        self.assert_like(got, right)

    def test_weight_by_one_pitch_and_by_each_state_s_own(self):
        for pitch in (0.3, PITCH):
            got = self.hammer.wrenches(ANGLE, SPEED, ACCELERATION, pitch=pitch, level="linkage", pins=True)
            self.assert_like(got, newton_euler.loads(self.hammer.parameters, ANGLE, SPEED, ACCELERATION, pitch))
        moon = self.hammer.wrenches(ANGLE, SPEED, pitch=PITCH, gravity=1.62, level="linkage")
        right = newton_euler.loads(self.hammer.parameters, ANGLE, SPEED, 0.0, PITCH, 1.62)
        self.assert_like(moon, right, WRENCH)

    def test_level_rocker_is_that_of_massless_crank_and_rod(self):
        got = self.hammer.wrenches(ANGLE, SPEED, ACCELERATION, pitch=0.2, level="rocker", pins=True)
        right = newton_euler.loads(self.hammer.parameters, ANGLE, SPEED, ACCELERATION, 0.2, massless=True)
        self.assert_like(got, right)

    def test_own_geometry_equals_newton_and_euler(self):
        own = self.hammer.changed(crank_length_m=0.06, rod_length_m=0.2, rocker_length_m=0.17, pivot_distance_m=0.09,
                                  rod_mass_kg=9.0, rocker_com_angle_deg=20.0)
        self.assertEqual(own.parameters["rod_mass_kg"], 9.0)
        self.assertEqual(self.hammer.parameters["rod_mass_kg"], 4.5)
        got = own.wrenches(ANGLE, SPEED, ACCELERATION, level="linkage", pins=True)
        self.assert_like(got, newton_euler.loads(own.parameters, ANGLE, SPEED, ACCELERATION))

    def test_shapes_are_numpy_s(self):
        right = self.hammer.wrenches(ANGLE[:6], SPEED[:6], ACCELERATION[:6], pitch=PITCH[:6])
        grid = self.hammer.wrenches(ANGLE[:6].reshape(2, 3), SPEED[:6].reshape(2, 3), ACCELERATION[:6].reshape(2, 3),
                                    pitch=PITCH[:6].reshape(2, 3))
        one = self.hammer.wrenches(ANGLE[0], SPEED[0], ACCELERATION[0], pitch=PITCH[0])
        strided = self.hammer.wrenches(np.repeat(ANGLE[:6], 2)[::2], list(SPEED[:6]), ACCELERATION[:6], pitch=PITCH[:6])
        crossed = self.hammer.wrenches(ANGLE[:6][:, None], SPEED[:2][None, :])
        for name in WRENCH:
            np.testing.assert_allclose(grid[name].ravel(), right[name], rtol=1e-12)
            np.testing.assert_array_equal(strided[name], right[name])
            self.assertEqual(one[name].shape, ())
            np.testing.assert_allclose(one[name], right[name][0], rtol=1e-12)
            self.assertEqual(crossed[name].shape, (6, 2))
            np.testing.assert_array_equal(crossed[name][:, 1], self.hammer.wrenches(ANGLE[:6], SPEED[1])[name])
            self.assertEqual(self.hammer.wrenches([], [])[name].shape, (0,))
        longer = np.resize(ANGLE, 20001)  # more than one piece
        np.testing.assert_array_equal(self.hammer.wrenches(longer, 31.0)[WRENCH[1]][-500:],
                                      self.hammer.wrenches(longer[-500:], 31.0)[WRENCH[1]])

    def test_the_blow_has_two_sides(self):
        before, after = (self.hammer.wrenches(x, 31.416, level="rocker")["force_x"] for x in (-1e-300, 0.0))
        self.assertAlmostEqual(float(before), -55448.8, delta=0.05)  # P0's figures, doc/model.md
        self.assertAlmostEqual(float(after), -35.2 * 0.106 * (0.6803499 * 31.416) ** 2, delta=0.5)

    def test_nan_stays_nan_and_a_too_large_value_is_named(self):
        got = self.hammer.wrenches([1.0, np.nan, 1.0], [1.0, 1.0, np.nan])
        np.testing.assert_array_equal(np.isnan(got[WRENCH[0]]), [False, True, True])
        self.assertEqual(support.message(self.hammer.wrenches, [1.0, 1e9], 1.0),
                         "crank_angle: must be a number of size <= 4e8 rad")
        self.assertIn("broadcast", support.message(self.hammer.wrenches, np.ones(3), np.ones(4)))

    def test_others_run_meanwhile(self):
        """While a long call computes, another thread of Python goes on: it counts what the lock would have stopped."""
        angle, ticks, done = np.resize(ANGLE, 300000), [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())

        thread = threading.Thread(target=tick)
        thread.start()
        try:
            begin = time.perf_counter()
            self.hammer.wrenches(angle, SPEED[0], pitch=angle, pins=True)
            end = time.perf_counter()
        finally:
            done.set()
            thread.join()
        inside = [t for t in ticks if begin + 0.2 * (end - begin) < t < begin + 0.8 * (end - begin)]
        self.assertGreater(len(inside), 0)


class Turn(unittest.TestCase):
    hammer = hl.Hammer.from_yaml()

    def test_figures_of_a_revolution_are_the_model_page_s(self):
        pulse = self.hammer.pulse(31.416, level="rocker")
        for name, value, delta in (("amplitude", 40558.04, 0.01), ("peak_angle", np.radians(348.480), 2e-5),
                                   ("impulse", 483.2184, 1e-4), ("angular_frequency", 167.866, 1e-3),
                                   ("start", 0.181285, 1e-6), ("turn_impulse_z", 534.6026, 1e-4),
                                   ("turn_impulse_x", 0.0, 1e-9)):
            self.assertAlmostEqual(pulse[name], value, delta=delta, msg=name)

    def test_turn_is_that_of_newton_and_euler(self):
        turn = self.hammer.turn(20.0, step_deg=0.5, level="linkage", pitch=0.1, pins=True)
        np.testing.assert_allclose(turn["crank_angle"], np.radians(0.5 * np.arange(721)), rtol=1e-15)
        np.testing.assert_allclose(turn["time"], turn["crank_angle"] / 20.0, rtol=1e-14)
        inside = slice(20, -20)
        right = newton_euler.loads(self.hammer.parameters, turn["crank_angle"][inside], 20.0, 0.0, 0.1)
        for name, value in right.items():
            np.testing.assert_allclose(turn[name][inside], value, rtol=0,
                                       atol=1e-11 * abs(value).max(), err_msg=name)

    def test_blow_s_energy_is_what_the_rocker_lost(self):
        blow = self.hammer.blow(31.416, level="rocker")
        before, after = blow["rocker_speed_before"], blow["rocker_speed_after"]
        self.assertAlmostEqual(blow["energy"], 0.5 * 0.737 * (before ** 2 - after ** 2), places=6)
        self.assertAlmostEqual(blow["restitution"], 0.1753, delta=1e-4)
        self.assertAlmostEqual(self.hammer.blow(31.416, 20.0, level="rocker")["rocker_speed_after"], after * 20.0 / 31.416)


class Words(unittest.TestCase):
    """Problems are the commands' own."""

    def test_nan_raises_a_value_error_that_names_the_argument(self):
        hammer = hl.Hammer.from_yaml()
        for call, name in ((lambda: hammer.wrenches("x", 1, 1), "angle"), (lambda: hammer.wrenches(1, ["x"], 1), "speed"),
                           (lambda: hammer.wrenches(1, 1, object()), "acceleration"),
                           (lambda: hammer.wrenches([1, 2], 1, pitch="x"), "pitch"),
                           (lambda: hammer.turn(pitch="x"), "pitch"), (lambda: hammer.pulse(pitch="x"), "pitch"),
                           (lambda: hammer.changed(rod_mass_kg="x"), "rod_mass_kg"),
                           (lambda: hl.count_cycles("x"), "series")):
            self.assertRegex(support.message(call), "^%s: .*, must be a number" % name)

    def test_every_call_has_a_text_with_its_units(self):
        calls = [getattr(hl.Hammer, name) for name in dir(hl.Hammer) if not name.startswith("_")]
        calls += [getattr(hl, name) for name in hl.__all__]
        units = r"\[(rad|rad/s|m/s2|kg|unit of the series)\]|unit"
        for call in calls:
            text = call.__doc__ or ""
            text = text[text.find("\n\n") + 1:] if " -> " in text.splitlines()[0] else text  # behind the signature
            self.assertGreater(len(text.strip()), 30, call)
        for call in (hl.Hammer.changed, hl.Hammer.parameters, hl.Hammer.gravity, hl.Hammer.wrenches, hl.Hammer.turn,
                     hl.Hammer.pulse, hl.Hammer.blow, hl.count_cycles, hl.read_database, hl.support_impulse):
            self.assertRegex(call.__doc__, units)

    def test_missing_files_are_named(self):
        self.assertEqual(support.message(hl.Hammer.from_yaml, "/no/such.yaml"),
                         "/no/such.yaml: cannot be read: No such file or directory")
        path = support.SOURCE / "config" / "hammer_mo100.yaml"
        self.assertEqual(hl.Hammer.from_yaml(path).parameters, hl.Hammer.from_yaml().parameters)

    def test_bad_keys_and_values_are_named(self):
        hammer = hl.Hammer.from_yaml()
        self.assertIn("rod_mas_kg: unknown key", support.message(hammer.changed, rod_mas_kg=1.0))
        self.assertIn("crank_length_m: -1 m, must be > 0", support.message(hammer.changed, crank_length_m=-1.0))
        both = support.message(hammer.changed, rocker_mass_kg=-1.0, rod_mass_kg=-2.0)
        self.assertEqual(len(both.splitlines()), 2, both)
        self.assertIn("level: hull not in {pulse,rocker", support.message(hammer.turn, level="hull"))
        self.assertEqual(support.message(hammer.turn, -1.0), "speed: -1.0 rad/s, must be a finite number > 0")
        self.assertIn("step_deg: 0.0 deg", support.message(hammer.turn, step_deg=0.0))

    def test_a_rod_that_was_corrected_is_noted(self):
        changed = hl.Hammer.from_yaml().changed(rod_length_m=0.15002)
        self.assertAlmostEqual(changed.parameters["rod_length_m"], 0.15, places=15)
        self.assertIn("rod_length_m", changed.notes[0])


if __name__ == "__main__":
    unittest.main()
