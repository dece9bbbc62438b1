"""Joints at their stops: their drives push on in vain, and fingers give way only as far as their joints go.

What a joint that moves on its own has left to go is what it and all joints that follow it have. It is at a stop if no
contact would move by more than the gap within which fingertips touch anyway:  room |dp/dq| <= gap. There the joint
cannot follow a part that gives way: its drive can press it against the stop, which makes it a fixed link, but cannot
press it onto the part. The stop also takes what pushes the joint into it; that is not counted, as only drives are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Mask, Weights
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.posture import Posture
from fixture_design.tolerances import FINGER_GAP


def room(model: HandModel, q: Weights) -> Float[np.ndarray, "f 2"]:
    """How far each joint that moves on its own can go down and up, with those that follow it [rad or m]."""
    matrix, _ = model.following
    endless = np.array([joint.unlimited for joint in model.joints])
    below = np.where(endless, np.inf, np.maximum(q - model.lower, 0.0))[:, None]
    above = np.where(endless, np.inf, np.maximum(model.upper - q, 0.0))[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        down = np.where(matrix > 0, below / matrix, np.where(matrix < 0, above / -matrix, np.inf))
        up = np.where(matrix > 0, above / matrix, np.where(matrix < 0, below / -matrix, np.inf))
    return np.stack([down.min(axis=0), up.min(axis=0)], axis=1)


@dataclass(frozen=True, eq=False)
class Stopped:
    """Which of the joints that move on their own are at their lower stop, and at their upper one; shape (f,)."""

    lower: Mask
    upper: Mask

    @classmethod
    def of(cls, posture: Posture, speeds: Weights) -> Stopped:
        """Args: speeds: how fast each joint moves any contact at most, shape (f,) [m/rad or 1]; 0: it moves none."""
        left = room(posture.model, posture.q) * speeds[:, None]
        at = (left <= FINGER_GAP) & (speeds > 0)[:, None]
        return cls(at[:, 0], at[:, 1])

    def __bool__(self) -> bool:
        return bool(self.lower.any() or self.upper.any())

    def in_words(self, model: HandModel) -> str:
        """Joint by joint."""
        sides = [
            f"{model.joints[number].name} is at its {side} stop"
            for side, at in (("lower", self.lower), ("upper", self.upper))
            for number in model.free[at].tolist()
        ]
        return ", ".join(sides)


@dataclass(frozen=True)
class Travel:
    """How far a fingertip can go along ``facing`` and back, by what its joints have left [m]; to first order."""

    closing: float
    opening: float

    @classmethod
    def of(cls, posture: Posture, tip: Fingertip) -> Travel:
        model, q = posture.model, posture.q
        facing = model.poses(q)[tip.link].vectors(tip.facing[None])[0]
        speeds = facing @ model.jacobian(q, tip.link, tip.at)
        left = np.where((speeds != 0)[:, None], room(model, q), 0.0)
        down, up = left[:, 0], left[:, 1]
        closing = np.where(speeds > 0, up, down) @ np.abs(speeds)
        opening = np.where(speeds > 0, down, up) @ np.abs(speeds)
        return cls(float(closing), float(opening))
