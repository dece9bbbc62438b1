"""The facet of a convex hull that is nearest to the origin: how far closed rows are from opening.

For rows whose hull has the origin inside, s = min over |u| = 1 of max_i d_i . u is the smallest distance of a facet,
and that facet's normal attains it. The facets are the extreme rays (u, t) of {(u, t) : d_i . u <= t}, at distance
t / |u|.

Of many rows most have no part in that facet. The hull of some of them lies inside: its nearest facet is no further
away, and is the one that is looked for once no row is beyond it. Until then the rows beyond its nearest facets join it
(the expanding polytope of G. van den Bergen, "Proximity queries and penetration depth computation on 3D game objects",
2001; for grasps Y. Zheng, "An efficient algorithm for a grasp quality measure", 2013).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Rows, Vector
from fixture_design.cones.kernel import double_description
from fixture_design.tolerances import DEFAULT

#: Up to so many rows double description is faster than loading Qhull.
_FEW_ROWS = 16
#: The hull of more rows than this is not taken: the number of facets grows with their cube in space.
MAX_ROWS = 160
#: Rounding of a facet's distance, for unit rows [-].
_ROUNDING = 1e-12
#: Where Qhull cannot tell facets apart, white rows are moved by so much in every coordinate [-].
_JOGGLE = 1e-10
#: A growing hull begins with at least so many rows a dimension, and gets those beyond so many of its facets at once.
_FIRST_ROWS, _GROWING_AT = 2, 12


@dataclass(frozen=True, eq=False)
class NearestFacet:
    """The nearest facet of a hull with the origin inside.

    Attributes:
        distance: of the facet.  motion: its unit normal, shape (d,).
        at_least: a distance that no facet undercuts, with rounding and joggling taken off.
    """

    distance: float
    motion: Vector
    at_least: float


def nearest_facet(rows: Rows) -> NearestFacet | None:
    """The facet of conv{d_i} nearest to the origin, for rows with the origin inside their hull.

    The hull is taken of whitened rows, D = U S V^T to U: little friction or short levers make hulls a million times
    flatter than wide, and facets stay facets under linear maps.

    Args:
        rows: shape (m, d), of comparable length.

    Returns:
        None if more than MAX_ROWS rows have a part in it, or the hull is flat to working precision.
    """
    if len(rows) <= rows.shape[1]:
        return None
    white, sizes, axes = np.linalg.svd(rows, full_matrices=False)
    if sizes[-1] <= _ROUNDING * sizes[0]:
        return None
    found = _by_double_description(white) if len(rows) <= _FEW_ROWS else _by_qhull(white, sizes)
    if found is None:
        return None
    facets, moved = found
    # a facet a . d' = b of the white rows d' = d V / S is the facet (V a / S) . d = b
    normals = (facets[:, :-1] / sizes) @ axes
    distances = facets[:, -1] / np.linalg.norm(normals, axis=1)
    nearest = int(np.argmin(distances))
    motion = normals[nearest] / np.linalg.norm(normals[nearest])
    # rows moved by m lower every facet of the white hull by at most m, hence every distance by at most m / inradius
    inradius = float(np.min(facets[:, -1] / np.linalg.norm(facets[:, :-1], axis=1)))
    kept = 1 - moved / inradius if inradius > 0 else 0.0
    return NearestFacet(float(np.max(rows @ motion)), motion, kept * float(distances[nearest]) - _ROUNDING)


def _by_double_description(rows: Rows) -> tuple[np.ndarray, float] | None:
    """Facets a . d <= b as rows [a, b], and by how much rows were moved for them."""
    lifted = np.column_stack([rows, -np.ones(len(rows))])
    lifted /= np.linalg.norm(lifted, axis=1, keepdims=True)
    facets = double_description(lifted, np.zeros((0, lifted.shape[1])), DEFAULT.tie)
    return None if len(facets.lines) or not len(facets.rays) else (facets.rays, 0.0)


def _by_qhull(rows: Rows, sizes: Vector) -> tuple[np.ndarray, float] | None:
    """The same by Qhull, of the rows that the nearest facet takes; of joggled ones where it cannot tell facets apart.

    Args:
        sizes: what the coordinates of rows were divided by.
    """
    from scipy.spatial import QhullError

    joggle = np.random.default_rng(0).uniform(-_JOGGLE, _JOGGLE, size=rows.shape)
    everything, apart = np.arange(len(rows)), _JOGGLE * np.sqrt(rows.shape[1])
    for offset, moved, first in ((0.0, 0.0, _outermost(rows)), (0.0, 0.0, everything), (joggle, apart, everything)):
        try:
            facets = _grown(rows + offset, sizes, first)
        except QhullError:
            continue
        return None if facets is None else (facets, float(moved))
    return None


def _grown(rows: Rows, sizes: Vector, taken: Indices) -> np.ndarray | None:
    """Facets of a hull of some rows, beginning with those ``taken``, the nearest one of which has no row beyond it.

    Returns:
        None where that takes more than MAX_ROWS rows.
    """
    from scipy.spatial import ConvexHull

    while len(taken) <= MAX_ROWS:
        equations = ConvexHull(rows[taken]).equations
        normals, offsets = equations[:, :-1], -equations[:, -1]
        nearest = np.argsort(offsets / np.linalg.norm(normals / sizes, axis=1))[:_GROWING_AT]
        reach = rows @ normals[nearest].T
        beyond = reach.max(axis=0) > offsets[nearest] + _ROUNDING
        grown = np.union1d(taken, reach.argmax(axis=0)[beyond])
        if not beyond[0] or len(grown) == len(taken):
            return np.column_stack([normals, offsets])
        taken = grown
    return None


def _outermost(rows: Rows) -> Indices:
    """Rows that are extreme in a coordinate, and the longest: where a hull begins to grow."""
    extreme = np.concatenate([rows.argmax(axis=0), rows.argmin(axis=0)])
    longest = np.argsort(-np.linalg.norm(rows, axis=1), kind="stable")[: _FIRST_ROWS * rows.shape[1]]
    return np.union1d(extreme, longest)
