"""How well the vertices of a mesh are known, judged by the plane facets that they should lie in.

The digits of a file say how finely its numbers were written, not how well the program that wrote them knew them: an
export of a cube may have corners that are off by several times the rounding of float32. Flat facets tell: their
vertices should lie in one plane, and facets that are all but square to a coordinate axis were meant to be
(``SQUARED_ANGLE``). A taper that somebody may have meant tells nothing of noise.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.shapes import FacetMask, FacetVectors, OfFacet, PerFacet, Vertices
from fixture_design.tolerances import SQUARED_ANGLE


def offsets_from_planes(
    vertices: Vertices, used: Indices, starts: OfFacet, units: FacetVectors, centroids: FacetVectors
) -> PerFacet:
    """For each facet how far the furthest of its vertices is from where it should be [m], shape (f,).

    From the facet's plane; on a facet within ``SQUARED_ANGLE`` of square to an axis, also half the spread of that
    coordinate.

    Args:
        vertices: shape (v, 3) [m].
        used: the vertex numbers of all facets, facet after facet.  starts: where each facet's begin, shape (f,).
        units, centroids: unit normals and points of the planes, shape (f, 3).
    """
    points = vertices[used]
    owner = np.repeat(np.arange(len(starts)), np.diff([*starts.tolist(), len(used)]))
    heights = np.abs(np.einsum("ij,ij->i", points - centroids[owner], units[owner]))
    offsets = np.maximum.reduceat(heights, starts)
    spreads = np.maximum.reduceat(points, starts) - np.minimum.reduceat(points, starts)
    axis = np.argmax(np.abs(units), axis=1)
    spread = spreads[np.arange(len(starts)), axis]
    return np.where(nearly_square(units), np.maximum(offsets, spread / 2), offsets)


def nearly_square(units: FacetVectors) -> FacetMask:
    """Which unit normals are within ``SQUARED_ANGLE`` of a coordinate axis."""
    return angles_to_axes(units) <= SQUARED_ANGLE


def angles_to_axes(units: FacetVectors) -> PerFacet:
    """The angle between each unit normal and the coordinate axis nearest to it [rad], shape (f,)."""
    sizes = np.sort(np.abs(units), axis=1)
    return np.arctan2(np.hypot(sizes[:, 0], sizes[:, 1]), sizes[:, 2])


def on_axes(normals: FacetVectors) -> FacetVectors:
    """Each normal as if square to the coordinate axis nearest to it: its largest component alone."""
    largest = np.abs(normals) == np.abs(normals).max(axis=1, keepdims=True)
    return np.where(largest, normals, 0.0)
