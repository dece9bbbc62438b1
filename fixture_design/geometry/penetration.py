"""How deep two solids are in each other, by their true surfaces: vertices inside, and edges that pierce faces.

Where two polyhedra overlap, an edge of one pierces a face of the other, or one lies wholly inside the other. So depth
is looked for at vertices and along the pieces into which piercings cut the edges. Facets that stand for round surfaces
may cut into each other where the surfaces themselves only touch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.depth import DepthField
from fixture_design.geometry.features import EdgeEnds, Features
from fixture_design.geometry.local import facets_at
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Directions, Vector3

#: Where on a piece of an edge its depth is measured, between 0 and 1.
_STATIONS = (0.125, 0.25, 0.5, 0.75, 0.875)


@dataclass(frozen=True, eq=False)
class Penetration:
    """The deepest place found: ``depth`` > 0 [m], at ``point`` in P, of which solid (0: the part, 1: the body)."""

    depth: float
    point: Vector3
    of: int


def deepest(part: Features, body: Features, gap: float) -> Penetration | None:
    """The deepest overlap beyond ``gap`` that was found; None if there is none."""
    worst: Penetration | None = None
    for number, (mine, theirs) in enumerate(((part, body), (body, part))):
        low, high = theirs.geometry.low + gap, theirs.geometry.high - gap
        places = np.vstack([mine.geometry.vertices, pierced_pieces(mine.all_edges, theirs.corners)])
        places = places[((places > low) & (places < high)).all(axis=1)]
        if not len(places):
            continue
        depths = DepthField(theirs.geometry).at(places)
        for index in np.argsort(-depths, kind="stable").tolist():
            if depths[index] <= max(gap, worst.depth if worst else 0.0):
                break
            place = places[index]
            if depths[index] > gap + bulge(theirs.geometry, place) + bulge(mine.geometry, place):
                worst = Penetration(float(depths[index]), place, number)
                break
    return worst


def bulge(geometry: PartGeometry, point: Vector3) -> float:
    """How far the true surface nearest to a point may be from the facets that stand for it [m]; 0 for plane facets."""
    _, nearest = geometry.surface.at(point)
    facets = facets_at(geometry, touched_triangles(geometry, nearest, geometry.on_edge))
    surfaces = [geometry.surface_of_facet(facet) for facet in facets.tolist()]
    return max((surface.sagitta + surface.error for surface in surfaces if surface is not None), default=0.0)


def pierced_pieces(edges: EdgeEnds, corners: Corners) -> Directions:
    """Stations on the pieces of those edges that pierce a triangle, shape (n, 3) [m]."""
    edge, triangle = box_pairs(boxes_of(edges), boxes_of(corners), 0.0)
    places = _piercings(edges[edge], corners[triangle])
    pierced = np.isfinite(places)
    cuts: dict[int, list[float]] = {}
    for index, place in zip(edge[pierced].tolist(), places[pierced].tolist(), strict=True):
        cuts.setdefault(index, [0.0, 1.0]).append(place)
    stations = [
        edges[index, 0] + (low + share * (high - low)) * (edges[index, 1] - edges[index, 0])
        for index, places_of in cuts.items()
        for low, high in zip(sorted(places_of)[:-1], sorted(places_of)[1:], strict=True)
        for share in _STATIONS
    ]
    return np.array(stations).reshape(-1, 3)


def _piercings(edges: EdgeEnds, corners: Corners) -> np.ndarray:
    """Where on its edge, between 0 and 1, each edge pierces its triangle; NaN where it does not; shape (n,)."""
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    sides = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(sides[:, 0], sides[:, 1])
    first = np.einsum("nj,nj->n", start - corners[:, 0], normals)
    second = np.einsum("nj,nj->n", edges[:, 1] - corners[:, 0], normals)
    crossing = first * second < 0
    place = np.where(crossing, first / np.where(crossing, first - second, 1.0), np.nan)
    points = start + np.nan_to_num(place)[:, None] * along
    inward = np.cross(normals[:, None], sides)
    inside = (np.einsum("nkj,nkj->nk", inward, points[:, None] - corners) >= 0).all(axis=1)
    return np.where(crossing & inside, place, np.nan)
