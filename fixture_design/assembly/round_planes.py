"""The plane facets that a turned body may touch: around a hole, or its floor; and its end disks on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.assembly.circles import ALONG, dots
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.placement import Placement


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane facet: its border is that of a block's facet, or the wall of a blind hole around its floor."""

    normal: np.ndarray
    offset: float
    block: DrilledBlock | None
    facet: int
    hole: Hole | None

    def border(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far points in the plane are beyond the border, and which way is out of it."""
        if self.block is not None:
            return self.block.border(points, self.facet)
        assert self.hole is not None
        radial, rho = self.hole.seen(points)
        return rho - self.hole.radius, radial

    def disk_border(self, center: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """How far all of a disk is beyond the border, and which way is out of it."""
        if self.block is None or self.hole is None:
            beyond, out = self.border(center)
            return beyond - radius, out
        radial, rho = self.hole.seen(center)
        return self.hole.radius - rho - radius, -radial

    def aside(self, center: np.ndarray) -> np.ndarray:
        """Where a circle along the plane touches it for sure if it does: away from the hole."""
        if self.hole is None:
            return np.broadcast_to(np.linalg.svd(self.normal[None])[2][1], center.shape)
        away = center - self.hole.point
        away = away - dots(away, self.hole.axis)[:, None] * self.hole.axis
        away = away if self.block is not None else -away
        some = np.linalg.norm(away, axis=1, keepdims=True) > ALONG * self.hole.radius
        return np.where(some, away, np.linalg.svd(self.normal[None])[2][1])


@dataclass(frozen=True, eq=False)
class Flat:
    """A disk on a plane: the facet, the numbers of the disk's circle and of its pair with the facet, the disk's sense.

    Attributes:
        sense: 1 where the disk's outward normal is along the axis.  below: the name of the circle's pair.
    """

    plane: Plane
    circle: int
    sense: float
    below: str

    def tilts(self, place: Placement) -> tuple[np.ndarray, np.ndarray]:
        """Components of the axis along the plane (n, 2), and their directions (2, 3)."""
        basis = np.linalg.svd(self.plane.normal[None])[2][1:]
        return place.axis @ basis.T, basis

    def rim_points(self, place: Placement, count: int) -> np.ndarray:
        """Of ``count`` points around the rim those that are on the facet, of the first placement, shape (m, 3)."""
        circle = place.circle(self.circle)
        first = circle.angles_of(circle.center + self.plane.aside(circle.center))
        points = circle.points(first[:, None] + np.arange(count) * 2 * np.pi / count)[0]
        return points[self.plane.border(points)[0] <= 0]
