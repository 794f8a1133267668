"""The hammer's loads from Newton and Euler, in complex numbers; shares nothing with the package but the parameters.

Positions by the intersection of two circles, rates by differentiating the loop, forces by nine equations of balance.
"""
import numpy as np

D = np.pi / 180.0


class Linkage:
    """Motion for crank angles phi [rad], away from the blow, speed w [rad/s] and acceleration e [rad/s2]."""

    def __init__(self, p, phi, w, e):
        self.p = p
        l1, l2, l3, l0 = (p[k] for k in ("crank_length_m", "rod_length_m", "rocker_length_m", "pivot_distance_m"))
        phi, w, e = np.broadcast_arrays(phi, w, e)
        b = l1 * np.exp(1j * phi)
        to_d = l0 - b
        distance = abs(to_d)
        angle = np.arccos((l2 ** 2 + distance ** 2 - l3 ** 2) / (2 * l2 * distance))
        c = b + l2 * np.exp(1j * angle) * to_d / distance  # the rod stays on one side over the whole turn
        self.b, self.c, self.d = b, c, l0 + 0j * b
        rod, rocker = c - b, c - l0
        # b' + i v rod = i u rocker, and once more: two real equations each, by what is along and across the rod.
        rate_b = 1j * w * b
        self.v, self.u = self._solve(rod, rocker, rate_b)
        accel_b = (1j * e - w ** 2) * b
        known = accel_b - self.v ** 2 * rod + self.u ** 2 * rocker
        self.va, self.ua = self._solve(rod, rocker, known)
        self.w, self.e, self.accel_b = w, e, accel_b

    @staticmethod
    def _solve(rod, rocker, known):
        """x, y of known + i x rod = i y rocker."""
        turning = (known * rod.conjugate()).real / (1j * rocker * rod.conjugate()).real
        return ((1j * turning * rocker - known) / (1j * rod)).real, turning

    def links(self):
        """(mass, inertia, centre, acceleration of the centre, angular acceleration) of crank, rod, rocker."""
        p = self.p
        a, ls = p["rocker_com_angle_deg"] * D, p["rocker_com_distance_m"]

        def on(start, end, along, across):
            axis = (end - start) / abs(end - start)
            return axis * (along + 1j * across)

        crank = on(0j, self.b, p["crank_com_along_m"], p["crank_com_across_m"])
        rod = on(self.b, self.c, p["rod_com_along_m"], p["rod_com_across_m"])
        s = on(self.d, self.c, ls, 0.0) * np.exp(1j * a)
        inertia = p["rocker_inertia_about_pivot_kg_m2"] - p["rocker_mass_kg"] * ls ** 2
        return [(p["crank_mass_kg"], p["crank_inertia_about_com_kg_m2"], crank,
                 (1j * self.e - self.w ** 2) * crank, self.e),
                (p["rod_mass_kg"], p["rod_inertia_about_com_kg_m2"], self.b + rod,
                 self.accel_b + (1j * self.va - self.v ** 2) * rod, self.va),
                (p["rocker_mass_kg"], inertia, self.d + s, (1j * self.ua - self.u ** 2) * s, self.ua)]


def cross(a, b):
    return (a.conjugate() * b).imag


def loads(parameters, phi, w, e, pitch=None, gravity=9.80665, massless=False):
    """Columns as of the command evaluate; massless: crank and rod."""
    p = dict(parameters)
    if massless:
        p.update(crank_mass_kg=0.0, crank_inertia_about_com_kg_m2=0.0, rod_mass_kg=0.0, rod_inertia_about_com_kg_m2=0.0)
    linkage = Linkage(p, np.asarray(phi, float), w, e)
    a = p["rocker_com_angle_deg"] * D
    # Vector (x, z) of the hull to (xi, eta): the inverse of x = -(cos a xi + sin a eta), z = -sin a xi + cos a eta.
    g = 0j if pitch is None else gravity * np.sin(pitch) * -np.exp(1j * a) - gravity * np.cos(pitch) * 1j * np.exp(1j * a)
    hull_force, hull_moment = 0j, 0.0
    columns, right = [], []
    for mass, inertia, centre, acceleration, turning in linkage.links():
        force = mass * (acceleration - g)  # that the link needs
        hull_force = hull_force - force
        hull_moment = hull_moment - inertia * turning - cross(centre - linkage.d, force)
        right += [force.real, force.imag, inertia * turning + cross(centre, force)]
    # Unknown: R01, R12, R23, R03, drive torque; moments about A.
    n = linkage.b.size
    matrix = np.zeros((n, 9, 9))
    place = {"R01": 0, "R12": 2, "R23": 4, "R03": 6}
    for link, pins in enumerate(((("R01", 1, 0j * linkage.b), ("R12", -1, linkage.b)),
                                 (("R12", 1, linkage.b), ("R23", -1, linkage.c)),
                                 (("R23", 1, linkage.c), ("R03", 1, linkage.d)))):
        for name, sign, at in pins:
            k = place[name]
            matrix[:, 3 * link, k] = sign
            matrix[:, 3 * link + 1, k + 1] = sign
            matrix[:, 3 * link + 2, k] = -sign * at.imag
            matrix[:, 3 * link + 2, k + 1] = sign * at.real
    matrix[:, 2, 8] = 1.0
    forces = np.linalg.solve(matrix, np.stack([np.broadcast_to(r, n) for r in right], axis=1)[:, :, None])[:, :, 0]

    def in_hull(v):
        return -(np.cos(a) * v.real + np.sin(a) * v.imag), -np.sin(a) * v.real + np.cos(a) * v.imag

    result = {}
    result["force_x"], result["force_z"] = in_hull(hull_force)
    result["torque_y"] = hull_moment
    result["drive_torque"] = forces[:, 8]
    for name, k in place.items():
        result[name + "_x"], result[name + "_z"] = in_hull(forces[:, k] + 1j * forces[:, k + 1])
    return result
