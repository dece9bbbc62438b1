"""The nouns of a hand: the model file, what its fingertips are like, and what its joints may do.

A fingertip is where a hand means to touch: a point, a ball or a flat pad that is fixed to a link L, and looks along
``facing``. Positions and directions are in L; all lengths are metres, angles radians.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path

import numpy as np

from fixture_design.arrays import Point
from fixture_design.errors import InputError

#: How far from ``facing`` the outward normal of the tip may be that touches, for points and balls [rad].
USUAL_SPREAD = 1.0

#: Coefficient of friction of fingertips that nobody gives one: rubber on metal, with something taken off.
USUAL_GRIP = 0.5


@dataclass(frozen=True, eq=False)
class Fingertip:
    """Where a finger touches.

    Attributes:
        link: its name in the model file.
        at: p_LT: the point, the centre of the ball or the middle of the pad, shape (3,) [m].
        facing: unit, out of the finger towards the part: of a pad its normal, of others the middle of what may touch.
        ball: radius [m]; None for points and pads.
        pad: width (along ``along``) and height [m]; None for points and balls.
        along: unit, across ``facing``; None without a pad.
        soft: radius of the patch that its skin makes where it touches in a point, and resists turning [m]; None: hard.
        friction: coefficient; None takes the hand's.
        spread: largest angle between ``facing`` and the direction in which it touches [rad].
    """

    name: str
    link: str
    at: Point
    facing: Point
    ball: float | None = None
    pad: tuple[float, float] | None = None
    along: Point | None = None
    soft: float | None = None
    friction: float | None = None
    spread: float = USUAL_SPREAD

    @property
    def radius(self) -> float:
        """By how much the surface of the tip is ahead of ``at`` [m]."""
        return self.ball or 0.0

    @property
    def across(self) -> Point:
        """Unit vector across ``facing`` and ``along``; of tips without a pad any one across ``facing``."""
        return np.cross(self.facing, self.sideways)

    @property
    def sideways(self) -> Point:
        """``along``, or of tips without a pad any unit vector across ``facing``."""
        if self.along is not None:
            return self.along
        axis = np.eye(3)[int(np.argmin(np.abs(self.facing)))]
        across = np.cross(self.facing, axis)
        return across / np.linalg.norm(across)


@dataclass(frozen=True)
class JointRule:
    """What a sidecar says of a joint; None leaves what the model file says.

    Attributes:
        lower, upper: its range [rad or m].  effort: the largest torque or force of its drive [N m or N].
        follows: the joint whose position times ``multiplier`` plus ``offset`` is this one's.
    """

    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    follows: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, eq=False)
class Hand:
    """A hand as its files describe it; `HandModel` is one that can be moved.

    Attributes:
        model: URDF or SDF file, absolute.
        fingertips: none leaves them to be guessed from the leaf links.
        friction: of fingertips and links that have none of their own.
        joints: rules by joint name.
        source: the sidecar; None without one.
    """

    name: str
    model: Path
    fingertips: tuple[Fingertip, ...] = ()
    friction: float = USUAL_GRIP
    joints: Mapping[str, JointRule] = field(default_factory=dict)
    source: Path | None = None


@dataclass(frozen=True)
class Joint:
    """A movable joint of a hand, all said and done.

    Attributes:
        kind: "revolute" or "prismatic".
        lower, upper: finite [rad or m].  effort: inf where nobody gives one [N m or N].
        follows, multiplier, offset: as in `JointRule`; ``follows`` is None for joints that move on their own.
        unlimited: whether nobody gives limits, so that ``lower`` and ``upper`` are where it is looked for and no stops.
    """

    name: str
    kind: str
    lower: float
    upper: float
    effort: float = inf
    follows: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0
    unlimited: bool = False


class HandError(InputError):
    """A hand's files do not describe a hand: links or joints that are not there, a model Drake refuses."""
