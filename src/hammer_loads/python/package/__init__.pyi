"""Types of the calls; help() has their text."""
import os
from typing import Dict, List, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, "os.PathLike[str]"]
_Columns = Dict[str, NDArray[numpy.float64]]

class Hammer:
    @staticmethod
    def from_yaml(*paths: _Path) -> "Hammer": ...

    def changed(self, **values: float) -> "Hammer": ...

    @property
    def parameters(self) -> Dict[str, float]: ...

    @property
    def notes(self) -> List[str]: ...

    @property
    def level(self) -> str: ...

    @property
    def gravity(self) -> float: ...

    def wrenches(self, angle: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0, *,
                 pitch: Optional[ArrayLike] = None, gravity: Optional[float] = None, level: Optional[str] = None,
                 pins: bool = False) -> _Columns: ...

    def turn(self, speed: float = 31.416, *, step_deg: float = 1.0, pitch: Optional[float] = None,
             gravity: Optional[float] = None, level: Optional[str] = None, pins: bool = False) -> _Columns: ...

    def pulse(self, speed: float = 31.416, *, pitch: Optional[float] = None, gravity: Optional[float] = None,
              level: Optional[str] = None) -> Dict[str, float]: ...

    def blow(self, crank_speed: float, crank_speed_after: Optional[float] = None, *,
             level: Optional[str] = None) -> Dict[str, float]: ...

class Boom:
    @staticmethod
    def from_yaml(urdf: _Path, *paths: _Path) -> "Boom": ...

    @property
    def joints(self) -> List[str]: ...

    @property
    def sections(self) -> List[str]: ...

    def frequencies(self, joints: Dict[str, float]) -> List[float]: ...

    def loads(self, joints: Dict[str, float], time: ArrayLike, force_x: ArrayLike, force_z: ArrayLike,
              torque_y: ArrayLike, *, compliant: bool = True) -> _Columns: ...

def count_cycles(series: ArrayLike, *, full_scale: Optional[Tuple[float, float]] = None,
                 classes: int = 4096) -> _Columns: ...

def read_database(path: _Path) -> Dict[str, Dict[str, NDArray]]: ...

def support_impulse(*, mass: float, inertia_about_pivot: float, com: Tuple[float, float],
                    rod_joint: Tuple[float, float] = (0.0, 0.0), reduced_rod_mass: float = 0.0,
                    striking_point: Tuple[float, float], friction: float = 0.0, speed_before: float,
                    speed_after: float) -> Dict[str, float]: ...
