"""Convex bodies in space with their apices, edges and facets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.tolerances import COPLANAR_ANGLE, MERGE_VERTICES


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex body, features sorted by their coordinates.

    Attributes:
        vertices: shape (v, 3) [m].  edges: shape (e, 2), the smaller index first.
        normals, offsets: of the facets, n . x <= offset, outward and unit; shapes (f, 3), (f,).
        corners: the vertices of each facet, counter-clockwise seen from outside.
    """

    vertices: Points
    edges: Int[np.ndarray, "_ 2"]
    normals: Points
    offsets: Weights
    corners: tuple[Indices, ...]

    @classmethod
    def hull_of(cls, points: Points) -> Polytope:
        """The convex hull of some points; triangles in one plane are one facet."""
        from scipy.spatial import ConvexHull  # noqa: PLC0415 - 50 ms of any start

        hull = ConvexHull(points)
        vertices = points[hull.vertices]
        order = np.lexsort(np.round(vertices, 9).T[::-1])
        vertices = vertices[order]
        size = float(np.ptp(vertices, axis=0).max())
        planes: list[np.ndarray] = []
        for plane in hull.equations:
            if not any(plane[:3] @ other[:3] > np.cos(COPLANAR_ANGLE) for other in planes):
                planes.append(plane)
        normals = np.array(planes)[:, :3]
        heights = vertices @ normals.T
        offsets = heights.max(axis=0)
        on = heights >= offsets - MERGE_VERTICES * size * 10
        corners = [_around(vertices, np.flatnonzero(on[:, k]), normals[k]) for k in range(len(normals))]
        sorting = sorted(range(len(corners)), key=lambda k: np.round(vertices[corners[k]].mean(axis=0), 9).tolist())
        corners = [corners[k] for k in sorting]
        sides = {tuple(sorted(pair)) for ring in corners for pair in zip(ring, np.roll(ring, -1), strict=True)}
        return cls(vertices, np.array(sorted(sides)), normals[sorting], offsets[sorting], tuple(corners))

    @property
    def directions(self) -> Points:
        """Unit vectors along the edges, shape (e, 3)."""
        along = self.vertices[self.edges[:, 1]] - self.vertices[self.edges[:, 0]]
        return along / np.linalg.norm(along, axis=1, keepdims=True)

    @property
    def volume(self) -> float:
        """Each facet with the first vertex makes a pyramid [m^3]."""
        first, total = self.vertices[0], 0.0
        for ring in self.corners:
            a, b, c = self.vertices[ring[0]], self.vertices[ring[1:-1]], self.vertices[ring[2:]]
            total += float(((a - first) * np.cross(b - a, c - a).sum(axis=0)).sum()) / 6
        return total

    def outward(self) -> Points:
        """For each edge the sum of its two facets' normals, shape (e, 3)."""
        result = []
        for first, second in self.edges:
            owners = [k for k, ring in enumerate(self.corners) if first in ring and second in ring]
            result.append(self.normals[owners].sum(axis=0))
        return np.array(result)


def _around(vertices: Points, chosen: Indices, normal: np.ndarray) -> Indices:
    """Vertices of a facet in order, counter-clockwise seen from outside."""
    center = vertices[chosen].mean(axis=0)
    first = vertices[chosen[0]] - center
    second = np.cross(normal, first)
    away = vertices[chosen] - center
    return chosen[np.argsort(np.arctan2(away @ second, away @ first))]
