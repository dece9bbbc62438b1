"""How deep two solids are in each other, by their true surfaces: vertices inside, and edges that pierce faces.

Where two polyhedra overlap, an edge of one pierces a face of the other, or one lies wholly inside the other. So depth
is looked for at vertices and along the pieces into which piercings cut the edges. Where faces
lie in each other neither may be: then `separation` looks just below the triangles. Facets that stand for round surfaces
may cut into each other where the surfaces themselves only touch, and reach less deep than these: what is round is
judged by its true surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.depth import DepthField
from fixture_design.geometry.features import EdgeEnds, Features
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.round_meeting import round_on_flat, round_outside_round, sharp_on_round
from fixture_design.geometry.separation import separation
from fixture_design.geometry.shapes import Corners, Directions, Vector3
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.geometry.surface import SolidSurface
from fixture_design.layout import Pose

#: Where on a piece of an edge its depth is measured, between 0 and 1.
_STATIONS = (0.125, 0.25, 0.5, 0.75, 0.875)
#: Places looked at together, the deepest first: an overlap is mostly proved by them.
_AT_ONCE = 500


@dataclass(frozen=True, eq=False)
class Penetration:
    """The deepest place found: ``depth`` > 0 [m], at ``point`` in P, of which solid (0: the part, 1: the body)."""

    depth: float
    point: Vector3
    of: int


def deepest(part: Features, body: Features, gap: float) -> Penetration | None:
    """The deepest overlap beyond ``gap`` that was found; None if there is none."""
    worst: Penetration | None = None
    most = sum(max((s.sagitta for s in side.geometry.smooth_surfaces), default=0.0) for side in (part, body))
    for number, (mine, theirs) in enumerate(((part, body), (body, part))):
        low, high = theirs.geometry.low + gap - most, theirs.geometry.high - gap + most
        places = np.vstack([mine.geometry.vertices, pierced_pieces(mine.all_edges, theirs.corners)])
        places = places[((places > low) & (places < high)).all(axis=1)]
        if not len(places):
            continue
        field = DepthField(theirs.geometry)
        depths = field.at(places)
        order = np.argsort(-depths, kind="stable")
        first = places[order[: np.count_nonzero(depths + most > gap)][:_AT_ONCE]]
        surfaces = SolidSurface.near(mine.geometry, first), SolidSurface.near(theirs.geometry, first)
        for index in order.tolist():
            if depths[index] + most <= max(gap, worst.depth if worst else 0.0):
                break
            depth, place = _true_depth(*surfaces, field, places[index])
            if depth > max(gap, worst.depth if worst else 0.0):
                worst = Penetration(depth, place, number)
    found = [one for one in (worst, _sunk(part, body, gap, most)) if one]
    return max(found, key=lambda one: one.depth) if found else _flush(part, body, gap)


def _true_depth(mine: SolidSurface, theirs: SolidSurface, field: DepthField, place: Vector3) -> tuple[float, Vector3]:
    """How deep a place on the facets of one solid certainly is in the other [m], and the place, by true surfaces."""
    errors = 0.0
    for surface in _surfaces_at(mine, place):
        if surface is not None:
            place, errors = surface.project(place), errors + surface.error
    surfaces = _surfaces_at(theirs, place)
    depths = [-surface.distance(place) - surface.error for surface in surfaces if surface is not None]
    if None in surfaces:
        depths.append(float(field.at(place[None])[0]))
    return min(depths) - errors, place


def _sunk(part: Features, body: Features, gap: float, most: float) -> Penetration | None:
    """The deepest place where a convex round surface is in a face or edge by less than its facets are off it."""
    if most == 0:
        return None
    found: list[Penetration] = []
    for number, (mine, theirs) in enumerate(((part, body), (body, part))):
        places = [*round_on_flat(mine, theirs, gap + most), *sharp_on_round(mine, theirs, gap + most)]
        if number == 0:
            places += round_outside_round(mine, theirs, gap + most)
        found += [Penetration(-place.distance, place.point, number) for place in places]
    # fitted surfaces are known to within their errors
    errors = sum(max((s.error for s in side.geometry.smooth_surfaces), default=0.0) for side in (part, body))
    worst = max(found, key=lambda one: one.depth, default=None)
    return worst if worst and worst.depth > gap + errors else None


def _flush(part: Features, body: Features, gap: float) -> Penetration | None:
    """An overlap of solids whose faces lie in each other's, where no edge pierces a face."""
    found = separation(part.solid, body.solid, Pose.identity(3), limit=-gap)
    if found.point is None:
        return None
    depth = -found.distance - bulge(part.geometry, found.point) - bulge(body.geometry, found.point)
    return Penetration(-found.distance, found.point, 0) if depth > gap else None


def _surfaces_at(surface: SolidSurface, point: Vector3) -> list[SmoothSurface | None]:
    """The round surfaces whose facets are nearest to a point, each once; None for plane facets."""
    facets = surface.facets_at(surface.foot(point)[1])
    return list({id(s): s for s in map(surface.geometry.surface_of_facet, facets.tolist())}.values())


def bulge(geometry: PartGeometry, point: Vector3) -> float:
    """How far the true surface nearest to a point may be from the facets that stand for it [m]; 0 for plane facets."""
    surfaces = _surfaces_at(SolidSurface(geometry), point)
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
