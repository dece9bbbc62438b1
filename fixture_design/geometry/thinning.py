"""Points thinned to a spacing: of any two that are too close, the first one stays (Poisson disks by dart throwing)."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Mask, Points

#: Points whose normals have a cosine below this lie on opposite sides of a wall, and do not disturb each other [-].
_OPPOSITE = -0.5

#: Most points, a spacing or more apart and not opposite, that can be within a spacing of one point, doubled for a wall.
_MOST_NEIGHBOURS = 24


def thinned(points: Points, normals: Points, spacing: float) -> Indices:
    """Which points stay, in order: each is ``spacing`` [m] or more from those before it that are not opposite to it."""
    from scipy.spatial import KDTree

    if not len(points):
        return np.empty(0, dtype=np.int64)
    near = KDTree(points).query_ball_point(points, np.nextafter(spacing, 0.0))
    gone = np.zeros(len(points), dtype=bool)
    kept = []
    for number, others in enumerate(near):
        if not gone[number]:
            kept.append(number)
            gone[[o for o in others if normals[o] @ normals[number] > _OPPOSITE]] = True
    return np.array(kept, dtype=np.int64)


def apart(points: Points, normals: Points, taken: Points, taken_normals: Points, spacing: float) -> Mask:
    """Which points are ``spacing`` [m] or more from all taken ones that are not opposite to them."""
    from scipy.spatial import KDTree

    if not len(taken) or not len(points):
        return np.ones(len(points), dtype=bool)
    distances, number = KDTree(taken).query(points, k=_MOST_NEIGHBOURS, distance_upper_bound=spacing)
    facing = np.einsum("ij,ikj->ik", normals, taken_normals[np.minimum(number, len(taken) - 1)]) > _OPPOSITE
    return ~((distances < spacing) & facing).any(axis=1)
