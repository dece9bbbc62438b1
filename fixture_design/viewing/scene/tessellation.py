"""Every solid shape as triangles, so that all adapters draw the same."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from fixture_design.contacts import tangents
from fixture_design.viewing.scene.shapes import (
    Arrow,
    Box,
    Corners,
    Cylinder,
    Lines,
    Mesh,
    Points3,
    Shape,
    Sphere,
    Vector3,
)

#: Corners of a circle; rings of a ball from pole to pole.
_ROUND, _RINGS = 24, 12
#: Length and radius of an arrow's head, in radii of its shaft; no head is longer than this part of the arrow [-].
_HEAD_LENGTH, _HEAD_RADIUS, _MOST_HEAD = 6.0, 2.6, 0.5


def triangles_of(shape: Shape) -> Mesh:
    """The shape's surface, in W; lines have none.

    Raises:
        TypeError: lines.
    """
    match shape:
        case Mesh():
            return shape
        case Sphere():
            return _ball(shape)
        case Cylinder():
            end = shape.radius if shape.end_radius is None else shape.end_radius
            return _turned(shape.start, shape.end, [(0.0, 0.0), (shape.radius, 0.0), (end, 1.0), (0.0, 1.0)])
        case Arrow():
            return _arrow(shape)
        case Box():
            return _block(shape)
        case Lines():
            raise TypeError("lines have no surface")


def _arrow(arrow: Arrow) -> Mesh:
    """A shaft and a head, which shrink together where the arrow is short."""
    length = arrow.length
    head = min(_HEAD_LENGTH * arrow.radius, _MOST_HEAD * length)
    radius = head / _HEAD_LENGTH
    neck = 1.0 - head / length if length > 0 else 0.0
    wide = _HEAD_RADIUS * radius
    profile = [(0.0, 0.0), (radius, 0.0), (radius, neck), (wide, neck), (0.0, 1.0)]
    return _turned(arrow.start, arrow.end, profile)


def _turned(start: Vector3, end: Vector3, profile: list[tuple[float, float]]) -> Mesh:
    """A surface of revolution about the line from start to end: (radius [m], part of the length) along its profile.

    Each piece of the profile has vertices of its own: its corners are sharp, its turn is smooth.
    """
    axis = end - start
    length = float(np.linalg.norm(axis))
    unit = axis / length if length > 0 else np.array([0.0, 0.0, 1.0])
    first, second = tangents(unit)
    angles = 2 * np.pi * np.arange(_ROUND) / _ROUND
    # tangents of a unit vector u are t and u X t: counter-clockwise about it
    circle = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)
    vertices, corners = [], []
    for (r, a), (s, b) in pairwise(profile):
        base = sum(map(len, vertices))
        vertices += [start + a * axis + r * circle, start + b * axis + s * circle]
        corners.append(_strip(base, r > 0, s > 0))
    return Mesh(np.vstack(vertices), np.vstack(corners), smooth=True)


def _strip(base: int, low: bool, high: bool) -> Corners:
    """Two circles of vertices joined; where one of them is a point, one triangle a side."""
    near = base + np.arange(_ROUND)
    following = base + (np.arange(_ROUND) + 1) % _ROUND
    parts = []
    if low:
        parts.append(np.column_stack([near, following, near + _ROUND]))
    if high:
        parts.append(np.column_stack([following, following + _ROUND, near + _ROUND]))
    return np.vstack(parts) if parts else np.zeros((0, 3), dtype=np.int64)


def _ball(ball: Sphere) -> Mesh:
    polar = np.pi * np.arange(1, _RINGS) / _RINGS
    around = 2 * np.pi * np.arange(_ROUND) / _ROUND
    rings = np.stack(
        [
            np.outer(np.sin(polar), np.cos(around)),
            np.outer(np.sin(polar), np.sin(around)),
            np.repeat(np.cos(polar)[:, None], _ROUND, axis=1),
        ],
        axis=2,
    ).reshape(-1, 3)
    count = len(rings)
    here = np.arange(_ROUND)
    there = (here + 1) % _ROUND
    corners = [np.column_stack([np.full(_ROUND, count), here, there])]
    for ring in range(_RINGS - 2):
        a, b = ring * _ROUND + here, ring * _ROUND + there
        corners += [np.column_stack([a, a + _ROUND, b]), np.column_stack([b, a + _ROUND, b + _ROUND])]
    last = (_RINGS - 2) * _ROUND
    corners.append(np.column_stack([np.full(_ROUND, count + 1), last + there, last + here]))
    unit = np.vstack([rings, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    return Mesh(ball.center + ball.radius * unit, np.vstack(corners), smooth=True)


def _block(box: Box) -> Mesh:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    vertices = box.center + (signs * box.sides / 2) @ box.axes.T
    sides = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return Mesh(vertices, np.vstack([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]]))


def facet_soup(mesh: Mesh) -> tuple[Points3, Points3]:
    """Three vertices a triangle with their normals, shapes (3 t, 3): for renderers that want both.

    Normals are the triangles' own, or averaged by area at shared vertices where the mesh is smooth.
    """
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if not mesh.smooth:
        return corners.reshape(-1, 3), _unit(np.repeat(normals, 3, axis=0))
    sums = np.zeros_like(mesh.vertices)
    for k in range(3):
        np.add.at(sums, mesh.triangles[:, k], normals)
    return corners.reshape(-1, 3), _unit(sums[mesh.triangles].reshape(-1, 3))


def _unit(vectors: Points3) -> Points3:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(lengths > 0, vectors / np.where(lengths > 0, lengths, 1.0), [0.0, 0.0, 1.0])


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Some meshes, at least one, as one; it is smooth if the first one is."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    triangles = [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
    return Mesh(np.vstack([mesh.vertices for mesh in meshes]), np.vstack(triangles), meshes[0].smooth)


def hull_of(points: Points3) -> Points3:
    """The corners of the convex hull of points, or all of them where they lie in a plane: what stands out most does so
    in one of them, whichever way it is looked at.
    """
    from scipy.spatial import ConvexHull, QhullError  # noqa: PLC0415 - a third of a second

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points


def extent(shapes: Iterable[Shape]) -> Points3:
    """Points that a picture of some shapes, at least one, must hold, shape (n, 3)."""
    return np.vstack(
        [
            shape.segments.reshape(-1, 3) if isinstance(shape, Lines) else triangles_of(shape).vertices
            for shape in shapes
        ]
    )
