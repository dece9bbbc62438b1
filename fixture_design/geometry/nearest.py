"""Which triangles of a part a point of its surface lies on, and how far the others are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fixture_design.arrays import Indices, Point, cross_products
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Directions, PerTriangle, Vector3

#: The corner after each corner of a triangle.
_AFTER = np.array([1, 2, 0])
#: How much further is looked for the nearest triangle where none is found.
_FURTHER = 4.0


def touched_triangles(geometry: PartGeometry, p_PC: Point, within: float) -> Indices:
    """The triangles within a distance [m] of a surface point: one on a facet, two on an edge, more at an apex."""
    return touched_at_each(geometry, p_PC[None], within)[0]


def touched_at_each(geometry: PartGeometry, points: Directions, within: float) -> list[Indices]:
    """`touched_triangles` of many points, shape (n, 3): together they take little longer than one."""
    which, triangle = geometry.triangle_tree.meeting((points, points), within)
    near = distances(geometry.vertices[geometry.triangles[triangle]], points[which]) <= within
    which, triangle = which[near], triangle[near]
    order = np.lexsort((triangle, which))
    ends = np.searchsorted(which[order], np.arange(len(points) + 1)).tolist()
    triangle = triangle[order]
    return [triangle[start:end] for start, end in pairwise(ends)]


def triangles_in_box(geometry: PartGeometry, lowest: Vector3, highest: Vector3) -> Indices:
    """The triangles whose boxes meet a box [m]: of thousands of triangles a handful is left to be measured."""
    return np.sort(geometry.triangle_tree.meeting((lowest[None], highest[None]))[1])


def clearance(geometry: PartGeometry, p_PC: Point, touched: Indices) -> float:
    """Distance from a surface point to the nearest triangle it does not touch [m]: within it the part is a cone."""
    if len(touched) == len(geometry.triangles):
        return geometry.half_diagonal
    corners = geometry.vertices[geometry.triangles[touched]]
    # the next triangles are mostly no further than those that touch are large
    reach = float(np.linalg.norm(corners[:, _AFTER] - corners, axis=2).min(initial=geometry.half_diagonal))
    while True:
        near = np.setdiff1d(triangles_in_box(geometry, p_PC - reach, p_PC + reach), touched)
        if len(near):
            least = float(distances(geometry.vertices[geometry.triangles[near]], p_PC).min())
            if least <= reach:
                return least
        # what the box leaves out is further than the reach
        reach *= _FURTHER


def distances(corners: Corners, points: Vector3 | Directions) -> PerTriangle:
    """Distance from a point to each triangle, or from each of many points to its own.

    Args:
        corners: shape (t, 3, 3), none of zero area.  points: shape (3,) or (t, 3).

    Returns:
        shape (t,): to the plane where the point is above the triangle, else to its nearest side.
    """
    sides = corners[:, _AFTER] - corners
    away = points[..., None, :] - corners
    along = np.einsum("tkj,tkj->tk", away, sides) / np.maximum(np.einsum("tkj,tkj->tk", sides, sides), 1e-300)
    to_sides = np.linalg.norm(away - np.clip(along, 0.0, 1.0)[:, :, None] * sides, axis=2).min(axis=1)
    normals = cross_products(sides[:, 0], sides[:, 1])
    above = (np.einsum("tkj,tkj->tk", cross_products(normals[:, None, :], sides), away) >= 0).all(axis=1)
    heights = np.abs(np.einsum("tj,tj->t", normals, away[:, 0])) / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    return np.where(above, np.minimum(heights, to_sides), to_sides)
