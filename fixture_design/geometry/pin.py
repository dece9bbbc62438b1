"""A pin in a hole or slot: which walls it touches at nominal, all around.

A contact on the wall of a round hole, at x = p + R e with p on the axis, has the normal -e and the row [-e; p X -e]:
the radius drops out. All rows around the hole thus lie in one plane and fill it, and so do the four of two crossed
diameters: four contacts stand for all of them exactly. An arc of wall fills the sector between its ends, which contacts
at its ends and no more than a right angle apart span. With friction the places matter, and these few are taken.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point, cross_products
from fixture_design.contacts import Provenance, tangents
from fixture_design.errors import GeometryError, format_length
from fixture_design.geometry.local import plane_slips
from fixture_design.geometry.nearest import distances
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.sets import place_text
from fixture_design.geometry.shapes import Vector3
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.geometry.tip_touch import TipTouch
from fixture_design.layout import PinTip
from fixture_design.tolerances import ALONG_NORMAL, COPLANAR_ANGLE

#: Angle around a hole that may be missing from its wall before it counts as open there [rad].
_SEAM = 1e-3


def pin_touches(
    geometry: PartGeometry, p_PA: Point, tip: PinTip, axis: Vector3, along: Vector3 | None, gap: float
) -> tuple[TipTouch, ...]:
    """The contacts of a pin, each with the clearance: a round pin all around, a diamond pin at both ends of ``along``.

    Args:
        p_PA: on the pin's axis, in the hole [m].  axis: of the pin, in P.  along: of a diamond pin, in P.
        gap: what diameters and places may be off by [m].

    Raises:
        GeometryError: no hole or slot there, one of another diameter or direction, no wall where a diamond pin locates.
    """
    a = axis / np.linalg.norm(axis)
    u = None if along is None else _across(a, along)
    if geometry.surface.at(p_PA)[0] > 0:
        hole = _hole(geometry, p_PA, a, gap)
        if hole is not None:
            return _in_hole(geometry, hole, p_PA, tip, u, gap)
        walls = _slot(geometry, p_PA, a)
        if walls is not None:
            return _in_slot(geometry, walls, p_PA, tip, u, gap)
    raise GeometryError(
        f"there is no hole or slot of {geometry.name!r} around {place_text(p_PA)} (part frame) in the pin's direction",
        expected="`at` on the axis of a hole or in the middle of a slot, and `axis` along it",
    )


def _across(axis: Vector3, along: Vector3) -> Vector3:
    unit = along / np.linalg.norm(along)
    unit = unit - (unit @ axis) * axis
    if np.linalg.norm(unit) < ALONG_NORMAL:
        raise GeometryError("a diamond pin cannot locate along its own axis", expected="`along` across `axis`")
    return unit / np.linalg.norm(unit)


def _check_fit(tip: PinTip, found: float, name: str, gap: float) -> None:
    if abs(tip.diameter + tip.clearance - found) > gap:
        raise GeometryError(
            f"a pin of diameter {format_length(tip.diameter)} with clearance {format_length(tip.clearance)} does not "
            f"fit {name} of {format_length(round(found, 9))}",
            expected="diameter + clearance = the hole's, within `surface_gap`",
        )


def _hole(geometry: PartGeometry, p_PA: Point, axis: Vector3, gap: float) -> SmoothSurface | None:
    """The hollow cylinder around a point: its axis goes through it, and its wall is at the point's height."""
    for surface in geometry.smooth_surfaces:
        if surface.kind != "cylinder" or not surface.hollow:
            continue
        away = p_PA - surface.point
        off = float(np.linalg.norm(away - (away @ surface.axis) * surface.axis))
        if off > gap + surface.error:
            continue
        heights = (_corners(geometry, surface.facets) - p_PA) @ surface.axis
        turned = float(np.linalg.norm(cross_products(axis, surface.axis)) * np.ptp(heights))
        if turned <= gap + surface.error and heights.min() - gap <= 0 <= heights.max() + gap:
            return surface
    return None


def _corners(geometry: PartGeometry, facets: np.ndarray) -> np.ndarray:
    triangles = np.concatenate([geometry.facets[facet].triangles for facet in facets])
    return geometry.vertices[geometry.triangles[triangles].ravel()]


def _in_hole(
    geometry: PartGeometry, hole: SmoothSurface, p_PA: Point, tip: PinTip, along: Vector3 | None, gap: float
) -> tuple[TipTouch, ...]:
    _check_fit(tip, 2 * hole.radius, hole.name, gap + 2 * hole.error)
    center = hole.point + ((p_PA - hole.point) @ hole.axis) * hole.axis
    x, y = tangents(hole.axis)
    arcs = _arcs(geometry, hole, p_PA, x, y)
    if not arcs:
        place = place_text(p_PA)
        raise GeometryError(f"{hole.name} has no wall at the height of the pin at {place} (part frame)")
    whole = sum(end - start for start, end in arcs) > 2 * np.pi - _SEAM
    if along is not None:
        angle = float(np.arctan2(along @ y, along @ x))
        angles = np.array([angle, angle + np.pi])
        if not whole and not all(any(_within(a, arc) for arc in arcs) for a in angles.tolist()):
            raise GeometryError(f"a diamond pin in {hole.name} has no wall at both ends of `along`")
    elif whole:
        angles = np.arange(4) * np.pi / 2
    else:
        angles = np.concatenate(
            [
                np.linspace(start, end, 1 + max(1, int(np.ceil((end - start) / (np.pi / 2) - _SEAM))))
                for start, end in arcs
            ]
        )
    provenance = geometry.provenance_of(int(hole.facets[0]))
    # exact zeros on the axes of the coordinates: cos(pi / 2) is not one
    directions = np.round(np.cos(angles), 15)[:, None] * x + np.round(np.sin(angles), 15)[:, None] * y
    return tuple(
        TipTouch(
            center + hole.radius * e, ((-e,),), provenance, hole.name, clearance=tip.clearance, slips=(hole.slips(),)
        )
        for e in directions
    )


