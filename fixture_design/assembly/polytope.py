"""Convex bodies in space with their apices, edges and facets: boxes, and meshes that are convex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.assembly.assembly import AssemblyBody
from fixture_design.errors import UnsupportedError
from fixture_design.tolerances import COPLANAR_ANGLE, MERGE_VERTICES

#: A mesh is convex if its hull has no more than this much more volume [-].
_CONVEX = 1e-6


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


def polytope_of(body: AssemblyBody) -> Polytope:
    """The body as a polytope, in W or in the moving body's frame.

    Raises:
        GeometryError: a mesh that cannot be read.
        UnsupportedError: a mesh that is not convex.
    """
    if body.box is not None:
        corners = np.array(list(np.ndindex(2, 2, 2)), dtype=np.float64) - 0.5
        points = corners * body.box
    else:
        points = _mesh_points(body)
    return Polytope.hull_of(points if body.pose is None else body.pose.points(points))


def _mesh_points(body: AssemblyBody) -> Points:
    from scipy.spatial import ConvexHull  # noqa: PLC0415 - as above

    from fixture_design.geometry import load_part  # noqa: PLC0415 - reads meshes
    from fixture_design.layout import Part, Pose  # noqa: PLC0415 - as above

    assert body.file is not None
    kind = "mesh" if body.kind == "mesh" else "urdf"
    part = Part(
        name=body.file.stem, kind=kind, file=body.file, polygon=None, scale=body.scale, pose=Pose.identity(3),
        mass=None, center=None, form_error=None,
    )  # fmt: skip
    geometry = load_part(part)
    points = np.asarray(geometry.vertices)  # type: ignore[union-attr]
    triangles = points[np.asarray(geometry.triangles)]  # type: ignore[union-attr]
    volume = float(np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum()) / 6
    if ConvexHull(points).volume > volume * (1 + _CONVEX):
        raise UnsupportedError(
            "the body is not convex",
            source=body.file,
            expected="a convex body; several convex `fixed` bodies may touch",
        )
    return points
