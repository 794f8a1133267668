#!/usr/bin/env python3
"""Which hammer loads the boom least per joule of its blows, at the poses of a recorded bag.

    examples/design.py in.bag [--urdf machine.urdf] [--hammer HAMMER.yaml] [--within 0.1]

Changed are the lengths of crank, rocker and pivot distance, the rocker's centre of mass, the rod's mass and its centre
of mass, each within a part of what it was. The rod's length follows from the change point (crank + rod = pivot distance +
rocker), the rod's inertia from mass and length; the rocker keeps its mass and its inertia about its centre of mass, and
strikes at its percussion centre, so that the blow leaves its support alone.

A turn: a steady torque gives the crank what the blow takes. Load: torques on the pitch joints of the boom, of each its
deviation from the mean with the exponent of welded steel's S-N curve, root mean square over joints and poses.
"""
import argparse
import pathlib
import xml.etree.ElementTree

import hammer_loads_py as hl
import numpy as np
from scipy import optimize

SOURCE = pathlib.Path(__file__).resolve().parents[1]
JOINTS = ("boom_joint", "arm_joint", "hammer_joint")
SN_SLOPE = 5.0  # [-] of welded steel beyond the knee, EN 1993-1-9
ANGLE = np.linspace(0.0, 2.0 * np.pi, 721)[1:-1]
ENERGY = 1000.0  # [J] of each blow; loads and energy both grow with the square of the crank's speed


def poses_of(bag_path, topic="/joint_states", most=50):
    """Rows of JOINTS' angles [rad], evenly over the recording."""
    import rosbag  # of ROS; the only part that needs it
    rows = []
    with rosbag.Bag(bag_path) as bag:
        for _, message, _ in bag.read_messages(topics=[topic]):
            at = dict(zip(message.name, message.position))
            if all(joint in at for joint in JOINTS):
                rows.append([at[joint] for joint in JOINTS])
    if not rows:
        raise SystemExit(f"{bag_path}: {topic}: no message has {', '.join(JOINTS)}")
    return np.array(rows)[np.linspace(0, len(rows) - 1, min(most, len(rows))).astype(int)]


def offsets_of(urdf):
    """(x, z) from each of JOINTS to the next one, and from the last one to hammer_hull [m]; all turn about +y."""
    joints = {j.get("name"): j for j in xml.etree.ElementTree.parse(urdf).getroot().iter("joint")}
    by_child = {j.find("child").get("link"): j for j in joints.values()}
    offsets, total, link = [], np.zeros(2), "hammer_hull"
    while len(offsets) < len(JOINTS):
        joint = by_child[link]
        total = total + np.array([float(v) for v in joint.find("origin").get("xyz").split()])[[0, 2]]
        if joint.get("name") in JOINTS:
            offsets.insert(0, total - np.array([float(v) for v in joint.find("origin").get("xyz").split()])[[0, 2]])
            total = np.array([float(v) for v in joint.find("origin").get("xyz").split()])[[0, 2]]
        link = joint.find("parent").get("link")
    return offsets


def levers_of(poses, offsets):
    """From each joint to the hull's origin, in hull axes (x, z) [m]: array of pose, joint, axis."""
    levers = np.zeros((len(poses), len(JOINTS), 2))
    for j in range(len(JOINTS)):
        for k in range(j, len(JOINTS)):
            back = -poses[:, k + 1:].sum(axis=1)  # from the axes of link k to the hull's, about +y
            x, z = offsets[k]
            levers[:, j, 0] += x * np.cos(back) + z * np.sin(back)
            levers[:, j, 1] += -x * np.sin(back) + z * np.cos(back)
    return levers


def links_of(hammer):
    """Hull force x, z, moment and drive torque, and the links' inertia just before and after the blow.

    Rows: the four per square of the crank's speed, the four per its acceleration, each over ANGLE; the inertias last.
    """
    inertia = hammer.parameters["drive_inertia_kg_m2"]
    names = ("force_x", "force_z", "torque_y", "drive_torque")

    def loads(angle, speed, acceleration):
        result = hammer.wrenches(angle, speed, acceleration, level="linkage", pins=True)
        return [result[name] for name in names]

    # The torque that a crank without speed needs is its inertia.
    before, after = loads(np.array([-1e-6, 1e-6]), 0.0, 1.0)[3] + inertia
    return np.array(loads(ANGLE, 1.0, 0.0) + loads(ANGLE, 0.0, 1.0) + [np.full(ANGLE.size, before),
                                                                       np.full(ANGLE.size, after)])


def turn_of(links, parameters):
    """Hull force x, z and moment over ANGLE, of a turn whose blow gives ENERGY, and the part of its time at each angle."""
    inertia = parameters["drive_inertia_kg_m2"]
    steady = ENERGY / (2.0 * np.pi)
    by_square, by_acceleration, before, after = links[:4], links[4:8], links[8], links[9]
    at_blow = 2.0 * ENERGY / (before - after)  # square of the crank's speed
    whole = by_acceleration[3] + inertia
    square = (after * at_blow + 2.0 * steady * ANGLE) / whole
    acceleration = (steady - by_square[3] * square) / whole
    x, z, moment = by_square[:3] * square + by_acceleration[:3] * acceleration
    time = 1.0 / np.sqrt(square)
    return x, z, moment - parameters["drive_reaction_ratio"] * inertia * acceleration, time / time.sum()


