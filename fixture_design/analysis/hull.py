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


def nearest_facet(rows: Rows) -> tuple[float, Vector] | None:
    """Distance of the nearest facet of conv{d_i} and its unit normal, for rows with the origin inside their hull.

    Args:
        rows: shape (m, d), of comparable length.

    Returns:
        None if there are more than MAX_ROWS rows, or the hull is flat to working precision.
    """
    if len(rows) > MAX_ROWS:
        return None
    return _by_double_description(rows) if len(rows) <= _FEW_ROWS else _by_qhull(rows)


def _by_double_description(rows: Rows) -> tuple[float, Vector] | None:
    lifted = np.column_stack([rows, -np.ones(len(rows))])
    lifted /= np.linalg.norm(lifted, axis=1, keepdims=True)
    facets = double_description(lifted, np.zeros((0, lifted.shape[1])), DEFAULT.tie)
    sizes = np.linalg.norm(facets.rays[:, :-1], axis=1)
    if len(facets.lines) or not len(sizes) or sizes.min() == 0:
        return None
    distances = facets.rays[:, -1] / sizes
    nearest = int(np.argmin(distances))
    motion = facets.rays[nearest, :-1] / sizes[nearest]
    return float(np.max(rows @ motion)), motion


def _by_qhull(rows: Rows) -> tuple[float, Vector] | None:
    from scipy.spatial import ConvexHull, QhullError  # noqa: PLC0415 - a third of a second that most answers can spare

    try:
        equations = ConvexHull(rows).equations
    except QhullError:
        return None  # flat to Qhull's own precision
    nearest = int(np.argmax(equations[:, -1]))
    return float(-equations[nearest, -1]), equations[nearest, :-1]
