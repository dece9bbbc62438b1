"""Where round surfaces touch: shafts on flats and in V-blocks, pins in bores, balls, edges across a shaft.

A tessellated shaft is not taken facet by facet: contact is that of the true surface, in a point, along a line, or all
around. Its extent is that of the triangles that stand for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Rows
from fixture_design.contacts import tangents
from fixture_design.errors import UnsupportedError
from fixture_design.geometry.features import EdgeEnds, Features
from fixture_design.geometry.shapes import Directions, Vector3
from fixture_design.geometry.sheet import Sheet, Stretches, common
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.tolerances import COPLANAR_ANGLE

#: Directions around an axis in which surfaces that fit each other all around are held apart.
_AROUND = 8
#: Directions in which it is looked whether surfaces that fit each other both are there.
_LOOKS = 72
#: Halvings by which the end of an arc is found: to a millionth of a turn.
_HALVINGS = 20


@dataclass(frozen=True, eq=False)
class RoundPlace:
    """A place where a round surface touches another face.

    Attributes:
        point: of the round surface [m].  other: of the other face [m].
        normal: unit, out of the solid that the round surface bounds.
        name: of the round surface.  other_name: of the other face.
        error: of the normal [rad].
        slips: motions of the round surface along itself, about the origin, shape (k, 6).
    """

    point: Vector3
    other: Vector3
    normal: Vector3
    name: str
    other_name: str
    error: float
    slips: Rows

    @property
    def distance(self) -> float:
        """Along the normal, negative where the solids overlap [m]."""
        return float((self.other - self.point) @ self.normal)


def round_on_flat(mine: Features, theirs: Features, gap: float) -> Iterator[RoundPlace]:
    """Where convex round surfaces of one solid touch plane facets of the other.

    Args:
        gap: what is no further apart than this touches [m].
    """
    for surface in mine.geometry.smooth_surfaces:
        if not surface.hollow:
            sheet = _round_sheet(mine, surface, gap)
            for facet in _plane_facets(theirs):
                yield from _on_plane(surface, sheet, theirs, facet, gap)


def round_on_round(mine: Features, theirs: Features, gap: float) -> Iterator[RoundPlace]:
    """Where cylinders and balls of one solid touch those of the other, outside, inside, or all around.

    Raises:
        UnsupportedError: a ball that fills a bore or a socket.
    """
    for surface in mine.geometry.smooth_surfaces:
        for other in theirs.geometry.smooth_surfaces:
            if (surface.hollow and other.hollow) or not {surface.kind, other.kind} <= {"cylinder", "sphere"}:
                continue
            yield from _on_round(
                surface, _round_sheet(mine, surface, gap), other, _round_sheet(theirs, other, gap), gap
            )


def round_outside_round(mine: Features, theirs: Features, gap: float) -> Iterator[RoundPlace]:
    """Of `round_on_round` the places of two convex surfaces."""
    for surface in mine.geometry.smooth_surfaces:
        for other in theirs.geometry.smooth_surfaces:
            if surface.hollow or other.hollow or not {surface.kind, other.kind} <= {"cylinder", "sphere"}:
                continue
            yield from _on_round(
                surface, _round_sheet(mine, surface, gap), other, _round_sheet(theirs, other, gap), gap
            )


def sharp_on_round(mine: Features, theirs: Features, gap: float) -> Iterator[RoundPlace]:
    """Where vertices of one solid lie on cylinders and balls of the other, and edges on convex ones; of the first."""
    for surface in theirs.geometry.smooth_surfaces:
        if surface.kind not in ("cylinder", "sphere"):
            continue
        sheet = _round_sheet(theirs, surface, gap)
        points = np.vstack([mine.sharp_points, _nearest_on_edges(mine.sharp_edges, surface)])
        # a hair more than what is tested below, point by point
        near = np.abs(surface.shape.offsets(points)) <= 2 * (gap + surface.error)
        for point in points[near]:
            foot = surface.project(point)
            if np.linalg.norm(foot - point) <= gap + surface.error and sheet.covers(foot, surface.normal(foot)):
                normal = -surface.normal(foot)
                yield RoundPlace(point, foot, normal, "", surface.name, surface.normal_error, surface.slips())


def _nearest_on_edges(edges: EdgeEnds, surface: SmoothSurface) -> Directions:
    """The points inside edges that are nearest to the axis or centre of a convex surface; none for hollow ones."""
    if surface.hollow or not len(edges):
        return np.zeros((0, 3))
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    away = surface.point - start
    if surface.kind == "cylinder":
        along_across = along - np.outer(along @ surface.axis, surface.axis)
        away = away - np.outer(away @ surface.axis, surface.axis)
    else:
        along_across = along
    sizes = np.einsum("nj,nj->n", along_across, along_across)
    crossing = sizes > (COPLANAR_ANGLE**2) * np.einsum("nj,nj->n", along, along)
    place = np.einsum("nj,nj->n", away, along_across) / np.where(crossing, sizes, 1.0)
    inside = crossing & (place > 0) & (place < 1)
    return start[inside] + place[inside, None] * along[inside]


def _round_sheet(features: Features, surface: SmoothSurface, gap: float) -> Sheet:
    return Sheet.of(features.geometry, surface.facets, surface.sagitta + surface.error + gap)


def _plane_facets(features: Features) -> list[int]:
    count = len(features.geometry.facets)
    return [facet for facet in range(count) if features.geometry.surface_of_facet(facet) is None]


def _on_plane(surface: SmoothSurface, sheet: Sheet, theirs: Features, facet: int, gap: float) -> Iterator[RoundPlace]:
    """A convex round surface on a plane facet: the point or the two ends of the line where it touches the plane."""
    plane = theirs.geometry.facets[facet]
    up = plane.normal / np.linalg.norm(plane.normal)
    contact = _lowest(surface, up)
    if contact is None:
        return
    point, along = contact
    height = float((point - plane.centroid) @ up)
    if abs(height) > gap + surface.error:
        return
    flat = Sheet.of(theirs.geometry, np.array([facet]), gap + surface.error)
    for place in _ends(sheet, flat, point, along, up):
        foot = place - float((place - plane.centroid) @ up) * up
        yield RoundPlace(place, foot, -up, surface.name, plane.name, plane.normal_error, surface.slips())


def _lowest(surface: SmoothSurface, up: Vector3) -> tuple[Vector3, Vector3 | None] | None:
    """The point of a convex round surface with normal -up, and the direction of the line of such points if it is one.

    None where there is no such point, or a circle of them.
    """
    axis, tilt = surface.axis, float(surface.axis @ up)
    across = up - tilt * axis
    size = float(np.linalg.norm(across))
    match surface.kind:
        case "cylinder":
            if abs(tilt) > COPLANAR_ANGLE:
                return None
            return surface.point - surface.radius * up, axis
        case "sphere":
            return surface.point - surface.radius * up, None
        case "cone":
            # the plane holds one of its lines: the angle between axis and plane is that at the apex
            if size == 0 or abs(tilt - np.sin(surface.radius)) > COPLANAR_ANGLE:
                return None
            return surface.point, np.cos(surface.radius) * axis - np.sin(surface.radius) * across / size
        case "torus":
            if size <= COPLANAR_ANGLE:
                return None
            return surface.point - surface.ring * across / size - surface.radius * up, None


def _ends(sheet: Sheet, other: Sheet, point: Vector3, along: Vector3 | None, normal: Vector3) -> list[Vector3]:
    """The point, or the ends of the stretches of the line, where both faces are."""
    if along is None:
        return [point] if sheet.covers(point, normal) and other.covers(point, normal) else []
    square = along - (along @ normal) * normal
    square /= np.linalg.norm(square)
    both = common(sheet.stretches(point, square, normal), other.stretches(point, square, normal))
    return [point + place * along for stretch in both for place in sorted(set(stretch))]


def _on_round(
    surface: SmoothSurface, sheet: Sheet, other: SmoothSurface, other_sheet: Sheet, gap: float
) -> Iterator[RoundPlace]:
    """Two cylinders or balls, at most one of them hollow."""
    allowed = gap + surface.error + other.error
    cylinders = surface.kind == other.kind == "cylinder"
    parallel = cylinders and float(np.linalg.norm(np.cross(surface.axis, other.axis))) <= COPLANAR_ANGLE
    nested = surface.hollow or other.hollow
    if nested and cylinders and not parallel:
        return
    start, end = _nearest_centers(surface, other, parallel)
    between = end - start
    distance = float(np.linalg.norm(between))
    # hollow radii count negative: sums tell how far apart the centres of surfaces that touch are
    apart = _radius(surface) + _radius(other)
    error = max(surface.normal_error, other.normal_error)
    if cylinders and not parallel:
        # the normal is the cross product of the axes
        sine = float(np.linalg.norm(np.cross(surface.axis, other.axis)))
        error = (surface.normal_error + other.normal_error) / sine
    if nested and max(distance, abs(apart)) <= allowed:
        if not parallel:
            text = f"{surface.name} and {other.name} fit each other: balls that fill bores or sockets are not evaluated"
            raise UnsupportedError(text, expected="a cylinder in a bore, or clearance")
        yield from _all_around(surface, sheet, other, other_sheet, error)
    if abs(distance - abs(apart)) > allowed or distance <= allowed or (nested and apart > 0):
        return
    # out of the first centre; a surface inside another touches it on the far side from the other's centre
    outward = between / distance if surface.hollow or not nested else -between / distance
    point = start + surface.radius * outward
    normal = -outward if surface.hollow else outward
    for place in _ends(sheet, other_sheet, point, surface.axis if parallel else None, normal):
        yield RoundPlace(place, other.project(place), normal, surface.name, other.name, error, surface.slips())


def _radius(surface: SmoothSurface) -> float:
    return -surface.radius if surface.hollow else surface.radius


def _nearest_centers(surface: SmoothSurface, other: SmoothSurface, parallel: bool) -> tuple[Vector3, Vector3]:
    """The points of axes or centres that are nearest to each other."""
    if surface.kind == "sphere" and other.kind == "sphere":
        return surface.point, other.point
    if surface.kind == "sphere":
        return surface.point, _foot(other, surface.point)
    if other.kind == "sphere" or parallel:
        return _foot(surface, other.point), other.point
    normal = np.cross(surface.axis, other.axis)
    size = float(normal @ normal)
    between = other.point - surface.point
    t = float(np.cross(between, other.axis) @ normal) / size
    u = float(np.cross(between, surface.axis) @ normal) / size
    return surface.point + t * surface.axis, other.point + u * other.axis


def _foot(surface: SmoothSurface, point: Vector3) -> Vector3:
    return surface.point + float((point - surface.point) @ surface.axis) * surface.axis


def _all_around(
    surface: SmoothSurface, sheet: Sheet, other: SmoothSurface, other_sheet: Sheet, error: float
) -> Iterator[RoundPlace]:
    """A pin that fills its bore, or a part of it: both ends of lines in enough directions around the axis.

    A row of a normal n at a point p = c + r n has the moment c X n: rows of an arc lie in the cone of those of its ends
    and of directions less than half a turn apart between them.
    """
    first, second = tangents(surface.axis)

    def direction(angle: float) -> Vector3:
        return np.cos(angle) * first + np.sin(angle) * second

    def covered(angle: float) -> Stretches:
        outward = direction(angle)
        point = surface.point + surface.radius * outward
        both = (sheet, other_sheet)
        return common(*(one.stretches(point, surface.axis, outward) for one in both))

    for angle in _angles(lambda angle: bool(covered(angle))):
        outward = direction(angle)
        for stretch in covered(angle):
            for place in sorted(set(stretch)):
                point = surface.point + surface.radius * outward + place * surface.axis
                normal = -outward if surface.hollow else outward
                yield RoundPlace(point, other.project(point), normal, surface.name, other.name, error, surface.slips())


def _angles(covered: Callable[[float], bool]) -> list[float]:
    """Angles at which to hold: all around, or both ends of every arc that is covered and some between."""
    step = 2 * np.pi / _LOOKS
    looks = [covered(number * step) for number in range(_LOOKS)]
    if all(looks):
        return [2 * np.pi * number / _AROUND for number in range(_AROUND)]
    angles: list[float] = []
    for number in range(_LOOKS):
        if looks[number] and not looks[number - 1]:
            last = next(k for k in range(number, number + _LOOKS) if not looks[(k + 1) % _LOOKS])
            low = _border(covered, number * step, (number - 1) * step)
            high = _border(covered, last * step, (last + 1) * step)
            count = 1 + int(np.ceil((high - low) / (2 * np.pi / _AROUND)))
            angles += np.linspace(low, high, max(2, count)).tolist()
    return angles


def _border(covered: Callable[[float], bool], inside: float, outside: float) -> float:
    """The last covered angle on the way out."""
    for _ in range(_HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if covered(middle) else (inside, middle)
    return inside
