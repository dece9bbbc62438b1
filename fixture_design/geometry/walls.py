"""Walls inside a part of several solids: where its surface has material on both sides."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Point
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.winding import winding_numbers

#: Other shells nearer than this may have a say at a point, in widths of an edge [-].
_NEAR = 20.0


def is_wall(geometry: PartGeometry, p_PF: Point, touched: Indices) -> bool | None:
    """Whether a point of the surface is inside the material; None where more than one shell meets, or nearly does.

    Where one shell is alone, whatever the others do is the same all around the point, and on one side of it.

    Args:
        touched: the triangles at the point.
    """
    shells = np.unique(geometry.shell_of_triangle[touched])
    if len(shells) != 1 or (geometry.triangle_neighbours[touched] < 0).any():
        return None
    own = int(shells[0])
    low, high = geometry.shell_boxes
    reach = _NEAR * geometry.on_edge
    around = np.flatnonzero(np.all((low <= p_PF + reach) & (high >= p_PF - reach), axis=1))
    around = around[around != own]
    within = 0.0
    if len(around):
        near = touched_triangles(geometry, p_PF, reach)
        if (geometry.shell_of_triangle[near] != own).any():
            return None
        others = geometry.triangles[np.isin(geometry.shell_of_triangle, around)]
        within = float(winding_numbers(geometry.vertices, others, p_PF[None])[0])
    # the shell of a cavity runs around nothing, which it takes away from what is around it
    return bool(within - (geometry.shell_volumes[own] < 0) > 0.5)
