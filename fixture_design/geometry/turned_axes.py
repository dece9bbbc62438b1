"""Axes about which vertices of a mesh lie in rings: circles through three neighbours that many neighbours agree on.

The rings of a turned part say where its axis is whatever triangles join them: folded ones, along the longer diagonals
of the quadrilaterals between two rings, have normals that say nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices
from fixture_design.contacts.friction import tangents
from fixture_design.geometry.shapes import Directions, EdgeEnds, PerPoint, Vector3, Vertices
from fixture_design.tolerances import RING_ANGLE

#: Vertices of a ring, at least: four bevels between two flats; and triples of neighbours among these.
FEWEST_ON_RING = 5
_FEWEST_TRIPLES = 3
#: Edges at a vertex that is on a ring, at most; more meet at poles and hubs.
_MOST_EDGES = 12
#: Angle by which a ring turns from edge to edge, at least and at most [rad], and how much longer than the next an edge
#: may be [-].
_LEAST_TURN, _MOST_TURN, _UNEVEN = 0.03, RING_ANGLE + 0.02, 4.0
#: The middle one of three vertices is this many tolerances off the line of the others, or says nothing of a circle [-].
_CLEAR = 10.0
#: Triples are compared in cells of this size: of places relative to the part, of directions [-].
_CELL, _DIRECTION_CELL = 5e-4, 4e-3
#: Cells are at least so many tolerances wide: three neighbours say that much less about a circle than all do [-].
_WITHIN_CELL = 20.0
#: Rings that are off an axis by this many tolerances are tried on it [-].
_NEAR = 20.0
#: No direction that a part has on purpose: which way an axis counts as positive.
_GENERIC = np.array([0.5773, 0.2113, 0.7887])

#: Points of one ring of many.
_Group = Float[np.ndarray, "_ 3"]


@dataclass(frozen=True, eq=False)
class Axis:
    """A line about which rings of vertices lie.

    Attributes:
        point: on it [m].  direction: unit.
        vertices: numbers of those on the rings that were found about it.
    """

    point: Vector3
    direction: Vector3
    vertices: Indices

    def places(self, points: Directions) -> tuple[PerPoint, PerPoint]:
        """Distances from the axis and heights along it [m]."""
        away = points - self.point
        along = away @ self.direction
        return np.linalg.norm(away - np.outer(along, self.direction), axis=1), along

    def azimuths(self, points: Directions) -> PerPoint:
        """Angles about the axis [rad]."""
        first, second = tangents(self.direction)
        away = points - self.point
        return np.arctan2(away @ second, away @ first)

    def outward(self, azimuths: PerPoint) -> Directions:
        """Unit directions away from the axis at some angles about it."""
        first, second = tangents(self.direction)
        return np.outer(np.cos(azimuths), first) + np.outer(np.sin(azimuths), second)


@dataclass(frozen=True, eq=False)
class _Circle:
    vertices: Indices
    center: Vector3
    normal: Vector3
    radius: float


def axes_of(vertices: Vertices, edges: EdgeEnds, tolerance: float, size: float) -> Iterator[Axis]:
    """Axes with rings of vertices around them, those with most vertices first.

    Args:
        edges: vertex numbers at the ends of the edges between facets, shape (e, 2).
        tolerance: how far a vertex may be off a ring [m].  size: of the part [m].
    """
    circles = sorted(_circles(vertices, edges, tolerance, size), key=lambda circle: -len(circle.vertices))
    if not circles:
        return
    centers = np.array([circle.center for circle in circles])
    normals = np.array([circle.normal for circle in circles])
    radii = np.array([circle.radius for circle in circles])
    free = np.ones(len(circles), dtype=bool)
    found = []
    for index, circle in enumerate(circles):
        if not free[index]:
            continue
        away = centers - circle.center
        along = away @ circle.normal
        off = np.linalg.norm(away - np.outer(along, circle.normal), axis=1)
        turned = np.linalg.norm(np.cross(normals, circle.normal), axis=1)
        near = free & (off <= _NEAR * tolerance * (1 + np.abs(along) / circle.radius))
        near &= turned <= _NEAR * tolerance * (1 / radii + 1 / circle.radius)
        near[index] = True
        free &= ~near
        found.append(_axis([circles[other] for other in np.flatnonzero(near)], vertices))
    yield from sorted(found, key=lambda axis: (-len(axis.vertices), np.round(axis.point / size, 6).tolist()))


def _axis(circles: list[_Circle], vertices: Vertices) -> Axis:
    """The line that all circles' vertices are round about, by least squares."""
    groups = [vertices[circle.vertices] for circle in circles]
    normal = _normal(groups)
    center = _center(groups, normal)
    return Axis(center, normal, np.unique(np.concatenate([circle.vertices for circle in circles])))


def _normal(groups: list[_Group]) -> Vector3:
    """The normal of the parallel planes that groups of points lie in."""
    spread = np.vstack([group - group.mean(axis=0) for group in groups])
    normal = np.linalg.eigh(spread.T @ spread)[1][:, 0] if len(spread) > 2 else _GENERIC
    return normal if normal @ _GENERIC > 0 else -normal


