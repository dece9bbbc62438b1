"""Broad phase: which of many boxes meet, so that of thousands of features a handful is measured."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices

#: Lowest and highest corners of boxes, one a row [m].
Boxes = tuple[Float[np.ndarray, "_ 3"], Float[np.ndarray, "_ 3"]]


def boxes_of(points: Float[np.ndarray, "_ _ 3"]) -> Boxes:
    """The boxes of n sets of k points: 1 for vertices, 2 for edges, 3 for triangles."""
    return points.min(axis=1), points.max(axis=1)


def box_pairs(first: Boxes, second: Boxes, within: float) -> tuple[Indices, Indices]:
    """All pairs of boxes, one of each set, that are no further apart than ``within`` [m] along any axis.

    A tree of the boxes' outlines in the two axes along which both sets together extend furthest, then the third axis.
    """
    nothing = np.zeros(0, dtype=np.int64)
    if not len(first[0]) or not len(second[0]):
        return nothing, nothing
    kept, kept_second = _near(first, second, within), _near(second, first, within)
    if not len(kept) or not len(kept_second):
        return nothing, nothing
    low, high = first[0][kept] - within, first[1][kept] + within
    low_second, high_second = second[0][kept_second], second[1][kept_second]
    u, v, w = np.argsort(-(np.vstack([high, high_second]).max(axis=0) - np.vstack([low, low_second]).min(axis=0)))

    import shapely

    tree = shapely.STRtree(shapely.box(low_second[:, u], low_second[:, v], high_second[:, u], high_second[:, v]))
    one, other = tree.query(shapely.box(low[:, u], low[:, v], high[:, u], high[:, v]))
    meeting = (low[one, w] <= high_second[other, w]) & (high[one, w] >= low_second[other, w])
    return kept[one[meeting]], kept_second[other[meeting]]


def _near(boxes: Boxes, others: Boxes, within: float) -> Indices:
    """Those that meet the box around all the others."""
    low, high = others[0].min(axis=0) - within, others[1].max(axis=0) + within
    return np.flatnonzero((boxes[0] <= high).all(axis=1) & (boxes[1] >= low).all(axis=1))
