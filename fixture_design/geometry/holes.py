"""Round holes and slots with round ends that a part has: where pins could locate it.

A hole is a hollow cylinder with wall all around. A slot is two plane walls that face each other, with a hollow half
cylinder as wide as they are apart between them: its axis is that of a pin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.pin import has_wall_all_around
from fixture_design.geometry.shapes import Vector3
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.layout import Pose
from fixture_design.tolerances import COPLANAR_ANGLE

#: Middles of walls are looked for this far along a slot from its round end, in radii [-].
_ALONG = 1.0


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole or slot, in W.

    Attributes:
        feature: its surface.
        low, high: the ends of its axis; of a slot of one along its middle [m].
        diameter: or width [m].
        across: of a slot the direction from wall to wall, of length 1; None for a round hole.
    """

    feature: str
    low: Point
    high: Point
    diameter: float
    across: Point | None = None


def holes_of(geometry: PartGeometry, X_WP: Pose) -> tuple[Hole, ...]:
    """The holes, and the slots once for each of their round ends, in the order of their surfaces."""
    found: list[Hole] = []
    for surface in geometry.smooth_surfaces:
        if surface.kind != "cylinder" or not surface.hollow:
            continue
        low, high = _ends(geometry, surface)
        if has_wall_all_around(geometry, surface, (low + high) / 2):
            found.append(_hole(X_WP, surface, low, high, None))
        elif (slot := _slot(geometry, surface)) is not None:
            across, step = slot
            found.append(_hole(X_WP, surface, low + step, high + step, across))
    return tuple(found)


def _hole(X_WP: Pose, surface: SmoothSurface, low: Point, high: Point, across: Vector3 | None) -> Hole:
    ends = X_WP.points(np.array([low, high]))
    seen = None if across is None else X_WP.vectors(across[None])[0]
    return Hole(surface.name, ends[0], ends[1], 2 * surface.radius, seen)


def _ends(geometry: PartGeometry, surface: SmoothSurface) -> tuple[Point, Point]:
    """Where the wall begins and ends along the axis."""
    triangles = np.concatenate([geometry.facets[facet].triangles for facet in surface.facets])
    corners = geometry.vertices[geometry.triangles[triangles].ravel()]
    heights = (corners - surface.point) @ surface.axis
    return surface.point + heights.min() * surface.axis, surface.point + heights.max() * surface.axis


def _slot(geometry: PartGeometry, surface: SmoothSurface) -> tuple[Vector3, Vector3] | None:
    """Of a round end the direction across the slot, and the step from its axis to between the walls."""
    units, reach = geometry.facet_units, geometry.on_edge + 2 * surface.error
    middles = np.array([facet.centroid for facet in geometry.facets])
    heights = np.einsum("ij,ij->i", surface.point - middles, units)
    walls = np.flatnonzero(
        (np.abs(units @ surface.axis) <= COPLANAR_ANGLE)
        & (np.abs(heights - surface.radius) <= reach + COPLANAR_ANGLE * surface.radius)
        & ~np.isin(np.arange(len(units)), surface.facets)
    )
    for index, first in enumerate(walls.tolist()):
        for second in walls[index + 1 :].tolist():
            if np.linalg.norm(units[first] + units[second]) <= COPLANAR_ANGLE:
                away = middles[first] - surface.point
                way = away - (away @ surface.axis) * surface.axis - (away @ units[first]) * units[first]
                length = float(np.linalg.norm(way))
                if length > reach:
                    return units[first], way * min(1.0, _ALONG * surface.radius / length)
    return None
