"""One revolution of a hammer from blow to blow: at constant crank speed, or driven by a steady torque.

    turn = Turn.at_speed(hammer, 31.416)        # as P0 assumes: no flywheel of finite inertia keeps this speed
    turn = Turn.at_energy(hammer, 1000.0)       # what the drive's inertia and a steady torque make of it
"""
import dataclasses
from typing import Callable

import numpy as np
from scipy import integrate, optimize

WHOLE = 2.0 * np.pi
JUST_BEFORE = -1e-13  # [rad] before the blow


@dataclasses.dataclass
class Turn:
    hammer: object
    level: str
    speed: Callable         # of the crank [rad/s] by its angle [rad]
    acceleration: Callable  # [rad/s2]

    @classmethod
    def at_speed(cls, hammer, speed, level="rocker"):
        return cls(hammer, level, lambda angle: speed + 0.0 * angle, lambda angle: 0.0 * angle)

    @classmethod
    def at_energy(cls, hammer, energy, level="rocker"):
        """A steady torque makes up for each blow of `energy` [J]; the crank keeps its speed at the blow."""
        drive = hammer.parameters["drive_inertia_kg_m2"]

        def torque(angle, speed, acceleration):  # that the links need
            return hammer.wrenches(angle, speed, acceleration, level=level, pins=True)["drive_torque"]

        before, after = torque(np.array([JUST_BEFORE, 0.0]), 0.0, 1.0) + drive
        at_blow = 2.0 * energy / (before - after)  # square of the crank's speed
        steady = energy / WHOLE

        def speed(angle):
            return np.sqrt((after * at_blow + 2.0 * steady * angle) / (torque(angle, 0.0, 1.0) + drive))

        def acceleration(angle):
            return (steady - torque(angle, speed(angle), 0.0)) / (torque(angle, 0.0, 1.0) + drive)

        return cls(hammer, level, speed, acceleration)

    def loads(self, angle, level=None):
        """Force x, z [N] and moment [N m] of the links on the hull at crank angles in [0, 2 pi)."""
        angle = np.asarray(angle, float)
        at = np.where(angle < np.pi, angle, angle - WHOLE)  # next to the blow every digit counts
        loads = self.hammer.wrenches(at, self.speed(angle), self.acceleration(angle), level=level or self.level)
        return np.array([loads[name] for name in ("force_x", "force_z", "torque_y")])

    def integral(self, of, start, end, pieces=64):
        """Over time, of a function of the angle between two angles, by 16 points of Gauss in each piece."""
        edges = np.linspace(start, end, pieces + 1)
        return sum(integrate.fixed_quad(lambda a: of(a) / self.speed(a), low, high, n=16)[0]
                   for low, high in zip(edges, edges[1:]))

    def time(self, angle):
        """Since the blow [s]."""
        return self.integral(lambda a: 1.0 + 0.0 * a, 0.0, angle)

    def period(self):
        return self.time(WHOLE)

    def extreme(self, component, sign):
        """(value, angle) of the largest (sign 1) or least (-1) load of a component."""
        grid = np.linspace(0.0, WHOLE, 1441)[:-1]
        top = grid[np.argmax(sign * self.loads(grid)[component])]
        found = optimize.minimize_scalar(lambda a: -sign * self.loads(a)[component], method="bounded",
                                         bounds=(max(0.0, top - 0.01), min(WHOLE - 1e-12, top + 0.01)),
                                         options={"xatol": 1e-10})
        ends = [(sign * self.loads(a)[component], a) for a in (found.x, 0.0, WHOLE + JUST_BEFORE)]
        value, angle = max(ends)
        return sign * value, angle

    def zeros(self, component):
        """Angles where a load changes its sign, ascending."""
        grid = np.linspace(1e-9, WHOLE - 1e-9, 2881)
        values = self.loads(grid)[component]
        return [optimize.brentq(lambda a: self.loads(a)[component], grid[i], grid[i + 1], xtol=1e-14)
                for i in np.flatnonzero(values[:-1] * values[1:] < 0.0)]

    def half_sine(self):
        """P0 (15), (16): H [N] and its angle, S (Q of model.md) [N s], mu [rad/s], t1, T [s], rms of the rest."""
        peak, angle = self.extreme(1, 1.0)
        rise = max(a for a in self.zeros(1) if a < angle)
        impulse = self.integral(lambda a: self.loads(a)[1], rise, WHOLE)
        period, mu = self.period(), 2.0 * peak / impulse
        start = period - np.pi / mu
        grid = np.linspace(0.0, WHOLE, 4001)[:-1]
        times = np.concatenate(([0.0], np.cumsum(WHOLE / 4000 / self.speed(grid + WHOLE / 8000))))[:-1]
        sine = np.where(times > start, peak * np.sin(mu * (times - start)), 0.0)
        weight = 1.0 / self.speed(grid)
        rest = np.sqrt(np.average((self.loads(grid)[1] - sine) ** 2, weights=weight)) / peak
        return {"H": peak, "angle": angle, "S": impulse, "mu": mu, "t1": start, "T": period, "rest": rest}

    def halves_of_x(self):
        """Impulses of Fx over the turn while it is positive and while it is negative [N s]."""
        edges = [0.0] + self.zeros(0) + [WHOLE]
        parts = [self.integral(lambda a: self.loads(a)[0], low, high) for low, high in zip(edges, edges[1:])]
        return sum(p for p in parts if p > 0.0), sum(p for p in parts if p < 0.0)

    def errors_of_pulse(self):
        """Level pulse beside this turn: rms of Fx, Fz and moment over the turn, each of its own peak."""
        grid = np.linspace(0.0, WHOLE, 4001)[:-1]
        true, pulse = self.loads(grid), self.loads(grid, "pulse")
        weight = 1.0 / self.speed(grid)
        return np.sqrt(np.average((pulse - true) ** 2, axis=1, weights=weight)) / abs(true).max(axis=1)
