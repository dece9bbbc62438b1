"""Smallest widths of plane facets and the angles by which the rounding of their vertices may turn them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.contacts import tangents
from fixture_design.geometry.shapes import Directions, FacetVectors, OfFacet, PerFacet, PerVertex, Vector3, Vertices

#: Facets with up to this many vertices go through numpy together; a strip of a tessellated surface has four.
_FEW = 6


def widths_and_angles(
    vertices: Vertices, rounding: PerVertex, used: Indices, starts: OfFacet, normals: FacetVectors
) -> tuple[PerFacet, PerFacet]:
    """For each facet its smallest width [m] and the angle by which rounding may turn its normal [rad].

    The angle is 0 where all vertices share one coordinate exactly: rounding then shifts the plane and does not turn it.
    Otherwise one side may go up and the other down: 2 sqrt(3) rounding / width, at most a right angle.

    Args:
        vertices: shape (v, 3).  rounding: shape (v,), of each coordinate.  normals: shape (f, 3), any length.
        used: the vertex numbers of all facets, facet after facet.  starts: where each facet's begin, shape (f,).
    """
    points = vertices[used]
    flat = (np.minimum.reduceat(points, starts) == np.maximum.reduceat(points, starts)).any(axis=1)
    widths = _widths(points, starts, normals / np.linalg.norm(normals, axis=1, keepdims=True))
    turn = 2 * np.sqrt(3.0) * np.maximum.reduceat(rounding[used], starts)
    angles = np.minimum(turn / np.maximum(widths, turn / np.pi), np.pi / 2) if len(turn) else turn
    return widths, np.where(flat, 0.0, angles)


def _widths(points: Vertices, starts: OfFacet, units: FacetVectors) -> PerFacet:
    counts = np.diff([*starts.tolist(), len(points)])
    widths = np.empty(len(starts))
    for count in np.unique(counts[counts <= _FEW]):
        facets = np.flatnonzero(counts == count)
        widths[facets] = _smallest_extents(points[starts[facets, None] + np.arange(count)], units[facets])
    for facet in np.flatnonzero(counts > _FEW):
        mine = points[starts[facet] : starts[facet] + counts[facet]]
        widths[facet] = _smallest_extents(_hull(mine, units[facet])[None], units[None, facet], sides_only=True)[0]
    return widths


def _smallest_extents(polygons: Float[np.ndarray, "f n 3"], units: FacetVectors, sides_only: bool = False) -> PerFacet:
    """Smallest distance between two parallel lines that have a polygon between them, for many polygons at once.

    One of the two lines runs along a side of the convex hull; among all pairs of vertices are all its sides.

    Args:
        polygons: shape (m, n, 3).  units: normals, shape (m, 3).  sides_only: vertices are a convex hull in order.
    """
    count = polygons.shape[1]
    first, second = (np.arange(count), np.roll(np.arange(count), -1)) if sides_only else np.triu_indices(count, 1)
    sides = polygons[:, second] - polygons[:, first]
    across = np.cross(units[:, None, :], sides)
    lengths = np.linalg.norm(across, axis=2)
    extents = np.ptp(np.einsum("mpk,mnk->mpn", across, polygons - polygons[:, :1]), axis=2)
    # a side along the normal has no line in the plane: its pair says nothing
    return np.where(lengths > 0, extents / np.where(lengths > 0, lengths, 1.0), np.inf).min(axis=1)


def _hull(points: Vertices, unit: Vector3) -> Directions:
    """Those vertices of a plane point set, shape (n, 3), that make its convex hull, in order."""
    import shapely

    first, second = tangents(unit)
    flat = (points - points[0]) @ np.array([first, second]).T
    corners = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(flat)))
    return corners @ np.array([first, second]) + points[0]
