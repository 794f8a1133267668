#!/usr/bin/env python3
"""A turn of the hammer at constant crank speed: forces on the hull, its pulse, its blow; with --png a picture.

    examples/turn.py [HAMMER.yaml] [--speed 31.416] [--png turn.png]
"""
import argparse

import numpy as np

import hammer_loads_py as hl


def main(arguments=None):
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("hammer", nargs="*", help="parameter files; none: MO-100")
    options.add_argument("--speed", type=float, default=31.416, help="of the crank [rad/s]")
    options.add_argument("--png")
    given = options.parse_args(arguments)

    hammer = hl.Hammer.from_yaml(*given.hammer)
    turn = hammer.turn(given.speed, step_deg=1.0, level="linkage")
    for name, value in hammer.pulse(given.speed, level="linkage").items():
        print(f"{name}: {value:.6g}")
    print(f"energy: {hammer.blow(given.speed, level='linkage')['energy']:.6g}")
    if given.png:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        figure, axes = pyplot.subplots()
        for name in ("force_x", "force_z"):
            axes.plot(np.degrees(turn["crank_angle"]), turn[name] / 1e3, label=name)
        axes.set_xlabel("crank angle [deg]")
        axes.set_ylabel("on the hull [kN]")
        axes.legend()
        figure.savefig(given.png)


if __name__ == "__main__":
    main()
