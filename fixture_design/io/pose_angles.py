"""Angles of a pose, chosen so that they give the same rotation again, to the last bit where that is possible.

Files hold angles, poses hold matrices. Angles found from a matrix are off by rounding; people's angles have few digits,
so the shortest decimals that reproduce the matrix are looked for first.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fixture_design.arrays import Points
from fixture_design.layout import Pose

#: Digits that a float holds.
_MOST_DIGITS = 17


def roll_pitch_yaw(pose: Pose) -> list[float]:
    """[roll, pitch, yaw] with R = Rz(yaw) Ry(pitch) Rx(roll) [rad]; one of many where pitch is a right angle."""
    R = pose.rotation
    pitch = float(np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])))
    usual = [float(np.arctan2(R[2, 1], R[2, 2])), pitch, float(np.arctan2(R[1, 0], R[0, 0]))]
    upright = [float(np.arctan2(-R[1, 2], R[1, 1])), pitch, 0.0]

    def rotation(angles: list[float]) -> Points:
        return Pose.from_xyz_rpy(np.zeros(3), angles).rotation

    best = min((usual, upright), key=lambda angles: float(np.abs(rotation(angles) - R).max()))
    return _shortest(best, rotation, R)


def planar_angle(pose: Pose) -> float:
    """theta [rad], counter-clockwise."""

    def rotation(angles: list[float]) -> Points:
        return Pose.from_xy_theta(np.zeros(2), angles[0]).rotation

    theta = float(np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0]))
    return _shortest([theta], rotation, pose.rotation)[0]


def _shortest(angles: list[float], rotation: Callable[[list[float]], Points], wanted: Points) -> list[float]:
    for digits in range(1, _MOST_DIGITS + 1):
        rounded = [float(f"{angle:.{digits}g}") for angle in angles]
        if np.array_equal(rotation(rounded), wanted):
            return rounded
    return angles
