"""Balls around ever smaller groups of triangles: what one signed distance can rule out at once.

A signed distance changes by no more than the way that was gone. If a ball of radius r around c holds some triangles,
then every point of them is between phi(c) - r and phi(c) + r from another surface: one question about c answers for
all of them, and for curved and non-convex surfaces alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.shapes import Directions, OfTriangle, PerPoint, Triangles, Vertices

#: Balls of one level that share a ball of the level above.
_CHILDREN = 4

#: Bits of each coordinate in the order of triangles: a thousandth of the part's size tells neighbours apart.
_BITS = 10


@dataclass(frozen=True, eq=False)
class Level:
    """Balls, shape (n, 3) and (n,) [m]; those of the next level inside ball i are ``_CHILDREN`` i and following."""

    centers: Directions
    radii: PerPoint


@dataclass(frozen=True, eq=False)
class SphereTree:
    """The balls of a mesh, level by level from one ball around all to one around each triangle.

    Attributes:
        levels: coarsest first.
        triangles: which triangle each ball of the last level is around, shape (t,).
    """

    levels: tuple[Level, ...]
    triangles: OfTriangle

    def children(self, level: int, balls: Indices) -> Indices:
        """The balls of the next level inside some balls of this one."""
        count = len(self.levels[level + 1].radii)
        inside = (balls[:, None] * _CHILDREN + np.arange(_CHILDREN)).ravel()
        return inside[inside < count]

    def some_triangle(self, level: int, ball: int) -> int:
        """One of the triangles in a ball."""
        return int(self.triangles[ball * _CHILDREN ** (len(self.levels) - 1 - level)])


def sphere_tree(vertices: Vertices, triangles: Triangles) -> SphereTree:
    """The tree of a mesh of one triangle or more; 10 ms for 10,000 triangles."""
    corners = vertices[triangles]
    order = np.argsort(_places_on_curve(corners.mean(axis=1)), kind="stable")
    corners = corners[order]
    levels, width = [], 1
    while True:
        levels.append(_balls(corners, width))
        if width >= len(triangles):
            return SphereTree(tuple(reversed(levels)), order)
        width *= _CHILDREN


def _balls(corners: np.ndarray, width: int) -> Level:
    """Around each ``width`` triangles in a row: the centre of their box, and the corner furthest from it."""
    starts = np.arange(0, len(corners), width)
    low = np.minimum.reduceat(corners.min(axis=1), starts)
    high = np.maximum.reduceat(corners.max(axis=1), starts)
    centers = (low + high) / 2
    away = np.linalg.norm(corners - np.repeat(centers, width, axis=0)[: len(corners), None, :], axis=2)
    return Level(centers, np.maximum.reduceat(away.max(axis=1), starts))


def _places_on_curve(points: Directions) -> OfTriangle:
    """Morton's curve: coordinates as whole numbers, their bits interleaved, so that neighbours mostly follow."""
    extent = np.ptp(points, axis=0).max() or 1.0
    cells = ((points - points.min(axis=0)) / extent * (2**_BITS - 1)).astype(np.int64)
    places = np.zeros(len(points), dtype=np.int64)
    for bit in range(_BITS):
        for axis in range(3):
            places |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return places