def working_turn(hammer):
    return turn_of(links_of(hammer), hammer.parameters)


def load_of(links, parameters, levers):
    """N m per joule."""
    x, z, moment, weight = turn_of(links, parameters)
    torque = moment + levers[..., 1:] * x - levers[..., :1] * z  # pose, joint, angle
    swing = torque - (torque * weight).sum(axis=-1, keepdims=True)
    equivalent = ((swing ** 2) ** (0.5 * SN_SLOPE) * weight).sum(axis=-1) ** (1.0 / SN_SLOPE)
    return np.sqrt((equivalent ** 2).mean()) / ENERGY


def boom_load(hammer, levers):
    return float(load_of(links_of(hammer), hammer.parameters, levers))


CHANGED = ("crank_length_m", "rocker_length_m", "pivot_distance_m", "rocker_com_distance_m", "rocker_com_angle_deg",
           "rod_mass_kg", "rod_com_along_m")


def designed(shipped, factors):
    """The hammer with CHANGED multiplied by factors, and what follows from them."""
    old = shipped.parameters
    new = {key: old[key] * factor for key, factor in zip(CHANGED, factors)}
    rod = new["pivot_distance_m"] + new["rocker_length_m"] - new["crank_length_m"]
    mass, com = old["rocker_mass_kg"], new["rocker_com_distance_m"]
    inertia = old["rocker_inertia_about_pivot_kg_m2"] + mass * (com ** 2 - old["rocker_com_distance_m"] ** 2)
    stretch = rod / old["rod_length_m"]
    return shipped.changed(**new, rod_length_m=rod, rocker_inertia_about_pivot_kg_m2=inertia,
                           striking_distance_m=inertia / (mass * com),
                           rod_inertia_about_com_kg_m2=old["rod_inertia_about_com_kg_m2"] * factors[5] * stretch ** 2)


def columns_of(shipped, factors, step=1e-5):
    """How each of factors changes links_of: hammers with this figure a little more and a little less."""
    for change in step * np.eye(len(CHANGED)):
        more, less = (links_of(designed(shipped, factors + sign * change)) for sign in (1.0, -1.0))
        yield (more - less) / (2.0 * step)


def gradient(shipped, factors, levers):
    """Of boom_load by factors: along each column, by an imaginary step, which loses no digits."""
    hammer, tiny = designed(shipped, factors), 1e-30j
    links = links_of(hammer)
    return np.array([load_of(links + tiny * column, hammer.parameters, levers).imag / tiny.imag
                     for column in columns_of(shipped, factors)])


def best(shipped, levers, within):
    """The hammer with the least boom_load."""
    start = boom_load(shipped, levers)
    found = optimize.minimize(lambda factors: boom_load(designed(shipped, factors), levers) / start,
                              np.ones(len(CHANGED)), jac=lambda factors: gradient(shipped, factors, levers) / start,
                              method="SLSQP", bounds=[(1.0 - within, 1.0 + within)] * len(CHANGED),
                              options={"ftol": 1e-7, "maxiter": 60})
    return designed(shipped, found.x)


def ideal_centre_of_mass(**rocker):
    """Centre of mass (x, z) [m] for which the blow leaves the support alone (P1), found by its impulses."""
    def impulse(com):
        blow = hl.support_impulse(com=tuple(com), speed_before=-1.0, speed_after=0.0, **rocker)
        return blow["support_impulse_x"], blow["support_impulse_z"]

    return optimize.root(impulse, (-0.1, 0.0), tol=1e-12).x


def main(arguments=None):
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("bag")
    options.add_argument("--urdf", default=str(SOURCE / "urdf" / "eo2621_mo100.urdf"))
    options.add_argument("--hammer", action="append", default=[])
    options.add_argument("--within", type=float, default=0.1, help="part by which a figure may change")
    given = options.parse_args(arguments)

    shipped = hl.Hammer.from_yaml(*given.hammer)
    levers = levers_of(poses_of(given.bag), offsets_of(given.urdf))
    after = best(shipped, levers, given.within)
    old, new = shipped.parameters, after.parameters
    print(f"{'':34s}{'before':>12s}{'after':>12s}")
    for key in CHANGED + ("rod_length_m", "rocker_inertia_about_pivot_kg_m2", "striking_distance_m"):
        print(f"{key:34s}{old[key]:12.5g}{new[key]:12.5g}")
    print(f"{'boom load [N m/J]':34s}{boom_load(shipped, levers):12.5g}{boom_load(after, levers):12.5g}")
    for name, place in (("largest Fx [N/J]", 0), ("largest Fz [N/J]", 1)):
        a, b = (abs(working_turn(h)[place]).max() / ENERGY for h in (shipped, after))
        print(f"{name:34s}{a:12.5g}{b:12.5g}")
    x, _ = ideal_centre_of_mass(mass=old["rocker_mass_kg"], inertia_about_pivot=old["rocker_inertia_about_pivot_kg_m2"],
                                striking_point=(-old["striking_distance_m"], 0.0))
    print(f"ideal centre of mass of the rocker before: {-x:.7f} m from its pivot; "
          f"it lies at {old['rocker_com_distance_m']:.7f} m")


if __name__ == "__main__":
    main()
