"""Planar layouts in space: the plane is z = 0, turns are about z. Everything below takes both kinds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Points, Vector
from fixture_design.viewing.scene.shapes import Points3, Vector3

#: Rotations below this, per unit of size, are translations [-].
_STRAIGHT = 1e-9


def lifted(point: Point) -> Vector3:
    """A point or direction with its third coordinate, zero in the plane."""
    return np.concatenate([np.asarray(point, dtype=np.float64), np.zeros(3 - len(point))])


def lifted_rows(points: Points) -> Points3:
    """Points or directions as rows, with their third coordinate."""
    return np.hstack([points, np.zeros((len(points), 3 - points.shape[1]))])


@dataclass(frozen=True, eq=False)
class Twist:
    """A displacement [dx; dtheta] about W's origin, or a wrench [f; m], with three coordinates each.

    ``along``: dx or f.  ``about``: dtheta or m.
    """

    along: Vector3
    about: Vector3

    @classmethod
    def of_motion(cls, motion: Vector) -> Twist:
        """From [dx, dy, dtheta] or six coordinates."""
        if len(motion) == 3:
            return cls(lifted(motion[:2]), np.array([0.0, 0.0, float(motion[2])]))
        return cls(motion[:3].astype(np.float64), motion[3:].astype(np.float64))

    def at(self, point: Vector3) -> Vector3:
        """The velocity of a point under the displacement."""
        return self.along + np.cross(self.about, point)

    def moment_at(self, point: Vector3) -> Vector3:
        """The moment of the wrench about a point."""
        return self.about - np.cross(point, self.along)

    def is_straight(self, center: Vector3, size: float) -> bool:
        """Whether it turns a part of this size about ``center`` by nothing that could be seen."""
        turned = float(np.linalg.norm(self.about)) * size
        return turned <= _STRAIGHT * max(float(np.linalg.norm(self.at(center))), turned)
