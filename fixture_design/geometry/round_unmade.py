"""Round surfaces that touch without a contact made of it: cones and tori against anything round.

Contact between cylinders and balls has its own treatment (`round_meeting`); that of cones and tori is found where the
triangles that stand for them meet, which they need not do; so is that of a ring lying on a flat. What is missed is
looked for here, since a contact that is left out makes a part freer than it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.contacts import tangents
from fixture_design.geometry.features import Features
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Directions, Vector3
from fixture_design.geometry.sheet import Sheet
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.tolerances import COPLANAR_ANGLE

#: Kinds that `round_meeting` makes contacts of.
_MADE = {"cylinder", "sphere"}
#: Places of either surface that a common point is looked for from; and around a ring.
_STARTS = 8


def unmade(part: Features, body: Features, made: Directions, gap: float) -> tuple[Vector3, str, str] | None:
    """Where a round surface touches one of the other solid, or a ring lies on a flat, with no contact near.

    Args:
        made: the points of all contacts found, shape (n, 3) [m].
        gap: what is no further apart than this touches [m].

    Returns:
        the point, and what touches what there: of the part, of the body; None if nothing was missed.
    """
    for first, second, turned in ((part, body, False), (body, part, True)):
        for point, ring, flat in _rings_on_flats(first.geometry, second.geometry, gap):
            if not (np.linalg.norm(made - point, axis=1) <= 4 * gap).any():
                return (point, flat, ring) if turned else (point, ring, flat)
    for mine in part.geometry.smooth_surfaces:
        for theirs in body.geometry.smooth_surfaces:
            if {mine.kind, theirs.kind} <= _MADE or (mine.hollow and theirs.hollow):
                continue
            for point in _common_points(part.geometry, mine, body.geometry, theirs, gap):
                near = 4 * gap + _chord(mine) + _chord(theirs)
                if (np.linalg.norm(made - point, axis=1) <= near).any():
                    continue
                allowed = gap + mine.error + theirs.error
                # where a fillet ends in a bore or a flat, the contact is that of the bore or flat
                joined = (_joins(part.geometry, mine, point, allowed), _joins(body.geometry, theirs, point, allowed))
                if not all(joined):
                    return point, mine.name, theirs.name
    return None


def _rings_on_flats(mine: PartGeometry, theirs: PartGeometry, gap: float) -> Iterator[tuple[Vector3, str, str]]:
    """Points of tori that lie on a plane facet with a whole circle, and no flat of their own around there."""
    for surface in mine.smooth_surfaces:
        if surface.kind != "torus" or surface.hollow:
            continue
        allowed = gap + surface.error
        for number, facet in enumerate(theirs.facets):
            up = facet.normal / np.linalg.norm(facet.normal)
            flat = np.linalg.norm(np.cross(up, surface.axis)) <= COPLANAR_ANGLE
            height = float((surface.point - facet.centroid) @ up) - surface.radius
            if not flat or abs(height) > allowed or theirs.surface_of_facet(number) is not None:
                continue
            sheet = Sheet.of(mine, surface.facets, surface.sagitta + allowed)
            first, second = tangents(surface.axis)
            for angle in np.arange(_STARTS) * 2 * np.pi / _STARTS:
                out = np.cos(angle) * first + np.sin(angle) * second
                point = surface.point + surface.ring * out - surface.radius * up
                there = sheet.covers(point, up) and _on_flat(theirs, number, point, allowed)
                if there and not _joins(mine, surface, point, allowed):
                    yield point, surface.name, facet.name


def _common_points(
    part: PartGeometry, mine: SmoothSurface, body: PartGeometry, theirs: SmoothSurface, gap: float
) -> Iterator[Vector3]:
    """Points where both surfaces are, within the gap: deepest, or nearest, from several starts."""
    allowed = gap + mine.error + theirs.error
    points, others = _vertices(part, mine.facets), _vertices(body, theirs.facets)
    reach = allowed + _chord(mine) + _chord(theirs)
    low, high = others.min(axis=0) - reach, others.max(axis=0) + reach
    inside = points[((points >= low) & (points <= high)).all(axis=1)]
    if not len(inside) and not _boxes_meet(points, others, reach):
        return
    sheets = (
        Sheet.of(part, mine.facets, mine.sagitta + allowed),
        Sheet.of(body, theirs.facets, theirs.sagitta + allowed),
    )
    starts = points[np.argsort(np.abs(theirs.shape.offsets(points)), kind="stable")[:_STARTS]]
    back = others[np.argsort(np.abs(mine.shape.offsets(others)), kind="stable")[:_STARTS]]
    for start in (*starts, *back):
        point = _nearest(mine, theirs, start)
        foot = theirs.project(point)
        if np.linalg.norm(foot - point) <= allowed and _covered(sheets, (mine, theirs), (point, foot)):
            yield point


def _nearest(mine: SmoothSurface, theirs: SmoothSurface, start: Vector3) -> Vector3:
    """The point of one surface that is deepest in the other, or nearest to it, from a point near the surface."""
    from scipy.optimize import minimize

    start = mine.project(start)
    first, second = tangents(mine.shape.directions(start[None])[0])
    size = max(mine.radius if mine.kind != "cone" else 0.0, mine.ring, float(np.linalg.norm(start - mine.point)))

    def moved(steps: np.ndarray) -> Vector3:
        return mine.project(start + size * (steps[0] * first + steps[1] * second))

    found = minimize(lambda steps: theirs.distance(moved(steps)) / size, np.zeros(2))
    return moved(found.x)


def _covered(sheets: Sequence[Sheet], surfaces: Sequence[SmoothSurface], points: Sequence[Vector3]) -> bool:
    """Whether each point is on its sheet; points on an axis have no normal to look along, and are on none."""
    for sheet, surface, point in zip(sheets, surfaces, points, strict=True):
        normal = surface.shape.directions(point[None])[0]
        if not normal.any() or not sheet.covers(point, normal):
            return False
    return True


def _joins(geometry: PartGeometry, surface: SmoothSurface, point: Vector3, allowed: float) -> bool:
    """Whether contacts are made of the surface at a point: of itself, or of a cylinder, ball or flat that it joins."""
    if surface.kind in _MADE:
        return True
    for other in geometry.smooth_surfaces:
        if other.kind in _MADE and abs(other.distance(point)) <= allowed:
            normal = other.shape.directions(point[None])[0]
            if normal.any() and Sheet.of(geometry, other.facets, other.sagitta + allowed).covers(point, normal):
                return True
    flats = (facet for facet in range(len(geometry.facets)) if geometry.surface_of_facet(facet) is None)
    return any(_on_flat(geometry, facet, point, allowed) for facet in flats)


def _on_flat(geometry: PartGeometry, number: int, point: Vector3, allowed: float) -> bool:
    facet = geometry.facets[number]
    normal = facet.normal / np.linalg.norm(facet.normal)
    near = abs(float((point - facet.centroid) @ normal)) <= allowed
    return near and Sheet.of(geometry, np.array([number]), allowed).covers(point, normal)


def _boxes_meet(points: Directions, others: Directions, reach: float) -> bool:
    low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
    return bool(((others.max(axis=0) >= low) & (others.min(axis=0) <= high)).all())


def _vertices(geometry: PartGeometry, facets: Indices) -> Directions:
    triangles = np.concatenate([geometry.facets[facet].triangles for facet in facets])
    return geometry.vertices[np.unique(geometry.triangles[triangles])]


def _chord(surface: SmoothSurface) -> float:
    """About half the length of a facet across: a contact of the triangles may be this far from that of the surfaces."""
    radius = surface.radius if surface.kind != "cone" else 0.0
    size = max(radius, surface.ring)
    return float(np.sqrt(max(2 * size * surface.sagitta, 0.0))) + surface.sagitta
