"""Bodies that are rectangles: Drake's boxes are exact where its hulls are not (a ball on a hull's vertex hangs)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Points
from fixture_design.errors import UnsupportedError

#: Sides and corners of a rectangle may be this far off, relative to its size [-]: decimals of a file leave 1e-15.
_SQUARE = 1e-9


@dataclass(frozen=True, eq=False)
class Rectangle:
    """Its centre [m], its angle (of the side from vertex 0 to vertex 1) [rad], and its two sides [m]."""

    centre: Point
    angle: float
    sides: tuple[float, float]

    @classmethod
    def of(cls, polygon: Points) -> Rectangle:
        """The rectangle with these vertices, counter-clockwise, shape (4, 2).

        Raises:
            UnsupportedError: a polygon that is none.
        """
        if len(polygon) != 4:
            raise UnsupportedError("only rectangles can be simulated so far", found=f"{len(polygon)} vertices")
        along, up = polygon[1] - polygon[0], polygon[3] - polygon[0]
        size = float(np.linalg.norm(along) * np.linalg.norm(up))
        skew = np.linalg.norm(polygon[0] + polygon[2] - polygon[1] - polygon[3]) ** 2
        if abs(along @ up) > _SQUARE * size or skew > _SQUARE * size:
            raise UnsupportedError("only rectangles can be simulated so far", found=f"{polygon.tolist()}"[:80])
        angle = float(np.arctan2(along[1], along[0]))
        return cls(polygon.mean(axis=0), angle, (float(np.linalg.norm(along)), float(np.linalg.norm(up))))


def rounded(polygon: Points, vertex: int, radius: float) -> Point:
    """The centre of the ball that rounds a corner of a rectangle, flush with both sides [m]."""
    before, after = polygon[vertex - 1] - polygon[vertex], polygon[(vertex + 1) % len(polygon)] - polygon[vertex]
    inward = before / np.linalg.norm(before) + after / np.linalg.norm(after)
    return polygon[vertex] + radius * inward
