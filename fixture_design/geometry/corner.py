"""The logic of any polyhedral corner: which normals exclude which, as an AND of ORs (thesis 2.2.1, and beyond it).

A point tip enters the part, to first order, if it moves into the interior of the tangent cone C at the contact point.
Let n_1..n_k be the outward normals of the facets that meet there, and for a direction x let S(x) = {i : n_i . x < 0}.
From a point x inside C, no point of {z : n_i . z < 0 for all i in S(x)} can be reached through a facet: one would cross
its plane from the inner to the outer side and not come back. Hence int C is the union of these cones over all x in it,
and the tip stays out exactly if it stays out of each of them:

    a motion is admissible  <=>  for every minimal S, some normal n_i, i in S, has n_i . v <= 0.

At a convex apex there is one S, of all facets: the OR. At a concave edge there are {1} and {2}: the AND. Saddle-like
corners give both. The cones overlap, as they must: a cut along one wall would let the tip slide along it into the part.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import combinations

import numpy as np

from fixture_design.arrays import cross_products, read_only
from fixture_design.geometry.shapes import DirectionMask, Directions, Normals, Vector3
from fixture_design.tolerances import COPLANAR_ANGLE

#: Facets that may meet in a corner: 2^k subsets are looked at.
MOST_FACETS = 10

#: Sine of an angle below which a direction lies in a plane, and two planes are one (facing the same way or not) [-].
_IN_PLANE = COPLANAR_ANGLE


def clauses_of_corner(normals: Normals, inside: Callable[[Directions], DirectionMask]) -> tuple[tuple[int, ...], ...]:
    """The minimal sets S, each sorted, in sorted order; indices into ``normals``.

    Args:
        normals: unit outward normals, shape (k, 3), k <= ``MOST_FACETS``; no two of them equal.
        inside: which of some directions, shape (n, 3), point into the material.

    Returns:
        one set a clause; an empty set if every direction points inside (the point is not on the surface at all), and
        no set if none does.
    """
    directions = cell_directions(normals)
    below = directions @ normals.T < 0
    solid = inside(directions)
    clauses: list[tuple[int, ...]] = []
    for size in range(len(normals) + 1):
        for chosen in combinations(range(len(normals)), size):
            if any(set(clause) <= set(chosen) for clause in clauses):
                continue
            reached = below[:, list(chosen)].all(axis=1)
            if reached.any() and solid[reached].all():
                clauses.append(chosen)
    return tuple(sorted(clauses))


def cell_directions(normals: Normals) -> Directions:
    """One unit direction in every cell that the planes n . x = 0 cut space into, well inside it; shape (cells, 3).

    Every cell has an edge along which two of the planes intersect: around each such line, the sectors between the
    planes through it are visited. Axes are added if all planes share a line, which then is none of an apex.
    """
    return _cells(normals.tobytes())


@lru_cache(maxsize=256)
def _cells(packed: bytes) -> Directions:
    """`cell_directions`: the same few corners come again and again."""
    normals = np.frombuffer(packed).reshape(-1, 3)
    spanning = np.vstack([normals, *_missing_axes(normals)])
    samples = []
    for first, second in combinations(range(len(spanning)), 2):
        line = cross_products(spanning[first], spanning[second])
        if np.linalg.norm(line) > _IN_PLANE:
            line /= np.linalg.norm(line)
            samples += [_around(line, spanning), _around(-line, spanning)]
    directions = np.vstack(samples)
    # the mean of what was found in one cell (cells are convex) lies further from its walls
    _, cell = np.unique(directions @ normals.T < 0, axis=0, return_inverse=True)
    sums = np.zeros((int(cell.max()) + 1, 3))
    np.add.at(sums, cell.ravel(), directions)
    return read_only(sums / np.linalg.norm(sums, axis=1, keepdims=True))


def _missing_axes(normals: Normals) -> list[Directions]:
    """Directions that complete the normals to a span of space."""
    _, values, axes = np.linalg.svd(normals)
    rank = int((values > _IN_PLANE).sum())
    return [axes[rank:]] if rank < 3 else []


def _around(line: Vector3, normals: Normals) -> Directions:
    """Directions close to a line, one in each sector between the planes that contain it."""
    heights = normals @ line
    containing = np.abs(heights) <= _IN_PLANE
    side = normals[containing][0]
    other = cross_products(line, side)
    traces = cross_products(normals[containing], line)
    angles = np.arctan2(traces @ other, traces @ side)
    angles = np.unique(np.mod([angles, angles + np.pi], 2 * np.pi))
    widths = np.diff([*angles, angles[0] + 2 * np.pi])
    # between facets of one plane that face opposite ways lies no sector, but their rounding
    middles = (angles + widths / 2)[widths > 2 * _IN_PLANE]
    reach = 0.5 * np.abs(heights[~containing]).min(initial=1.0)
    return line + reach * (np.outer(np.cos(middles), side) + np.outer(np.sin(middles), other))
