"""Only what is needed: of all places of contact, those that do not follow from others.

A normal that is excluded at some points of a plane is excluded in their convex hull, since n . v is linear in the
point. So of the places with one normal in one plane the corners of the hull stay: for a face on a face those of the
overlap. An OR follows wherever one of its normals is excluded anyway.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.contacts import Clause, matching, tangents, unit_normal
from fixture_design.geometry.shapes import Vector3
from fixture_design.geometry.touch import Touch
from fixture_design.tolerances import COPLANAR_ANGLE, SQUARED_ANGLE

#: Points in the coordinates of a plane [m].
_InPlane = Float[np.ndarray, "n 2"]


@dataclass(frozen=True, eq=False)
class _Patch:
    """Places with one normal in one plane, and the corners of their convex hull, counter-clockwise."""

    normal: Vector3
    touches: tuple[Touch, ...]
    axes: Float[np.ndarray, "2 3"]
    hull: Indices

    @property
    def corners(self) -> tuple[Touch, ...]:
        return tuple(self.touches[index] for index in self.hull)

    def excludes(self, point: Vector3, clause: Clause, gap: float, blur: float) -> bool:
        """Whether one of the normals is excluded at a point already."""
        if not any(np.linalg.norm(unit_normal(normal) - self.normal) <= SQUARED_ANGLE for normal in clause):
            return False
        if abs((point - self.touches[0].point) @ self.normal) > gap:
            return False
        ring = np.array([touch.point for touch in self.corners]) @ self.axes.T
        return _inside(self.axes @ point, ring, blur)


def essential(touches: Sequence[Touch], gap: float, blur: float) -> tuple[Touch, ...]:
    """The places of contact that do not follow from others, clauses in one point together.

    Args:
        gap: places whose planes differ by no more than this are in one plane [m].
        blur: points no further apart than this are one [m].
    """
    single, optional = [], []
    for touch in touches:
        for clause in touch.clauses:
            (single if len(clause) == 1 else optional).append(replace(touch, clauses=(clause,)))
    patches = [_patch(members, blur) for members in _planes(single, gap)]
    kept: list[Touch] = [touch for patch in patches for touch in patch.corners]
    # ends of segments first: what they say about a point comes with its twin
    for touch in sorted(optional, key=lambda touch: touch.twin is None):
        (clause,) = touch.clauses
        ends = [touch.point] if touch.twin is None else [touch.point, touch.twin]
        if any(all(patch.excludes(end, clause, gap, blur) for end in ends) for patch in patches):
            continue
        if not any(_says_as_much(other, touch, blur) for other in kept):
            kept.append(touch)
    return _together(kept, blur)


def _says_as_much(known: Touch, touch: Touch, blur: float) -> bool:
    if np.linalg.norm(known.point - touch.point) > blur:
        return False
    if touch.twin is not None and (known.twin is None or np.linalg.norm(known.twin - touch.twin) > blur):
        return False
    return matching(known.clauses[0], touch.clauses[0], COPLANAR_ANGLE)


def _planes(touches: Sequence[Touch], gap: float) -> list[list[Touch]]:
    """Touches with a single normal, grouped by normal and plane."""
    groups: list[list[Touch]] = []
    keys: list[tuple[Vector3, float]] = []
    for touch in touches:
        normal = unit_normal(touch.clauses[0][0])
        height = float(touch.point @ normal)
        for group, (known, level) in zip(groups, keys, strict=True):
            if np.linalg.norm(normal - known) <= SQUARED_ANGLE and abs(float(touch.point @ known) - level) <= gap:
                group.append(touch)
                break
        else:
            groups.append([touch])
            keys.append((normal, height))
    return groups


def _patch(touches: Sequence[Touch], blur: float) -> _Patch:
    normal = unit_normal(touches[0].clauses[0][0])
    axes = np.array(tangents(normal))
    hull = _hull(np.array([touch.point for touch in touches]) @ axes.T, blur)
    return _Patch(normal, tuple(touches), axes, hull)


def _hull(points: _InPlane, blur: float) -> Indices:
    """The corners of the convex hull, counter-clockwise; points within ``blur`` of the hull of the rest are none."""
    import shapely

    outline = shapely.MultiPoint(points).convex_hull
    ring = list(shapely.get_coordinates(outline))
    if outline.geom_type == "Polygon":
        ring = shapely.get_coordinates(shapely.orient_polygons(outline))[:-1].tolist()
    corners = [int(np.linalg.norm(points - corner, axis=1).argmin()) for corner in ring]
    place = 0
    # each corner is looked at again where one of its neighbours went
    while len(corners) > 1 and place < len(corners):
        before, after = points[corners[place - 1]], points[corners[(place + 1) % len(corners)]]
        if _off_segment(points[corners[place]], before, after) <= blur:
            del corners[place]
            place = max(place - 1, 0)
        else:
            place += 1
    return np.array(corners, dtype=np.int64)


def _off_segment(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    """Distance of a point from a segment [m]."""
    along = end - start
    size = float(along @ along)
    share = min(max(float((point - start) @ along) / size, 0.0), 1.0) if size > 0 else 0.0
    return float(np.linalg.norm(point - start - share * along))


def _left_of(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    """How far a point lies to the left of the line from start to end [m]; 0 if these are one."""
    along, away = end - start, point - start
    length = float(np.linalg.norm(along))
    return float(along[0] * away[1] - along[1] * away[0]) / length if length > 0 else 0.0


def _inside(point: np.ndarray, ring: _InPlane, blur: float) -> bool:
    """Whether a point lies in a convex ring of corners (or on a segment, or in a point)."""
    if len(ring) == 1:
        return bool(np.linalg.norm(point - ring[0]) <= blur)
    ends = np.roll(ring, -1, axis=0)
    sides = [_left_of(point, start, end) >= -blur for start, end in zip(ring, ends, strict=True)]
    if len(ring) > 2:
        return all(sides)
    along = ring[1] - ring[0]
    length = float(np.linalg.norm(along))
    place = float((point - ring[0]) @ along) / length
    return all(sides) and -blur <= place <= length + blur


def _together(touches: Sequence[Touch], blur: float) -> tuple[Touch, ...]:
    """Clauses in one point as one AND, ends of segments apart."""
    merged: list[Touch] = []
    for touch in touches:
        for index, known in enumerate(merged):
            if touch.twin is known.twin is None and np.linalg.norm(known.point - touch.point) <= blur:
                merged[index] = _with_clause(known, touch)
                break
        else:
            merged.append(touch)
    return tuple(merged)


def _with_clause(known: Touch, touch: Touch) -> Touch:
    (clause,) = touch.clauses
    if any(matching(clause, other, COPLANAR_ANGLE) for other in known.clauses):
        return known
    first, second = known.provenance, touch.provenance
    worse = first if first.normal_error >= second.normal_error else second
    return replace(known, clauses=(*known.clauses, clause), provenance=worse)
