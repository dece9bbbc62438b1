"""The edges of a part that one can feel, and how far points are from them.

Edges inside a facet are of the triangles only; edges between strips of one curved surface are of its tessellation only.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Points, Weights
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.segments import Segments
from fixture_design.tolerances import SMOOTH_ANGLE

#: Samples of one edge at most: more would only cost memory where edges are a thousand times longer than the margin.
_MOST_SAMPLES = 1000


def sharp_edges(geometry: PartGeometry) -> Segments:
    """The ends of every sharp edge, shape (e, 2, 3) [m]: between facets that do not join smoothly, and where more than
    two triangles meet.
    """
    triangle, corner = np.nonzero(geometry.triangle_neighbours < geometry.triangle_neighbours.shape[0])
    across = geometry.triangle_neighbours[triangle, corner]
    once = (across < 0) | (across > triangle)
    triangle, corner, across = triangle[once], corner[once], across[once]
    mine, other = geometry.facet_of_triangle[triangle], geometry.facet_of_triangle[across]
    pairs = set(zip(mine.tolist(), other.tolist(), strict=True))
    smooth = {pair for pair in pairs if joins_smoothly(geometry, *pair)}
    sharp = across < 0
    sharp |= np.array([pair not in smooth for pair in zip(mine.tolist(), other.tolist(), strict=True)], dtype=bool)
    ends = np.column_stack([geometry.triangles[triangle, corner], geometry.triangles[triangle, (corner + 1) % 3]])
    return geometry.vertices[ends[sharp]]


def joins_smoothly(geometry: PartGeometry, first: int, second: int) -> bool:
    """Whether two facets are one, or neighbours of which at least one is a strip of a curved surface."""
    if first == second:
        return True
    angle = geometry.facets[first].angles.get(second, np.pi)
    kinds = {geometry.facets[facet].provenance.kind for facet in (first, second)}
    return abs(angle) < SMOOTH_ANGLE and "approximate" in kinds


def near_segments(points: Points, ends: Segments, within: float) -> Weights:
    """Distance of points, shape (n, 3), to the nearest segment, shape (n,) [m]; infinite beyond ``within`` [m].

    Samples along the segments say which ones may be near; to those it is exact.
    """
    from scipy.spatial import KDTree

    least = np.full(len(points), np.inf)
    if not len(ends) or not len(points) or within <= 0:
        return least
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    counts = np.clip(np.ceil(lengths / within), 1, _MOST_SAMPLES).astype(np.int64)
    owner = np.repeat(np.arange(len(ends)), counts)
    place = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[owner]
    samples = ends[owner, 0] + place[:, None] * (ends[owner, 1] - ends[owner, 0])
    reach = within + float((lengths / counts).max()) / 2
    found = KDTree(samples).query_ball_point(points, reach)
    number = np.repeat(np.arange(len(points)), [len(some) for some in found])
    segment = owner[np.array([i for some in found for i in some], dtype=np.int64)]
    start, along = ends[segment, 0], ends[segment, 1] - ends[segment, 0]
    away = points[number] - start
    at = np.clip(np.einsum("ij,ij->i", away, along) / np.einsum("ij,ij->i", along, along), 0.0, 1.0)
    np.minimum.at(least, number, np.linalg.norm(away - at[:, None] * along, axis=1))
    return np.where(least <= within, least, np.inf)
