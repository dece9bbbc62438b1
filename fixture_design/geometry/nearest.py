"""Which triangles of a part a point of its surface lies on, and how far the others are."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Point, cross_products
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, PerTriangle, Vector3

#: The corner after each corner of a triangle.
_AFTER = np.array([1, 2, 0])


def touched_triangles(geometry: PartGeometry, p_PC: Point, within: float) -> Indices:
    """The triangles within a distance [m] of a surface point: one on a facet, two on an edge, more at an apex."""
    candidates = triangles_in_box(geometry, p_PC - within, p_PC + within)
    return candidates[distances(geometry.vertices[geometry.triangles[candidates]], p_PC) <= within]


def triangles_in_box(geometry: PartGeometry, lowest: Vector3, highest: Vector3) -> Indices:
    """The triangles whose boxes meet a box [m]: of thousands of triangles a handful is left to be measured."""
    low, high = geometry.triangle_boxes
    candidates = np.flatnonzero((low[0] <= highest[0]) & (high[0] >= lowest[0]))
    for axis in (1, 2):
        near = (low[axis, candidates] <= highest[axis]) & (high[axis, candidates] >= lowest[axis])
        candidates = candidates[near]
    return candidates


def clearance(geometry: PartGeometry, p_PC: Point, touched: Indices) -> float:
    """Distance from a surface point to the nearest triangle it does not touch [m]: within it the part is a cone."""
    others = np.delete(np.arange(len(geometry.triangles)), touched)
    if not len(others):
        return geometry.half_diagonal
    return float(distances(geometry.vertices[geometry.triangles[others]], p_PC).min())


def distances(corners: Corners, point: Vector3) -> PerTriangle:
    """Distance from a point to each triangle.

    Args:
        corners: shape (t, 3, 3), none of zero area.  point: shape (3,).

    Returns:
        shape (t,): to the plane where the point is above the triangle, else to its nearest side.
    """
    sides = corners[:, _AFTER] - corners
    away = point - corners
    along = np.einsum("tkj,tkj->tk", away, sides) / np.maximum(np.einsum("tkj,tkj->tk", sides, sides), 1e-300)
    to_sides = np.linalg.norm(away - np.clip(along, 0.0, 1.0)[:, :, None] * sides, axis=2).min(axis=1)
    normals = cross_products(sides[:, 0], sides[:, 1])
    above = (np.einsum("tkj,tkj->tk", cross_products(normals[:, None, :], sides), away) >= 0).all(axis=1)
    heights = np.abs(np.einsum("tj,tj->t", normals, away[:, 0])) / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    return np.where(above, np.minimum(heights, to_sides), to_sides)
