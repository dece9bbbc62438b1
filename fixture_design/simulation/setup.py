"""Numbers of a simulated assembly: the robot that holds the moving part, the surfaces, the wrist sensor."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fixture_design.errors import InputError


@dataclass(frozen=True)
class Robot:
    """A robot with an impedance: it pulls the part with K (q_d - q) - D dq/dt towards a virtual target q_d.

    Attributes:
        stiffness: K of a translation [N/m], about the part's origin.  turning_stiffness: of a rotation [N m/rad].
        damping, turning_damping: D [N s/m], [N m s/rad].
        mass, inertia: of what moves with the part [kg], [kg m^2].
    """

    stiffness: float = 2000.0
    turning_stiffness: float = 2.0
    damping: float = 100.0
    turning_damping: float = 0.1
    mass: float = 1.0
    inertia: float = 1e-3


@dataclass(frozen=True)
class Surfaces:
    """How the parts touch.

    Attributes:
        friction: mu of every contact [-].  stiffness: of a point of contact [N/m].  dissipation: of it [s/m].
        radius: of rounded apices [m].
    """

    friction: float = 0.2
    stiffness: float = 1e6
    dissipation: float = 1.0
    radius: float = 1e-4


@dataclass(frozen=True)
class WristSensor:
    """What is wrong with a force sensor, after taring.

    Attributes:
        noise: standard deviation of the error's length, relative to the wrench's [f; m / length] [-].
        bias: what the tare left, [fx, fy, m / length] each up to this, the same for a run [N].
        delay: time constant of its low-pass filter [s].
        seed: of noise and bias; not negative.
    """

    noise: float = 0.05
    bias: float = 0.05
    delay: float = 0.005
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("noise", "bias", "delay", "seed"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"a wrist sensor's {name} must be a number >= 0", found=repr(value))


@dataclass(frozen=True)
class Setup:
    """All numbers of a simulation.

    Attributes:
        time_step: of the contact solver [s].  period: of sensor and recognition [s].
    """

    robot: Robot = Robot()
    surfaces: Surfaces = Surfaces()
    sensor: WristSensor = WristSensor()
    time_step: float = 1e-3
    period: float = 0.01
