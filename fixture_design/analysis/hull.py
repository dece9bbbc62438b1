"""The facet of a convex hull that is nearest to the origin: how far closed rows are from opening.

For rows whose hull has the origin inside, s = min over |u| = 1 of max_i d_i . u is the smallest distance of a facet,
and that facet's normal attains it. The facets are the extreme rays (u, t) of {(u, t) : d_i . u <= t}, at distance
t / |u|.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones.kernel import double_description
from fixture_design.tolerances import DEFAULT

#: Up to so many rows double description is faster than loading Qhull.
_FEW_ROWS = 16
#: More rows than this are not looked at: the number of facets grows with their cube in space.
MAX_ROWS = 160
#: Rounding of a facet's distance, for unit rows [-].
ROUNDING = 1e-12
#: Part of a facet's distance that is safe to rely on: joggled rows move it by less than a hundredth.
SAFE = 0.99


def nearest_facet(rows: Rows) -> tuple[float, Vector] | None:
    """Distance of the nearest facet of conv{d_i} and its unit normal, for rows with the origin inside their hull.

    The hull is taken of whitened rows, D = U S V^T to U: little friction or short levers make hulls a million times
    flatter than wide, and facets keep under linear maps.

    Args:
        rows: shape (m, d), of comparable length.

    Returns:
        None if there are more than MAX_ROWS rows, or the hull is flat to working precision.
    """
    if not rows.shape[1] < len(rows) <= MAX_ROWS:
        return None
    white, sizes, axes = np.linalg.svd(rows, full_matrices=False)
    if sizes[-1] <= ROUNDING * sizes[0]:
        return None
    facets = _by_double_description(white) if len(rows) <= _FEW_ROWS else _by_qhull(white)
    if facets is None:
        return None
    # a facet a . d' = b of the white rows d' = d V / S is the facet (V a / S) . d = b
    normals = (facets[:, :-1] / sizes) @ axes
    distances = facets[:, -1] / np.linalg.norm(normals, axis=1)
    nearest = int(np.argmin(distances))
    motion = normals[nearest] / np.linalg.norm(normals[nearest])
    return float(np.max(rows @ motion)), motion


def _by_double_description(rows: Rows) -> np.ndarray | None:
    """Facets a . d <= b as rows [a, b]."""
    lifted = np.column_stack([rows, -np.ones(len(rows))])
    lifted /= np.linalg.norm(lifted, axis=1, keepdims=True)
    facets = double_description(lifted, np.zeros((0, lifted.shape[1])), DEFAULT.tie)
    return None if len(facets.lines) or not len(facets.rays) else facets.rays


def _by_qhull(rows: Rows) -> np.ndarray | None:
    """The same by Qhull; where its facets cannot be told apart, of rows that it joggles by about 1e-10 (option QJ)."""
    from scipy.spatial import ConvexHull, QhullError

    for options in (None, "QJ"):
        try:
            equations = ConvexHull(rows, qhull_options=options).equations
        except QhullError:
            continue
        return np.column_stack([equations[:, :-1], -equations[:, -1]])
    return None
