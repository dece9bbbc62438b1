"""Bands of triangles between two rings of vertices about one axis, or between a ring and a pole on it.

A triangle of a band has two corners on one ring and the third on the other. It need not face as the surface does: what
the band stands for is the cone through its two rings.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.geometry.shapes import (
    OfTriangle,
    PerPoint,
    PerTriangle,
    PerVertex,
    TriangleMask,
    Triangles,
    Vertices,
)
from fixture_design.geometry.turned_axes import FEWEST_ON_RING, Axis
from fixture_design.tolerances import RING_ANGLE, SMOOTH_ANGLE, STRIP_WIDTH_RATIO

#: Vertices of a ring around a pole, at least.
_FEWEST_AROUND_POLE = 8
#: Chords differ if they do by this part of the longest; a square with chamfers has two lengths of them [-].
_DIFFERENT, _DISTINCT = 2e-2, 2

BandKind = Literal["smooth", "coarse", "uneven"]


@dataclass(frozen=True, eq=False)
class Rings:
    """The rings and poles about an axis.

    Attributes:
        axis: the line.
        reach, height: of each ring or pole: its radius, and where it is along the axis [m].
        of_vertex: which of them each vertex is on, -1 for none.
        azimuth: of each vertex [rad].
    """

    axis: Axis
    reach: PerPoint
    height: PerPoint
    of_vertex: Indices
    azimuth: PerVertex

    @classmethod
    def about(cls, axis: Axis, vertices: Vertices, used: Indices, tolerance: float) -> Rings:
        """Rings of at least ``FEWEST_ON_RING`` vertices, and poles, among those used."""
        reach, height = axis.places(vertices[used])
        labels = _clusters(reach, height, tolerance)
        counts = np.bincount(labels)
        pole = np.zeros(len(counts), dtype=bool)
        pole[labels[reach <= tolerance]] = True
        kept = (counts >= FEWEST_ON_RING) | pole
        renumbered = np.where(kept, np.cumsum(kept) - 1, -1)
        of_vertex = np.full(len(vertices), -1, dtype=np.int64)
        of_vertex[used] = renumbered[labels]
        means = [np.bincount(labels, weights=values)[kept] / counts[kept] for values in (reach, height)]
        azimuth = np.zeros(len(vertices))
        azimuth[used] = axis.azimuths(vertices[used])
        return cls(axis, np.where(pole[kept], 0.0, means[0]), means[1], of_vertex, azimuth)


@dataclass(frozen=True, eq=False)
class Band:
    """Triangles between two rings.

    Attributes:
        ends: the numbers of the two rings, seen with the material on the left: the outward normal is to the right.
        triangles: numbers of the triangles.
        kind: "smooth": its chords turn by so little that it is round for sure. "coarse": it may be a prism or a pyramid
            as well. "uneven": coarse, on rings that are smooth elsewhere, or with chords of several lengths: no prism
            that somebody designs has its corners on a circle then.
    """

    ends: tuple[int, int]
    triangles: Indices
    kind: BandKind


def bands_of(rings: Rings, triangles: Triangles, near: Indices, normals: Float[np.ndarray, "t 3"]) -> list[Band]:
    """The bands between the rings about an axis.

    Args:
        near: numbers of the triangles that may be of one.  normals: of the triangles, of any length.
    """
    nodes = rings.of_vertex[triangles[near]]
    on = (nodes >= 0).all(axis=1)
    inside, nodes = near[on], nodes[on]
    if not len(inside):
        return []
    # the corner that is alone on its ring, and the chord of the other two, in the triangle's own sense
    apex = np.full(len(inside), -1)
    for corner in range(3):
        one, other = (corner + 1) % 3, (corner + 2) % 3
        apex[(nodes[:, one] == nodes[:, other]) & (nodes[:, corner] != nodes[:, one])] = corner
    inside, nodes, apex = inside[apex >= 0], nodes[apex >= 0], apex[apex >= 0]
    row = np.arange(len(inside))
    corners = triangles[inside]
    start, end, tip = corners[row, (apex + 1) % 3], corners[row, (apex + 2) % 3], corners[row, apex]
    base, top = nodes[row, (apex + 1) % 3], nodes[row, apex]
    turn = np.abs((rings.azimuth[end] - rings.azimuth[start] + np.pi) % (2 * np.pi) - np.pi)
    low, high = np.minimum(base, top), np.maximum(base, top)
    rise, out = rings.height[high] - rings.height[low], rings.reach[high] - rings.reach[low]
    lengths = np.hypot(rise, out)
    # the normal turns with the chord as far as it points away from the axis
    step = 2 * np.arcsin(np.clip(np.sin(turn / 2) * np.abs(rise) / lengths, 0, 1))
    count = len(rings.reach)
    pair = low * count + high
    narrow = _narrow(start, end, pair * count + base, turn)
    pole = rings.reach == 0
    possible = (turn <= 2 * RING_ANGLE) & (lengths > 0) & narrow
    fine, found = np.zeros(len(inside), dtype=bool), []
    for members in _strips(np.flatnonzero(possible & (step <= SMOOTH_ANGLE)), start, end, tip, len(rings.of_vertex)):
        if _enough(members, start, end, tip, base, top, pole, _FEWEST_AROUND_POLE):
            fine[members] = True
            found.append((int(pair[members[0]]), "smooth", inside[members]))
    for members in _strips(
        np.flatnonzero(fine | possible & (step <= RING_ANGLE)), start, end, tip, len(rings.of_vertex)
    ):
        coarse = members[~fine[members]]
        beside = len(coarse) < len(members)
        if len(coarse) and (beside or _enough(members, start, end, tip, base, top, pole, FEWEST_ON_RING)):
            uneven = beside or _distinct(turn[members]) > _DISTINCT
            found.append((int(pair[coarse[0]]), "uneven" if uneven else "coarse", inside[coarse]))
    return [
        _band(rings, divmod(key, count), kind, members, normals, triangles) for key, kind, members in _joined(found)
    ]


def _band(
    rings: Rings,
    ends: tuple[int, int],
    kind: BandKind,
    members: Indices,
    normals: Float[np.ndarray, "t 3"],
    triangles: Triangles,
) -> Band:
    low, high = ends
    # outward normals summed, in the half plane
    along = float((normals[members] @ rings.axis.direction).sum())
    middle = rings.azimuth[triangles[members]]
    azimuth = np.arctan2(np.sin(middle).sum(axis=1), np.cos(middle).sum(axis=1))
    outward = rings.axis.outward(azimuth)
    across = float(np.einsum("ij,ij->", normals[members], outward))
    rise, out = rings.height[high] - rings.height[low], rings.reach[high] - rings.reach[low]
    return Band((low, high) if across * rise - along * out > 0 else (high, low), np.sort(members), kind)


def _joined(found: Iterable[tuple[int, BandKind, Indices]]) -> list[tuple[int, BandKind, Indices]]:
    """Strips between the same rings as one."""
    joined: dict[tuple[int, BandKind], list[Indices]] = defaultdict(list)
    for key, kind, members in found:
        joined[key, kind].append(members)
    return [(key, kind, np.concatenate(members)) for (key, kind), members in joined.items()]


def _narrow(start: Indices, end: Indices, ring: Indices, turn: PerTriangle) -> TriangleMask:
    """Whether chords are not much longer than one of the two beside them: else they are flats."""
    after = dict(zip(zip(ring.tolist(), start.tolist(), strict=True), turn.tolist(), strict=True))
    before = dict(zip(zip(ring.tolist(), end.tolist(), strict=True), turn.tolist(), strict=True))
    beside = [
        max(before.get((r, s), 0.0), after.get((r, e), 0.0))
        for r, s, e in zip(ring.tolist(), start.tolist(), end.tolist(), strict=True)
    ]
    return turn <= STRIP_WIDTH_RATIO * np.array(beside)


def _distinct(turn: PerTriangle) -> int:
    """How many different chords there are."""
    return 1 + int((np.diff(np.sort(turn)) > _DIFFERENT * turn.max()).sum())


def _strips(chosen: Indices, start: Indices, end: Indices, tip: Indices, count: int) -> list[Indices]:
    """Triangles that hang together over edges between their two rings."""
    if not len(chosen):
        return []
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    keys = np.concatenate([_edge(start[chosen], tip[chosen], count), _edge(end[chosen], tip[chosen], count)])
    _, edge = np.unique(keys, return_inverse=True)
    triangle = np.tile(np.arange(len(chosen)), 2)
    total = len(chosen) + int(edge.max()) + 1
    graph = coo_matrix((np.ones(len(edge)), (triangle, len(chosen) + edge.ravel())), shape=(total, total))
    label = connected_components(graph, directed=False)[1][: len(chosen)]
    order = np.argsort(label, kind="stable")
    return [chosen[part] for part in np.split(order, np.flatnonzero(np.diff(label[order])) + 1)]


def _edge(one: Indices, other: Indices, count: int) -> Indices:
    return np.minimum(one, other) * count + np.maximum(one, other)


def _enough(
    members: Indices,
    start: Indices,
    end: Indices,
    tip: Indices,
    base: Indices,
    top: Indices,
    pole: np.ndarray,
    around_pole: int,
) -> bool:
    """Whether a strip has so many vertices on its rings that it is no accident that they are on rings."""
    on = np.concatenate([start[members], end[members], tip[members]])
    ring = np.concatenate([base[members], base[members], top[members]])
    fewest = around_pole if pole[ring].any() else FEWEST_ON_RING
    for number in np.unique(ring).tolist():
        if not pole[number] and len(np.unique(on[ring == number])) < fewest:
            return False
    return True


def _clusters(reach: PerPoint, height: PerPoint, tolerance: float) -> OfTriangle:
    """Numbers of the groups of places that are equal within twice a tolerance."""
    by_height = np.argsort(height, kind="stable")
    level = np.empty(len(height), dtype=np.int64)
    level[by_height] = np.cumsum(np.diff(height[by_height], prepend=height[by_height][0]) > 2 * tolerance)
    order = np.lexsort((reach, level))
    new = (np.diff(level[order], prepend=-1) != 0) | (np.diff(reach[order], prepend=-np.inf) > 2 * tolerance)
    label = np.empty(len(height), dtype=np.int64)
    label[order] = np.cumsum(new) - 1
    return label