def has_wall_all_around(geometry: PartGeometry, hole: SmoothSurface, p_PA: Point) -> bool:
    """Whether a hollow cylinder is closed at the height of a point on its axis."""
    arcs = _arcs(geometry, hole, p_PA, *tangents(hole.axis))
    return sum(end - start for start, end in arcs) > 2 * np.pi - _SEAM


def _within(angle: float, arc: tuple[float, float]) -> bool:
    return (angle - arc[0] + _SEAM) % (2 * np.pi) <= arc[1] - arc[0] + 2 * _SEAM


def _arcs(
    geometry: PartGeometry, hole: SmoothSurface, p_PA: Point, x: Vector3, y: Vector3
) -> list[tuple[float, float]]:
    """Where there is wall at the point's height, as angles from and to, counter-clockwise [rad]."""
    away = _corners(geometry, hole.facets) - p_PA
    counts = np.array([3 * len(geometry.facets[facet].triangles) for facet in hole.facets])
    firsts = np.cumsum(counts) - counts
    heights = away @ hole.axis
    low, high = np.minimum.reduceat(heights, firsts), np.maximum.reduceat(heights, firsts)
    here = (low <= geometry.on_edge) & (high >= -geometry.on_edge)
    middles = np.add.reduceat(away, firsts) / counts[:, None]
    starts = np.arctan2(middles @ y, middles @ x)
    turns = np.angle(((away @ x) + 1j * (away @ y)) * np.exp(-1j * np.repeat(starts, counts)))
    lows, highs = starts + np.minimum.reduceat(turns, firsts), starts + np.maximum.reduceat(turns, firsts)
    joined: list[tuple[float, float]] = []
    for start, end in sorted(zip(lows[here].tolist(), highs[here].tolist(), strict=True)):
        if joined and start <= joined[-1][1] + _SEAM:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((start, end))
    if len(joined) > 1 and joined[0][0] + 2 * np.pi <= joined[-1][1] + _SEAM:
        first = joined.pop(0)
        joined[-1] = (joined[-1][0], max(first[1] + 2 * np.pi, joined[-1][1]))
    return joined


def _slot(geometry: PartGeometry, p_PA: Point, axis: Vector3) -> tuple[int, int] | None:
    """The two flat walls on both sides of a point that face each other, along the axis; the nearest ones."""
    normals = np.array([facet.normal for facet in geometry.facets])
    units = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    heights = np.einsum("ij,ij->i", p_PA - np.array([facet.centroid for facet in geometry.facets]), units)
    upright = np.flatnonzero((np.abs(units @ axis) <= COPLANAR_ANGLE) & (heights > 0))
    seen = [
        facet
        for facet in upright[np.argsort(heights[upright])].tolist()
        if geometry.provenance_of(facet).kind == "exact" and _has(geometry, facet, p_PA - heights[facet] * units[facet])
    ]
    for index, first in enumerate(seen):
        for second in seen[index + 1 :]:
            if np.linalg.norm(units[first] + units[second]) <= COPLANAR_ANGLE:
                return first, second
    return None


def _has(geometry: PartGeometry, facet: int, p_PQ: Point) -> bool:
    """Whether a point lies on a facet."""
    corners = geometry.vertices[geometry.triangles[geometry.facets[facet].triangles]]
    return float(distances(corners, p_PQ).min()) <= geometry.on_edge


def _in_slot(
    geometry: PartGeometry, walls: tuple[int, int], p_PA: Point, tip: PinTip, along: Vector3 | None, gap: float
) -> tuple[TipTouch, ...]:
    facets = [geometry.facets[wall] for wall in walls]
    name = " | ".join(facet.name for facet in facets)
    units = [facet.normal / np.linalg.norm(facet.normal) for facet in facets]
    heights = [float((p_PA - facet.centroid) @ unit) for facet, unit in zip(facets, units, strict=True)]
    _check_fit(tip, sum(heights), f"the slot {name}", gap)
    if abs(heights[0] - heights[1]) / 2 > gap:
        off = format_length(round(abs(heights[0] - heights[1]) / 2, 9))
        raise GeometryError(f"a pin is {off} off the middle of the slot {name}", expected="`at` in its middle")
    if along is not None and np.linalg.norm(cross_products(along, units[0])) > ALONG_NORMAL:
        raise GeometryError(f"a diamond pin in the slot {name} has no wall at both ends of `along`")
    origins = [geometry.provenance_of(wall) for wall in walls]
    provenance = Provenance("exact", max(origin.normal_error for origin in origins))
    return tuple(
        TipTouch(
            p_PA - height * unit,
            ((facet.normal,),),
            provenance,
            facet.name,
            clearance=tip.clearance,
            slips=(plane_slips(facet.normal, p_PA - height * unit),),
        )
        for facet, unit, height in zip(facets, units, heights, strict=True)
    )
