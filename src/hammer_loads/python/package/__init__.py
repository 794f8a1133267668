"""Loads of a crank-rocker hydraulic hammer, with NumPy arrays in and out.

    import hammer_loads_py as hl
    hammer = hl.Hammer.from_yaml("my_hammer.yaml")
    loads = hammer.wrenches(angle, speed)       # a dictionary of arrays: hull_force_x_N, ...

SI units. Results are named as the columns of the commands; help() of each call states units and frames.
Wrong input raises ValueError in the words of the commands, one line for each problem. Loops run without Python's
lock, so that threads share the work.
"""
from ._native import Hammer, count_cycles, read_database, support_impulse

__all__ = ["Hammer", "count_cycles", "read_database", "support_impulse"]