def _center(groups: list[_Group], normal: Vector3) -> Vector3:
    """A point of the axis along a normal about which each group of points is on a circle: |x|^2 = 2 c . x + const."""
    frame = np.array(tangents(normal))
    middle = np.vstack(groups).mean(axis=0)
    flat = [(group - middle) @ frame.T for group in groups]
    rows = np.vstack([2 * (points - points.mean(axis=0)) for points in flat])
    squares = [np.sum(points**2, axis=1) for points in flat]
    sides = np.concatenate([square - square.mean() for square in squares])
    return middle + np.linalg.lstsq(rows, sides, rcond=None)[0] @ frame


def _circles(vertices: Vertices, edges: EdgeEnds, tolerance: float, size: float) -> Iterator[_Circle]:
    """Circles that three triples of neighbouring vertices or more agree on."""
    triples = _triples(len(vertices), edges)
    a, b, c = (vertices[triples[:, column]] for column in range(3))
    u, v = a - b, c - b
    lengths = np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)
    square = np.cross(u, v)
    turn = np.arctan2(np.linalg.norm(square, axis=1), -np.einsum("ij,ij->i", u, v))
    with np.errstate(divide="ignore", invalid="ignore"):
        even = np.maximum(lengths[0] / lengths[1], lengths[1] / lengths[0]) <= _UNEVEN
    bulge = np.linalg.norm(square, axis=1) / np.maximum(np.linalg.norm(u - v, axis=1), tolerance)
    kept = (turn >= _LEAST_TURN) & (turn <= _MOST_TURN) & (bulge >= _CLEAR * tolerance) & even
    if not kept.any():
        return
    triples, b, u, v, square = triples[kept], b[kept], u[kept], v[kept], square[kept]
    sizes = np.einsum("ij,ij->i", square, square)
    toward = np.einsum("ij,ij->i", u, u)[:, None] * v - np.einsum("ij,ij->i", v, v)[:, None] * u
    away = np.cross(toward, square) / (2 * sizes[:, None])
    normals = square / np.sqrt(sizes)[:, None]
    normals *= np.where(normals @ _GENERIC < 0, -1.0, 1.0)[:, None]
    radii = np.linalg.norm(away, axis=1)
    rough = max(1.0, _WITHIN_CELL * tolerance / (_CELL * size))
    cell, direction_cell = rough * _CELL * size, rough * _DIRECTION_CELL
    keys = np.column_stack([(b + away) / cell, radii / cell, normals / direction_cell])
    seen: set[tuple[int, ...]] = set()
    # two grids, half a cell apart: what lies at a border of the one does not in the other
    for shift in (0.0, 0.5):
        for members in _alike(np.floor(keys + 0.5 + shift).astype(np.int64)):
            chosen = np.unique(triples[members])
            if tuple(chosen.tolist()) in seen:
                continue
            seen.add(tuple(chosen.tolist()))
            circle = _circle(chosen, vertices, tolerance)
            if circle is not None:
                yield circle


def _circle(chosen: Indices, vertices: Vertices, tolerance: float) -> _Circle | None:
    """The circle that vertices lie on, if they do."""
    if len(chosen) < FEWEST_ON_RING:
        return None
    points = vertices[chosen]
    normal = _normal([points])
    center = _center([points], normal)
    away = points - center
    along = away @ normal
    reach = np.linalg.norm(away - np.outer(along, normal), axis=1)
    if max(np.ptp(along), np.ptp(reach)) > 2 * tolerance:
        return None
    return _Circle(chosen, center + along.mean() * normal, normal, float(reach.mean()))


def _alike(keys: Int[np.ndarray, "n 7"]) -> Iterator[Indices]:
    """Rows that are equal, where there are enough."""
    # an odd multiplier for each column: equal rows are equal sums, others hardly ever, and these are on no circle
    sums = keys @ np.array([1, 73856093, 19349663, 83492791, 179424673, 512927377, 1299709], dtype=np.int64)
    order = np.argsort(sums, kind="stable")
    starts = np.flatnonzero(np.diff(sums[order], prepend=sums[order][0] - 1))
    ends = np.append(starts[1:], len(order))
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        if end - start >= _FEWEST_TRIPLES:
            yield order[start:end]


def _triples(count: int, edges: EdgeEnds) -> Int[np.ndarray, "n 3"]:
    """Each vertex between two of its neighbours, in all ways."""
    both = np.vstack([edges, edges[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    degree = np.bincount(both[:, 0], minlength=count)
    start = np.concatenate([[0], np.cumsum(degree)[:-1]])
    found = [np.zeros((0, 3), dtype=np.int64)]
    for many in np.unique(degree[(degree >= 2) & (degree <= _MOST_EDGES)]).tolist():
        middle = np.flatnonzero(degree == many)
        around = both[start[middle][:, None] + np.arange(many), 1]
        first, second = np.triu_indices(many, 1)
        between = np.repeat(middle, len(first))
        found.append(np.column_stack([around[:, first].ravel(), between, around[:, second].ravel()]))
    return np.vstack(found)
