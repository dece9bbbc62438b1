"""Whether elements have room beside a part: stems and bodies that cut it have none, many at a time.

A piece of an element is a cylinder around the normal: {x : low <= z <= high, |x - z n| <= radius}, with z the height
above the contact. A triangle cut to that slab is convex, and so is its projection along n; the cylinder is cut if the
projection comes nearer to the axis than the radius. The nearest point is on the rim of the cut triangle (three sides
and two cuts), unless the axis itself goes through the triangle. This is exact for the facets as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Weights, cross_products
from fixture_design.geometry.broad import Boxes
from fixture_design.geometry.nearest import distances
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Directions, Vector3
from fixture_design.layout import Column, Stem

#: Elements that are looked at in one go, so that pairs of elements and triangles fit into memory.
_AT_ONCE = 512
#: How deep the part may be in the ball of a tip, by the ball's radius [-]: strips of a bore reach into it a little.
_IN_TIP = 0.1
#: Sine of the angle to the axis below which a triangle is seen edge-on: its rim says all [-].
_EDGE_ON = 1e-12


@dataclass(frozen=True, eq=False)
class Places:
    """Where elements stand, in P: their contacts [m] and the part's outward unit normals there, shape (n, 3) each."""

    points: Directions
    normals: Directions

    def __len__(self) -> int:
        return len(self.points)

    def some(self, which: Indices) -> Places:
        return Places(self.points[which], self.normals[which])

    def at(self, height: float) -> Directions:
        """Points that far above the contacts."""
        return self.points + height * self.normals


def with_room(geometry: PartGeometry, places: Places, stem: Stem) -> Mask:
    """Which elements do not cut the part, shape (n,): neither with stem or body nor, beyond a little, with the tip.

    What is inside the part as a whole is not seen: a stem on a surface begins outside.
    """
    free = np.ones(len(places), dtype=bool)
    for start in range(0, len(places), _AT_ONCE):
        which = np.arange(start, min(start + _AT_ONCE, len(places)))
        if not stem.flat:
            which = which[_balls_free(geometry, places.some(which), stem.tip)]
        for column in stem.columns:
            which = which[_columns_free(geometry, places.some(which), column)]
        free[start : start + _AT_ONCE] = np.isin(np.arange(start, min(start + _AT_ONCE, len(places))), which)
    return free


def with_way(geometry: PartGeometry, places: Places, stem: Stem, out: Vector3) -> Mask:
    """Which elements the part does not run into, moved along a unit direction ``out`` in P, shape (n,).

    The element is moved the other way, in steps of its stem's radius, until it has left the part's box behind: what
    comes between two steps reaches into a stem by an eighth of its radius at most.
    """
    height = stem.columns[1].high + stem.body_radius
    count = int(np.ceil((2 * geometry.half_diagonal + height) / stem.radius))
    free = np.ones(len(places), dtype=bool)
    for step in range(1, count + 1):
        left = np.flatnonzero(free)
        moved = Places(places.points[left] - step * stem.radius * out, places.normals[left])
        free[left] = with_room(geometry, moved, stem)
    return free


def _balls_free(geometry: PartGeometry, places: Places, radius: float) -> Mask:
    centers = places.at(radius)
    least = (1 - _IN_TIP) * radius
    owner, triangle = geometry.triangle_tree.meeting((centers, centers), least)
    cut = (
        distances(geometry.vertices[geometry.triangles[triangle]], centers[owner]) < least if len(owner) else owner > 0
    )
    free = np.ones(len(places), dtype=bool)
    free[owner[cut]] = False
    return free


def _columns_free(geometry: PartGeometry, places: Places, column: Column) -> Mask:
    owner, triangle = geometry.triangle_tree.meeting(_boxes(places, column))
    corners = geometry.vertices[geometry.triangles[triangle]] - places.points[owner, None]
    near = _perhaps(corners, places.normals[owner], column)
    owner, corners = owner[near], corners[near]
    free = np.ones(len(places), dtype=bool)
    free[owner[_nearest_to_axis(corners, places.normals[owner], column) < column.radius]] = False
    return free


