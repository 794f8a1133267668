"""P1: impulse of a blow in the rocker's support, printed formulas beside the package, as examples/papers.py prints it.

P1's x grows from the pivot towards the striking point K, the package's x in the opposite direction.
"""
import hammer_loads_py as hl
import numpy as np
from markdown_table import table

SPEED_OF_1000_J = 13.636  # of the crank at the blow [rad/s]


def printed_impact(j, mn, mass, com, n, k, f, speed):
    """P1 (4), (5), (8), (9) as printed; speed = w-(1 + R)."""
    inertia = j + mn * (n[0] ** 2 + n[1] ** 2)
    arm = f * k[1] - k[0]
    along_y = inertia * speed / arm
    along_x = -f * inertia * speed * np.sign(k[1]) / arm
    return [along_x, along_y,
            speed * (mass * com[1] + mn * n[1]) - along_x, -speed * (mass * com[0] + mn * n[0]) - along_y]


def striking_rocker(hammer):
    """Arguments of support_impulse for the shipped rocker with its rod, and those of P1 (x towards K)."""
    p = hammer.parameters
    l2, l3, alpha = p["rod_length_m"], p["rocker_length_m"], np.radians(p["rocker_com_angle_deg"])
    from_b = p["rod_com_along_m"] ** 2 + p["rod_com_across_m"] ** 2
    rod = (p["rod_inertia_about_com_kg_m2"] + p["rod_mass_kg"] * from_b) / l2 ** 2
    joint, com = (-l3 * np.cos(alpha), -l3 * np.sin(alpha)), (-p["rocker_com_distance_m"], 0.0)
    ours = {"mass": p["rocker_mass_kg"], "inertia_about_pivot": p["rocker_inertia_about_pivot_kg_m2"], "com": com,
            "rod_joint": joint, "reduced_rod_mass": rod}
    paper = (ours["inertia_about_pivot"], rod, ours["mass"], (-com[0], com[1]), (-joint[0], joint[1]))
    before = hammer.blow(SPEED_OF_1000_J, level="rocker")["rocker_speed_before"]
    return ours, paper, p["striking_distance_m"], before


def impulses(rocker, lk, z, f, before, restitution):
    """I_x, I_y on the rocker by the tool, I_0x, I_0y by the support, axes of P1 [N s]."""
    blow = hl.support_impulse(striking_point=(-lk, z), friction=f, speed_before=before,
                              speed_after=-restitution * before, **rocker)
    return np.array([-blow["tool_impulse_x"], blow["tool_impulse_z"],
                     blow["support_impulse_x"], -blow["support_impulse_z"]])


def impact_table(hammer, f=0.15, offset=0.02):
    rocker, paper, lk, before = striking_rocker(hammer)
    rows = []
    for restitution in (0.0, 0.1753):
        for z in (0.0, offset, -offset):
            ours = impulses(rocker, lk, z, f, before, restitution)
            theirs = printed_impact(*paper, (lk, z), f, before * (1.0 + restitution))
            rows.append([f"{restitution:g}", f"{z * 1e3:.0f}",
                         *(f"{o + 0.0:.3f} ({q + 0.0:.3f})" for o, q in zip(ours, theirs))])
    return table(["R", "y_K [mm]", "I_x [N s]", "I_y [N s]", "I_0x [N s]", "I_0y [N s]"], rows)


def ideal_table(hammer, f=0.15, offset=0.02):
    """Impulses are linear in the centre of mass: I_0x in y_C, I_0y in x_C."""
    rocker, (j, mn, mass, _, n), lk, before = striking_rocker(hammer)
    rows, both = [], "(12), (13)"
    for name, rod, friction, z, restitution in (("(18)", 0.0, 0.0, 0.0, 0.0), (both, mn, f, -offset, 0.0),
                                                (both, mn, f, offset, 0.0), (both, mn, f, offset, 0.1753)):
        at = {**rocker, "reduced_rod_mass": rod}
        zero, moved = (impulses({**at, "com": c}, lk, z, friction, before, restitution)
                       for c in ((0.0, 0.0), (-1.0, 1.0)))
        x, y = zero[3] / (zero[3] - moved[3]), zero[2] / (zero[2] - moved[2])
        l2 = n[0] ** 2 + n[1] ** 2
        arm = lk - friction * z
        printed = (j / (mass * lk), 0.0) if name == "(18)" else (
            -(j + rod * l2 + rod * n[0]) / (mass * arm),
            ((j + rod * l2 * friction * np.sign(z)) / arm - rod * n[1]) / mass)
        rows.append([name, f"{rod:.3f}", f"{friction:g}", f"{z * 1e3:.0f}", f"{restitution:g}",
                     *(f"{1e3 * v + 0.0:.3f} ({1e3 * q:.3f})" for v, q in zip((x, y), printed))])
    return table(["", "m_n [kg]", "f", "y_K [mm]", "R", "x_C [mm]", "y_C [mm]"], rows)
