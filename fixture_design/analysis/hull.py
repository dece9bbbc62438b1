"""The facet of a convex hull that is nearest to the origin: how far closed rows are from opening.

For rows whose hull has the origin inside, s = min over |u| = 1 of max_i d_i . u is the smallest distance of a facet,
and that facet's normal attains it. The facets are the extreme rays (u, t) of {(u, t) : d_i . u <= t}, at distance
t / |u|.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones.kernel import double_description
from fixture_design.tolerances import DEFAULT

#: Up to so many rows double description is faster than loading Qhull.
_FEW_ROWS = 16
#: More rows than this are not looked at: the number of facets grows with their cube in space.
MAX_ROWS = 160
#: Rounding of a facet's distance, for unit rows [-].
_ROUNDING = 1e-12
#: Where Qhull cannot tell facets apart, white rows are moved by so much in every coordinate [-].
_JOGGLE = 1e-10


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
        None if there are more than MAX_ROWS rows, or the hull is flat to working precision.
    """
    if not rows.shape[1] < len(rows) <= MAX_ROWS:
        return None
    white, sizes, axes = np.linalg.svd(rows, full_matrices=False)
    if sizes[-1] <= _ROUNDING * sizes[0]:
        return None
    found = _by_double_description(white) if len(rows) <= _FEW_ROWS else _by_qhull(white)
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


def _by_qhull(rows: Rows) -> tuple[np.ndarray, float] | None:
    """The same by Qhull; where it cannot tell facets apart, of joggled rows."""
    from scipy.spatial import ConvexHull, QhullError

    joggle = np.random.default_rng(0).uniform(-_JOGGLE, _JOGGLE, size=rows.shape)
    for offset, moved in ((0.0, 0.0), (joggle, _JOGGLE * np.sqrt(rows.shape[1]))):
        try:
            equations = ConvexHull(rows + offset).equations
        except QhullError:
            continue
        return np.column_stack([equations[:, :-1], -equations[:, -1]]), float(moved)
    return None
