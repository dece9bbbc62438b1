"""Sliding over a surface: straight ahead on every facet, over edges as if they were unfolded, through vertices evenly.

The path is a straightest geodesic: it keeps its angle to each edge that it crosses, and leaves a vertex with as much
surface on its left as on its right. It is unique, and the way back is the same way.
Source: Polthier and Schmies, Straightest geodesics on polyhedral surfaces, 1998.

    >>> spot = slide(geometry, spot.point, spot.direction, 0.002)      # doctest: +SKIP
    >>> geometry.facets[spot.facet].name
    'facet 4'
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Points, read_only
from fixture_design.errors import GeometryError, OffSurfaceError
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Vector3
from fixture_design.tolerances import MERGE_VERTICES, SURFACE_GAP

#: Triangles crossed at most in one slide.
_MOST_CROSSINGS = 1_000_000

#: A direction with less than this along a triangle says nothing about which way to go on it [-].
_ALONG = 1e-3


@dataclass(frozen=True, eq=False)
class Slide:
    """Where a slide ended.

    Attributes:
        point: p_PC, on the surface.  direction: unit, tangent, straight ahead from there.
        facet: index of the facet that it is on, the one it came over if it is on an edge.
        path: start, every edge crossed, end; shape (n, 3), n >= 2 [m].
        length: of the path [m]; less than asked for only where more than two triangles meet at an edge in the way.
    """

    point: Vector3
    direction: Vector3
    facet: int
    path: Points
    length: float


@dataclass(frozen=True, eq=False)
class _Walker:
    """On a triangle, at a point, going in a direction in its plane; it came in over the sides in ``behind``."""

    triangle: int
    point: Vector3
    direction: Vector3
    behind: tuple[int, ...] = ()


def slide(
    geometry: PartGeometry, p_PC: Vector3, direction: Vector3, length: float, surface_gap: float = SURFACE_GAP
) -> Slide:
    """Walk over the surface from a point.

    Args:
        p_PC: where to start; it is moved to the nearest point of the surface [m].
        direction: which way, in P; what points out of the surface or into it is taken away. Any length but 0.
        length: how far [m], 0 or more.

    Raises:
        OffSurfaceError: the start is further from the surface than ``surface_gap`` [m].
        GeometryError: a direction that is zero, not finite or along the normal; a length that is none.
    """
    if not (np.isfinite(length) and length >= 0):
        raise GeometryError("the length of a slide must be 0 or more", found=str(length), expected="metres")
    walker = _start(geometry, p_PC, direction, surface_gap)
    path, left = [walker.point], length
    for _ in range(_MOST_CROSSINGS):
        side, way = _exit(geometry, walker)
        if way >= left:
            end = walker.point + left * walker.direction
            return _ended(geometry, walker, [*path, end], length)
        ahead = _over(geometry, walker, side, walker.point + way * walker.direction)
        left -= way
        if ahead is None:
            return _ended(geometry, walker, [*path, walker.point + way * walker.direction], length - left)
        walker = ahead
        path.append(walker.point)
    raise GeometryError(f"the slide over {geometry.name!r} crosses too many triangles", expected="a shorter length")


def _ended(geometry: PartGeometry, walker: _Walker, path: list[Vector3], length: float) -> Slide:
    facet = int(geometry.facet_of_triangle[walker.triangle])
    return Slide(read_only(path[-1]), read_only(walker.direction), facet, read_only(path), length)


def _start(geometry: PartGeometry, p_PC: Vector3, direction: Vector3, surface_gap: float) -> _Walker:
    """On the triangle at the start that the direction goes along; of several, one that it does not leave at once."""
    size = float(np.linalg.norm(direction))
    if not (np.isfinite(size) and size > 0):
        raise GeometryError("a slide needs a direction", found=str(direction.tolist()))
    distance, point = geometry.surface.at(p_PC)
    touched = touched_triangles(geometry, point, geometry.on_edge)
    if abs(distance) > surface_gap:
        name = geometry.facets[geometry.facet_of_triangle[touched[0]]].name
        raise OffSurfaceError("start of a slide", geometry.name, distance, name, surface_gap)
    best, walker = (False, 0.0), None
    for triangle in touched.tolist():
        corners, _, normal = _frame(geometry, triangle)
        along = direction / size - (direction / size @ normal) * normal
        share = float(np.linalg.norm(along))
        if share <= MERGE_VERTICES:
            continue
        here = _Walker(triangle, point - ((point - corners[0]) @ normal) * normal, along / share)
        stays = share > _ALONG and _exit(geometry, here)[1] > geometry.on_edge
        if (stays, share) > best:
            best, walker = (stays, share), here
    if walker is None:
        raise GeometryError("a slide needs a direction along the surface", found=f"{direction.tolist()}, its normal")
    return walker


def _frame(geometry: PartGeometry, triangle: int) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3 3"], Vector3]:
    """Corners, the unit vectors of its sides (from corner k to k + 1), and the unit normal."""
    corners = geometry.vertices[geometry.triangles[triangle]]
    sides = np.roll(corners, -1, axis=0) - corners
    normal = np.cross(sides[0], sides[1])
    return corners, sides / np.linalg.norm(sides, axis=1, keepdims=True), normal / np.linalg.norm(normal)


def _exit(geometry: PartGeometry, walker: _Walker) -> tuple[int, float]:
    """The side over which the walker leaves its triangle, and how far that is [m]."""
    corners, sides, normal = _frame(geometry, walker.triangle)
    inward = np.cross(normal, sides)
    height = np.maximum(np.einsum("ij,ij->i", walker.point - corners, inward), 0.0)
    speed = -inward @ walker.direction
    speed[list(walker.behind)] = 0.0
    ways = np.where(speed > 0, height / np.where(speed > 0, speed, 1.0), np.inf)
    side = int(np.argmin(ways))
    if np.isfinite(ways[side]):
        return side, float(ways[side])
    # rounding has it run along the side behind it: it leaves at that side's far end
    return next(k for k in range(3) if k not in walker.behind), 0.0


def _over(geometry: PartGeometry, walker: _Walker, side: int, point: Vector3) -> _Walker | None:
    """The walker beyond a side of its triangle, or beyond the vertex at the end of that side; None if nothing is."""
    corners, sides, normal = _frame(geometry, walker.triangle)
    width = float(np.linalg.norm(corners[(side + 1) % 3] - corners[side]))
    along = float(np.clip((point - corners[side]) @ sides[side], 0.0, width))
    blur = MERGE_VERTICES * 2 * geometry.half_diagonal
    if min(along, width - along) <= blur:
        return _through_vertex(geometry, walker, side if along < width / 2 else (side + 1) % 3)
    other = int(geometry.triangle_neighbours[walker.triangle, side])
    if other < 0:
        return None
    _, other_sides, other_normal = _frame(geometry, other)
    entry = int(np.flatnonzero(geometry.triangle_neighbours[other] == walker.triangle)[0])
    if len(np.flatnonzero(geometry.triangle_neighbours[other] == walker.triangle)) > 1:
        # two triangles with two sides in common: the one that ends where this one starts
        starts = geometry.triangles[other] == geometry.triangles[walker.triangle, (side + 1) % 3]
        entry = int(np.flatnonzero(starts)[0])
    outward = np.cross(sides[side], normal)
    inward = np.cross(other_normal, other_sides[entry])
    # outward is positive, but for rounding
    direction = (walker.direction @ sides[side]) * sides[side] + max(walker.direction @ outward, 0.0) * inward
    on_side = corners[side] + along * sides[side]
    return _Walker(other, on_side, direction / np.linalg.norm(direction), (entry,))


def _through_vertex(geometry: PartGeometry, walker: _Walker, corner: int) -> _Walker | None:
    """The walker beyond a vertex: half of the angle around the vertex lies on either side of its path."""
    vertex = int(geometry.triangles[walker.triangle, corner])
    fan = _fan(geometry, walker.triangle, vertex)
    if fan is None:
        return None
    angles = [_corner_axes(geometry, triangle, vertex)[2] for triangle in fan]
    first, second, angle = _corner_axes(geometry, fan[0], vertex)
    back = float(np.clip(np.arctan2(-walker.direction @ second, -walker.direction @ first), 0.0, angle))
    turn = (back + sum(angles) / 2) % sum(angles)
    number = 0
    while turn > angles[number] and number < len(fan) - 1:
        turn -= angles[number]
        number += 1
    first, second, _ = _corner_axes(geometry, fan[number], vertex)
    place = int(np.flatnonzero(geometry.triangles[fan[number]] == vertex)[0])
    # only the side opposite to the vertex is ahead
    behind = (place, (place + 2) % 3)
    return _Walker(fan[number], geometry.vertices[vertex], np.cos(turn) * first + np.sin(turn) * second, behind)


def _fan(geometry: PartGeometry, triangle: int, vertex: int) -> list[int] | None:
    """The triangles around a vertex, counter-clockwise from one of them; None where more than two meet at an edge."""
    fan = [triangle]
    while True:
        corner = int(np.flatnonzero(geometry.triangles[fan[-1]] == vertex)[0])
        following = int(geometry.triangle_neighbours[fan[-1], (corner + 2) % 3])
        if following < 0:
            return None
        if following == triangle:
            return fan
        fan.append(following)


def _corner_axes(geometry: PartGeometry, triangle: int, vertex: int) -> tuple[Vector3, Vector3, float]:
    """At a corner: the unit vector of its first side, the one at right angles to it in the plane, and the angle."""
    corner = int(np.flatnonzero(geometry.triangles[triangle] == vertex)[0])
    _, sides, normal = _frame(geometry, triangle)
    first, second = sides[corner], np.cross(normal, sides[corner])
    last = -sides[(corner + 2) % 3]
    return first, second, float(np.arctan2(last @ second, last @ first))
