"""What lies under a flat tip: the triangles of the part in the tip's plane, and the walls that rise through it.

Coordinates in the plane are x along the tip, y across it, z along the outward normal, from the tip's centre.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, cross_products
from fixture_design.errors import GeometryError, format_length
from fixture_design.geometry.nearest import triangles_in_box
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.sets import place_text
from fixture_design.geometry.shapes import PerTriangle, Vector3
from fixture_design.tolerances import ALONG_NORMAL, COPLANAR_ANGLE

#: Triangles by the coordinates of their corners in the plane, and straight pieces by those of their ends.
FlatTriangles = Float[np.ndarray, "t 3 2"]
Segments = Float[np.ndarray, "s 2 2"]


@dataclass(frozen=True, eq=False)
class Footprint:
    """A rectangle in a plane, and the part around it.

    Attributes:
        center: p_PC [m].  x, y, z: unit vectors in P.
        half: half its width along x and half its height along y [m]; the height of a line is zero.
        flat: the triangles in the plane that may lie under it, in coordinates [x, y], shape (t, 3, 2) [m].
        walls: where the part rises through the plane near it: triangles cut a little above, shape (s, 2, 2) [m].
        outward: the direction in the plane that leads out of each wall's material, shape (s, 2), any length.
    """

    center: Point
    x: Vector3
    y: Vector3
    z: Vector3
    half: tuple[float, float]
    flat: FlatTriangles
    walls: Segments
    outward: Float[np.ndarray, "s 2"]

    def points(self, flat: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n 3"]:
        """Points of the plane in P [m]."""
        return self.center + flat @ np.array([self.x, self.y])


def footprint(
    geometry: PartGeometry, center: Point, normal: Point, along: Point, half: tuple[float, float], gap: float, what: str
) -> Footprint:
    """The rectangle with its width along the projection of a direction, and the part around it.

    A triangle lies in the plane if its normal does within ``COPLANAR_ANGLE`` and its corners as far as that angle and
    the rounding of vertices allow, but no further than the gap. Walls are taken at the gap's height.

    Args:
        center: p_PC [m].  normal: outward, any length.  along: in P, any length.
        half: half the width and the height [m].  gap: [m].
        what: the tip in words, for messages.

    Raises:
        GeometryError: ``along`` is the normal.
    """
    z = normal / np.linalg.norm(normal)
    direction = along / np.linalg.norm(along)
    x = direction - (direction @ z) * z
    length = float(np.linalg.norm(x))
    if length < ALONG_NORMAL:
        raise GeometryError(
            f"{what} cannot have its direction along the normal of the surface",
            found=f"along {np.round(along, 6).tolist()} (part frame)",
            expected="`along` in the plane of the facet",
        )
    x /= length
    y = cross_products(z, x)
    size = float(np.hypot(*half))
    slack = min(geometry.on_edge + COPLANAR_ANGLE * size, max(gap, geometry.on_edge))
    level = gap + geometry.on_edge
    reach = np.abs(x) * half[0] + np.abs(y) * half[1] + np.abs(z) * level + geometry.on_edge
    near = triangles_in_box(geometry, center - reach, center + reach)
    corners = (geometry.vertices[geometry.triangles[near]] - center) @ np.array([x, y, z]).T
    flat = _in_plane(corners, slack)
    walls, outward = _cut(corners[~flat], level)
    return Footprint(center, x, y, z, half, corners[flat][:, :, :2], walls, outward)


def _in_plane(corners: Float[np.ndarray, "t 3 3"], slack: float) -> np.ndarray:
    """Which triangles lie in the plane z = 0, facing up."""
    low = (np.abs(corners[:, :, 2]) <= slack).all(axis=1)
    normals = cross_products(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    tilt = np.hypot(normals[:, 0], normals[:, 1])
    return low & (normals[:, 2] > 0) & (tilt <= COPLANAR_ANGLE * normals[:, 2])


def _cut(corners: Float[np.ndarray, "t 3 3"], level: float) -> tuple[Segments, Float[np.ndarray, "s 2"]]:
    """Where triangles cross z = level, and the direction out of the material there."""
    above = corners[:, :, 2] > level
    crossing = above.any(axis=1) & ~above.all(axis=1)
    corners, above = corners[crossing], above[crossing]
    following = np.roll(corners, -1, axis=1)
    change = above != np.roll(above, -1, axis=1)
    rise = np.where(change, following[:, :, 2] - corners[:, :, 2], 1.0)
    share = (level - corners[:, :, 2]) / rise
    points = corners[:, :, :2] + share[:, :, None] * (following - corners)[:, :, :2]
    # every crossing triangle has two sides that cross
    walls = points[change].reshape(-1, 2, 2)
    normals = cross_products(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return walls, normals[:, :2]


def check_clear(geometry: PartGeometry, tip: Footprint, gap: float, what: str) -> None:
    """Whether the part leaves room for the tip beside the facet.

    Raises:
        GeometryError: a wall enters the rectangle by more than the gap; the message says where, and how far the tip
            reaches behind it.
    """
    if not len(tip.walls):
        return
    half = np.maximum(tip.half, gap + geometry.on_edge)
    depths, places = _deepest(tip.walls, half)
    worst = int(np.argmax(depths))
    if depths[worst] <= gap:
        return
    into = -tip.outward[worst] / np.linalg.norm(tip.outward[worst])
    behind = float(np.abs(into) @ np.array(tip.half) - into @ places[worst])
    place = tip.points(places[worst][None])[0]
    raise GeometryError(
        f"{what} cuts {format_length(round(behind, 9))} into {geometry.name!r} at {place_text(place)} (part frame)",
        expected="a place with room for it, or a smaller tip",
    )


def _deepest(walls: Segments, half: Float[np.ndarray, 2]) -> tuple[PerTriangle, Float[np.ndarray, "s 2"]]:
    """For each wall how far it enters the rectangle |x| <= a, |y| <= b at most (negative: stays out), and where.

    The distance inside, min(a - |x|, b - |y|), is concave and piecewise linear: its largest value on a wall is at an
    end or where two of the four linear pieces are equal.
    """
    start, step = walls[:, 0], walls[:, 1] - walls[:, 0]
    offsets = np.concatenate([half - start, half + start], axis=1)
    slopes = np.concatenate([-step, step], axis=1)
    first, second = np.triu_indices(4, 1)
    apart = slopes[:, first] - slopes[:, second]
    meet = (offsets[:, second] - offsets[:, first]) / np.where(apart == 0, 1.0, apart)
    shares = np.clip(np.hstack([np.zeros((len(walls), 1)), np.ones((len(walls), 1)), meet]), 0.0, 1.0)
    inside = (offsets[:, None, :] + shares[:, :, None] * slopes[:, None, :]).min(axis=2)
    best = np.argmax(inside, axis=1)
    rows = np.arange(len(walls))
    return inside[rows, best], start + shares[rows, best, None] * step
