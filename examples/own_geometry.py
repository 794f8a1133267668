#!/usr/bin/env python3
"""A hammer of one's own lengths beside the MO-100: a million states at once, and what the library says of a bad one.

    examples/own_geometry.py
"""
import hammer_loads_py as hl
import numpy as np


def main():
    shipped = hl.Hammer.from_yaml()
    # crank + rod = pivot distance + rocker, or the rocker does not strike (doc/model.md, 1)
    own = shipped.changed(crank_length_m=0.052, rod_length_m=0.161, rocker_length_m=0.128, pivot_distance_m=0.085)
    angle = np.linspace(0.0, 2.0 * np.pi, 1000000, endpoint=False)
    print("            largest Fz [kN]   least Fz [kN]")
    for name, hammer in (("MO-100", shipped), ("own", own)):
        force = hammer.wrenches(angle, 31.416, level="linkage")["force_z"]
        print(f"{name:10s} {force.max() / 1e3:16.3f} {force.min() / 1e3:15.3f}")
    try:
        shipped.changed(rod_length_m=0.2)
    except ValueError as error:
        print(error)


if __name__ == "__main__":
    main()
