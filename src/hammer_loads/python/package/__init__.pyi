"""Loads of a crank-rocker hydraulic hammer, with NumPy arrays in and out.

SI units. A wrench is BY the moving links ON the hull, moment about the rocker's pivot, axes of hammer_hull; results are
named as the columns of the commands. What is wrong is a ValueError with the commands' own words, one line for each
problem. Loops run without Python's lock, so that threads share the work.
"""
import os
from typing import Dict, List, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, "os.PathLike[str]"]
_Columns = Dict[str, NDArray[numpy.float64]]

class Hammer:
    """A hammer that can exist; it never changes."""

    @staticmethod
    def from_yaml(*paths: _Path) -> "Hammer":
        """From parameter files over the shipped ones, as --params; a later file's key replaces an earlier one's.

        Without any hammer key it is the MO-100.
        """

    def changed(self, **values: float) -> "Hammer":
        """The same hammer with other values of the hammer file's keys, in the keys' units.

        Lengths must keep crank + rod = pivot distance + rocker to 1e-3 crank lengths; the rod is corrected by the rest.
        """

    @property
    def parameters(self) -> Dict[str, float]:
        """By the hammer file's keys, in force: with the rod as it was corrected."""

    @property
    def notes(self) -> List[str]:
        """What the commands would note, one line each."""

    @property
    def level(self) -> str:
        """Of the model, as the parameters have it; each call may name another."""

    @property
    def gravity(self) -> float:
        """As the parameters have it [m/s2]."""

    def wrenches(self, angle: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0, *,
                 pitch: Optional[ArrayLike] = None, gravity: Optional[float] = None, level: Optional[str] = None,
                 pins: bool = False, out: Optional[_Columns] = None) -> _Columns:
        """Of many states at once, as the command evaluate.

        angle: of the crank [rad], 0 at the blow, any winding up to 4e8 rad; just below 0 lies before a blow.
        speed [rad/s], acceleration [rad/s2]: of the crank. pitch: of the hull [rad]; without it there is no weight.
        Arrays of one shape or what broadcasts to it; a nan gives nan. Returns hull_force_x_N, hull_force_z_N,
        hull_torque_y_Nm of that shape; with pins also drive_torque_y_Nm and Rij_x_N, Rij_z_N, force of link i on link j
        (0 hull, 1 crank, 2 rod, 3 rocker). out: an earlier result, whose arrays are written over and returned; where
        results are kept, new memory costs more than the loads of a million states.
        """

    def turn(self, speed: float = 31.416, *, step_deg: float = 1.0, pitch: Optional[float] = None,
             gravity: Optional[float] = None, level: Optional[str] = None, pins: bool = False) -> _Columns:
        """One turn at constant crank speed [rad/s], as the command turn_table.

        Returns crank_angle_deg, time_s, force_x_N, force_z_N, torque_y_Nm; the first row is just after a blow, the last
        one just before the next.
        """

    def pulse(self, speed: float = 31.416, *, pitch: Optional[float] = None, gravity: Optional[float] = None,
              level: Optional[str] = None) -> Dict[str, float]:
        """The turn's pulse, as turn_table --summary."""

    def blow(self, crank_speed: float, crank_speed_after: Optional[float] = None, *,
             level: Optional[str] = None) -> Dict[str, float]:
        """The blow of a crank that passes it at crank_speed [rad/s] and keeps it, unless the speed after is given.

        Names as of message Blow; support_impulse is by the rocker on the hull at its pivot.
        """

def count_cycles(series: ArrayLike, *, full_scale: Optional[Tuple[float, float]] = None,
                 classes: int = 4096) -> _Columns:
    """Load cycles of a series in its order, as the command count_cycles: ASTM E1049, the residue as half cycles.

    Every value as it is, or on a grid between the two loads of full_scale. nan and inf are skipped. Returns range, mean
    and count, by range, then by mean.
    """

def read_database(path: _Path) -> Dict[str, Dict[str, NDArray]]:
    """Every table of a database of process_bag --db, of a ledger or of the fleet: an array for each column.

    Whole numbers are int64, or float64 where one is missing; texts are objects. What is missing is nan or None.
    """

def support_impulse(*, mass: float, inertia_about_pivot: float, com: Tuple[float, float],
                    rod_joint: Tuple[float, float] = (0.0, 0.0), reduced_rod_mass: float = 0.0,
                    striking_point: Tuple[float, float], friction: float = 0.0, speed_before: float,
                    speed_after: float) -> Dict[str, float]:
    """What a rocker of any shape gives to tool and support in its blow (P1).

    Points are (x, z) from the pivot in axes of hammer_hull [m]; masses [kg], inertia [kg m2], speeds of the rocker
    [rad/s], negative before the blow of a rocker that strikes at x < 0.
    """
