"""The apices of a mesh: where its planes meet, and which of them can touch a plane with nothing but themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Mask, Points
from fixture_design.assembly.mesh_edges import MeshEdges
from fixture_design.cones.kernel.minimum_norm import minimum_norm_point
from fixture_design.errors import UnsupportedError, format_length
from fixture_design.tolerances import COPLANAR_ANGLE, SOLVED

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry

#: Singular values of unit normals below this: the planes leave a direction open, along which nothing is moved [-].
_OPEN = 1e-3


def corner_points(geometry: PartGeometry, edges: MeshEdges, offsets: np.ndarray) -> Points:
    """The corners of the edges, each moved to where the planes of its facets meet, shape (c, 3) [m].

    Meshes are written with few digits, and an apex that is off the planes of its own facets by that rounding would
    touch another plane before or after they do.

    Raises:
        UnsupportedError: more than three planes that do not meet in one point.
    """
    points = geometry.vertices[edges.corners].copy()
    size = 2 * geometry.half_diagonal
    for k, corner in enumerate(edges.corners):
        own = np.unique(edges.facets[(edges.ends == corner).any(axis=1)])
        normals = geometry.facet_units[own]
        off = offsets[own] - normals @ points[k]
        points[k] += np.linalg.lstsq(normals, off, rcond=_OPEN)[0]
        left = float(np.abs(normals @ points[k] - offsets[own]).max())
        if left > SOLVED * size:
            names = ", ".join(geometry.facets[f].name for f in own)
            raise UnsupportedError(
                f"{names} of {geometry.name!r} do not meet in one point, by {format_length(left)}",
                expected=f"vertices with more digits, known to {format_length(SOLVED * size)}",
            )
    return points


def touching_apices(geometry: PartGeometry, edges: MeshEdges, points: Points) -> Mask:
    """Which corners can touch a plane that touches nothing else there, shape (c,).

    So it is if the edges there are within a cone with an apex, facets turn by less than pi, and the solid is inside:
    the outermost edge is convex. The others (saddles, inner corners, corners along an edge) form no pairs.
    """
    row = {int(corner): k for k, corner in enumerate(edges.corners)}
    directions: list[list[np.ndarray]] = [[] for _ in row]
    convex: list[list[bool]] = [[] for _ in row]
    turns: list[dict[int, list[np.ndarray]]] = [{} for _ in row]
    for ends, facets, is_convex in zip(edges.ends, edges.facets, edges.convex, strict=True):
        a, b = row[int(ends[0])], row[int(ends[1])]
        along = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
        for k, way, order in ((a, along, facets), (b, -along, facets[::-1])):
            directions[k].append(way)
            convex[k].append(bool(is_convex))
            # seen from outside, the first facet of `order` is to the left of the way, so that it begins there
            turns[k].setdefault(int(order[0]), [np.zeros(3)] * 2)[0] = way
            turns[k].setdefault(int(order[1]), [np.zeros(3)] * 2)[1] = way
    return np.array([
        _is_convex(np.array(ways), np.array(sides), _reflex(geometry, ring))
        for ways, sides, ring in zip(directions, convex, turns, strict=True)
    ])  # fmt: skip


def _reflex(geometry: PartGeometry, ring: dict[int, list[np.ndarray]]) -> bool:
    """Whether a facet turns by pi or more: from where it begins to where it ends, counter-clockwise."""
    return any(
        geometry.facet_units[facet] @ np.cross(begin, end) < np.sin(COPLANAR_ANGLE)
        for facet, (begin, end) in ring.items()
    )


def _is_convex(ways: Points, convex: Mask, reflex: bool) -> bool:
    nearest, _ = minimum_norm_point(ways)
    length = float(np.linalg.norm(nearest))
    if reflex or length < np.sin(COPLANAR_ANGLE):
        return False
    # of the directions of a cone the one furthest from any inner one is on its border
    return bool(convex[np.argmin(ways @ nearest)])
