"""Broad phase: which of many boxes meet, so that of thousands of features a handful is measured."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices

if TYPE_CHECKING:
    from shapely import STRtree

#: Lowest and highest corners of boxes, one a row [m].
Boxes = tuple[Float[np.ndarray, "_ 3"], Float[np.ndarray, "_ 3"]]


def boxes_of(points: Float[np.ndarray, "_ _ 3"]) -> Boxes:
    """The boxes of n sets of k points: 1 for vertices, 2 for edges, 3 for triangles."""
    return points.min(axis=1), points.max(axis=1)


class BoxTree:
    """Boxes that are asked again and again which of them meet others.

    A tree of their outlines in the two axes along which they extend furthest, built when first asked, then the third
    axis.
    """

    def __init__(self, boxes: Boxes) -> None:
        self.boxes = boxes

    @cached_property
    def _axes(self) -> tuple[int, int, int]:
        low, high = self.boxes
        u, v, w = np.argsort(-(high.max(axis=0) - low.min(axis=0))).tolist()
        return u, v, w

    @cached_property
    def _outlines(self) -> STRtree:
        import shapely

        (low, high), (u, v, _) = self.boxes, self._axes
        return shapely.STRtree(shapely.box(low[:, u], low[:, v], high[:, u], high[:, v]))

    def meeting(self, boxes: Boxes, within: float = 0.0) -> tuple[Indices, Indices]:
        """All pairs of one of some boxes and one of the tree's that are no further apart than ``within`` [m] along any
        axis, in no particular order.
        """
        import shapely

        low, high = boxes[0] - within, boxes[1] + within
        u, v, w = self._axes
        one, other = self._outlines.query(shapely.box(low[:, u], low[:, v], high[:, u], high[:, v]))
        own_low, own_high = self.boxes
        meeting = (low[one, w] <= own_high[other, w]) & (high[one, w] >= own_low[other, w])
        return one[meeting], other[meeting]


def box_pairs(first: Boxes, second: Boxes, within: float) -> tuple[Indices, Indices]:
    """All pairs of boxes, one of each set, that are no further apart than ``within`` [m] along any axis."""
    nothing = np.zeros(0, dtype=np.int64)
    if not len(first[0]) or not len(second[0]):
        return nothing, nothing
    kept, kept_second = _near(first, second, within), _near(second, first, within)
    if not len(kept) or not len(kept_second):
        return nothing, nothing
    tree = BoxTree((second[0][kept_second], second[1][kept_second]))
    one, other = tree.meeting((first[0][kept], first[1][kept]), within)
    return kept[one], kept_second[other]


def _near(boxes: Boxes, others: Boxes, within: float) -> Indices:
    """Those that meet the box around all the others."""
    low, high = others[0].min(axis=0) - within, others[1].max(axis=0) + within
    return np.flatnonzero((boxes[0] <= high).all(axis=1) & (boxes[1] >= low).all(axis=1))
