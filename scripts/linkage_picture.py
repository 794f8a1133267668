#!/usr/bin/env python3
"""Draws the bucket linkage of a boom file's cylinder at three angles: doc/linkage.png.

Usage: linkage_picture.py BOOM.yaml NAME JOINT_X JOINT_Z OUT.png ANGLE...
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import yaml

BLUE, RED, GREEN, GREY, ORANGE = "#1f5fa8", "#c0392b", "#2e8b57", "#888888", "#d9822b"


def turned(v, angle):
    """About +y, from z to x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([v[0] * c + v[1] * s, v[1] * c - v[0] * s])


def common_pin(pivot, driven, guide, coupler, branch):
    across = driven - pivot
    distance = np.hypot(*across)
    at_pivot = np.arccos((guide**2 + distance**2 - coupler**2) / (2 * guide * distance))
    return pivot + guide * turned(across / distance, branch * at_pivot)


def draw(axes, boom, name, joint, angle, branch):
    key = lambda k: boom[f"{name}_{k}"]
    base = np.array([key("base_x_m"), key("base_z_m")])
    pivot = np.array([key("rocker_link_base_x_m"), key("rocker_link_base_z_m")])
    driven = joint + turned(np.array([key("rod_x_m"), key("rod_z_m")]), angle)
    pin = common_pin(pivot, driven, key("rocker_link_length_m"), key("coupler_length_m"), branch)
    tool = joint + turned(np.array([-0.0975, -0.95]), angle)
    axes.plot([0.2, joint[0]], [0.0, joint[1]], color="#dddddd", lw=26, solid_capstyle="round", zorder=0)
    axes.plot([joint[0], tool[0]], [joint[1], tool[1]], color="#e8d5b5", lw=18, solid_capstyle="round", zorder=0)
    barrel = base + 0.62 * key("closed_length_m") * (pin - base) / np.hypot(*(pin - base))
    axes.plot([base[0], pin[0]], [base[1], pin[1]], color=GREY, lw=2)
    axes.plot([base[0], barrel[0]], [base[1], barrel[1]], color=GREY, lw=7, solid_capstyle="butt")
    axes.plot([pivot[0], pin[0]], [pivot[1], pin[1]], color=BLUE, lw=4, label="guide link: rocker_link_length_m")
    axes.plot([pin[0], driven[0]], [pin[1], driven[1]], color=RED, lw=4, label="coupler: coupler_length_m")
    axes.plot([joint[0], driven[0]], [joint[1], driven[1]], color=ORANGE, lw=1.5, ls=":")
    for place, text, shift in ((base, "base_x_m, base_z_m", (-0.05, 0.09)),
                               (pivot, "rocker_link_base_x_m, _z_m", (-0.75, -0.20)), (pin, "rod's pin", (-0.36, 0.08)),
                               (driven, "rod_x_m, rod_z_m", (0.06, 0.07)), (joint, "joint", (0.07, -0.12))):
        axes.plot(*place, "o", color="black", ms=5)
        axes.annotate(text, place, place + np.array(shift), fontsize=7.5,
                      arrowprops={"arrowstyle": "-", "lw": 0.4, "color": GREY})
    axes.set_title(f"{angle:+.2f} rad, cylinder {np.hypot(*(pin - base)):.3f} m", fontsize=9)
    axes.set_aspect("equal")
    axes.margins(0.09)
    axes.axis("off")


def main():
    if "--help" in sys.argv:
        sys.exit(print(__doc__))
    boom_file, name, joint_x, joint_z, out, *angles = sys.argv[1:]
    with open(boom_file, encoding="utf-8") as text:
        boom = yaml.safe_load(text)
    branch = boom.get(f"{name}_linkage_branch", -1)
    figure, all_axes = plt.subplots(1, len(angles), figsize=(4.2 * len(angles), 3.4), sharex=True, sharey=True)
    for axes, angle in zip(all_axes, map(float, angles)):
        draw(axes, boom, name, np.array([float(joint_x), float(joint_z)]), angle, branch)
    all_axes[0].legend(fontsize=7, loc="lower left", frameon=False)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    main()