def _boxes(places: Places, column: Column) -> Boxes:
    """Around each cylinder: its discs reach r sqrt(1 - n_i^2) along axis i."""
    low, high = places.at(column.low), places.at(column.high)
    reach = column.radius * np.sqrt(np.maximum(1 - places.normals**2, 0.0))
    return np.minimum(low, high) - reach, np.maximum(low, high) + reach


def _perhaps(corners: Corners, normals: Directions, column: Column) -> Mask:
    """Pairs that a ball around the triangle does not rule out."""
    if not len(corners):
        return np.zeros(0, dtype=bool)
    middles = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
    heights = np.einsum("ij,ij->i", middles, normals)
    off = np.linalg.norm(middles - heights[:, None] * normals, axis=1)
    return (heights - reach < column.high) & (heights + reach > column.low) & (off - reach < column.radius)


def _nearest_to_axis(corners: Corners, normals: Directions, column: Column) -> Weights:
    """How near each triangle comes to its axis within the slab, shape (k,); infinite outside of it.

    Args:
        corners: from the contact, shape (k, 3, 3).
    """
    heights = np.einsum("kij,kj->ki", corners, normals)
    after, heights_after = np.roll(corners, -1, axis=1), np.roll(heights, -1, axis=1)
    rise = heights_after - heights
    level = rise == 0
    slope = np.where(level, 1.0, rise)
    at_low, at_high = (column.low - heights) / slope, (column.high - heights) / slope
    start = np.where(level, 0.0, np.clip(np.minimum(at_low, at_high), 0.0, 1.0))
    end = np.where(level, 1.0, np.clip(np.maximum(at_low, at_high), 0.0, 1.0))
    inside = np.where(level, (heights >= column.low) & (heights <= column.high), True)
    # a side wholly above or below is cut down to one of its ends, which is outside as well
    outside = (np.minimum(heights, heights_after) > column.high) | (np.maximum(heights, heights_after) < column.low)
    sides = corners - heights[:, :, None] * normals[:, None]
    ways = (after - heights_after[:, :, None] * normals[:, None]) - sides
    firsts, seconds = sides + start[:, :, None] * ways, sides + end[:, :, None] * ways
    to_sides = np.where(inside & ~outside, _to_origin(firsts, seconds), np.inf)
    nearest = to_sides.min(axis=1, initial=np.inf)
    for at in (at_low, at_high):
        crossing = ~level & (at >= 0) & (at <= 1)
        points = sides + np.where(crossing, at, 0.0)[:, :, None] * ways
        one, other = np.argmax(crossing, axis=1), 2 - np.argmax(crossing[:, ::-1], axis=1)
        rows = np.arange(len(corners))
        cut = _to_origin(points[rows, one], points[rows, other])
        nearest = np.minimum(nearest, np.where(crossing.sum(axis=1) >= 2, cut, np.inf))
    return np.where(_pierced(corners, normals, column), 0.0, nearest)


def _to_origin(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance from segments to the origin, shape (..., 3) twice to (...)."""
    along = second - first
    square = np.einsum("...i,...i->...", along, along)
    at = -np.einsum("...i,...i->...", first, along) / np.where(square > 0, square, 1.0)
    return np.linalg.norm(first + np.clip(at, 0.0, 1.0)[..., None] * along, axis=-1)


def _pierced(corners: Corners, normals: Directions, column: Column) -> Mask:
    """Whether the axis goes through the triangle within the slab."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = cross_products(first, second)
    slope = np.einsum("ij,ij->i", across, normals)
    faces = np.abs(slope) > _EDGE_ON * np.linalg.norm(across, axis=1)
    height = np.einsum("ij,ij->i", across, corners[:, 0]) / np.where(faces, slope, 1.0)
    turns = [
        np.einsum("ij,ij->i", cross_products(corners[:, k], corners[:, (k + 1) % 3]), normals) * np.sign(slope)
        for k in range(3)
    ]
    return faces & (np.min(turns, axis=0) >= 0) & (height >= column.low) & (height <= column.high)
