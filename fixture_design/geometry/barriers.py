"""What stands around a part while it is loaded: tips and bodies as shapes, in the part's frame.

A tip has no stem. A point (soft tips too) is a point, a ball a ball. A pad is a plate as wide and high as the pad, a
line an edge as long as the line; both are a few times as thick as the surfaces are known, outward from the part, so
that they have columns from every side. A pin is a prism of its diameter that reaches half of it up and down from the
point given on its axis, less where there is no room; how long it is, is not known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Points, cross_products
from fixture_design.contacts import STANDING, Contact, Role, tangents, unit_normal
from fixture_design.geometry.bodies import placed_geometry
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Triangles, Vector3
from fixture_design.layout import Element, Layout, LineTip, PadTip, PinTip, Pose, SphereTip, element_name

#: Thickness of pads and lines in surface gaps [-].
_THICK = 6.0
#: Sides of a pin; its corners are on its circle.
_SIDES = 48
#: How often a pin is cut to half before it is taken as it is.
_CUTS = 5
#: A pin that is deeper in the part than its middle by this factor pokes into something [-].
_POKES = 1.5


@dataclass(frozen=True, eq=False)
class PointBarrier:
    """A point.

    Attributes:
        depth: how far inside the part it is at the start [m].
        measured: whether the part's surface was found there, so that the depth is that of its facets; a contact that
            was given outright may be anywhere.
    """

    name: str
    point: Vector3
    depth: float
    measured: bool = True


@dataclass(frozen=True, eq=False)
class BallBarrier:
    """A ball of ``radius`` around ``center``; ``depth``: how far inside the part it reaches at the start [m]."""

    name: str
    center: Vector3
    radius: float
    depth: float


@dataclass(frozen=True, eq=False)
class SolidBarrier:
    """A closed surface.

    Attributes:
        depth: how far inside the part it is at the start [m]; None for bodies, of which it is asked when needed.
        geometry: of a body.
        assumed: whether its size is a guess, so that it says nothing certain where it is in the way.
    """

    name: str
    corners: Corners
    depth: float | None
    geometry: PartGeometry | None = None
    assumed: bool = False


Barrier = PointBarrier | BallBarrier | SolidBarrier


def barriers_of(
    layout: Layout,
    geometry: PartGeometry,
    contacts: Sequence[Contact],
    gap: float,
    roles: Sequence[Role] = STANDING,
) -> tuple[Barrier, ...]:
    """Everything of a spatial layout that has one of these roles, in P.

    Args:
        geometry: of the part.  contacts: all that the layout has, in W.
        gap: how well surfaces are known, > 0 [m].

    Raises:
        InputError: a body's file cannot be used.
    """
    if layout.part is None:
        return ()
    X_WP, found = layout.part.pose, list[Barrier]()
    for element in layout.elements:
        mine = [contact for contact in contacts if element_name(contact.name) == element.name]
        if element.role in roles and mine:
            found.append(_of_element(element, mine, geometry, X_WP, gap))
    found += [_of_point(contact.name, contact, geometry, X_WP) for contact in layout.contacts
              if contact.role in roles]  # fmt: skip
    for body in layout.bodies:
        if body.role in roles:
            placed = placed_geometry(body, X_WP)
            found.append(SolidBarrier(body.name, placed.vertices[placed.triangles], None, placed))
    return tuple(found)


def _of_element(
    element: Element, contacts: Sequence[Contact], geometry: PartGeometry, X_WP: Pose, gap: float
) -> Barrier:
    X_PW, tip = X_WP.inverse(), element.tip
    at = X_PW.points(np.asarray(element.at, dtype=np.float64)[None])[0]
    touched = X_PW.points(contacts[0].point[None])[0]
    # where normals meet, their mean looks out of the corner
    normal = unit_normal(X_PW.vectors(np.array([unit_normal(n) for n in contacts[0].normals])).sum(axis=0))
    match tip:
        case SphereTip():
            center = touched + tip.radius * normal
            depth = max(0.0, tip.radius - geometry.surface.at(center)[0])
            return BallBarrier(element.name, center, tip.radius, depth)
        case PadTip() | LineTip():
            middle = at - ((at - touched) @ normal) * normal
            along = X_PW.vectors(np.asarray(tip.along, dtype=np.float64)[None])[0]
            along = unit_normal(along - (along @ normal) * normal)
            across, out = cross_products(normal, along), _THICK * gap * normal
            if isinstance(tip, PadTip):
                return _solid(element.name, geometry, _plate(middle, along * tip.width, across * tip.height, out), gap)
            return _solid(element.name, geometry, _edge(middle, along * tip.length, across * _THICK * gap, out), gap)
        case PinTip():
            axis = np.array([0.0, 0.0, 1.0]) if element.axis is None else np.asarray(element.axis, dtype=np.float64)
            return _pin(element.name, geometry, at, unit_normal(X_PW.vectors(axis[None])[0]), tip.diameter / 2, gap)
        case _:
            return _of_point(element.name, contacts[0], geometry, X_WP)


def _of_point(name: str, contact: Contact, geometry: PartGeometry, X_WP: Pose) -> PointBarrier:
    point = X_WP.inverse().points(contact.point[None])[0]
    depth = max(0.0, -geometry.surface.at(point)[0])
    return PointBarrier(name, point, depth, contact.distance is not None)


def _solid(name: str, geometry: PartGeometry, shape: tuple[Points, Triangles, int], gap: float) -> SolidBarrier:
    """A tip's shape; the number says how many of its first points lie on the part.

    Where the others are inside the part, it has less room than the thickness assumed.
    """
    points, triangles, here = shape
    depths = -geometry.surface.distances(points)
    return SolidBarrier(name, points[triangles], max(0.0, float(depths[:here].max())), assumed=bool(depths.max() > gap))


def _plate(middle: Point, width: Point, height: Point, out: Point) -> tuple[Points, Triangles, int]:
    ring = np.array([-width - height, width - height, width + height, height - width]) / 2
    return (*_prism(middle + ring, out), 4)


def _edge(middle: Point, length: Point, width: Point, out: Point) -> tuple[Points, Triangles, int]:
    """A bar with a triangle as its section, one edge of which lies on the part."""
    section = np.array([np.zeros(3), out + width / 2, out - width / 2])
    points, triangles = _prism(middle - length / 2 + section, length)
    # the two ends of the edge come first
    order = np.array([0, 3, 1, 2, 4, 5])
    return points[order], np.argsort(order)[triangles], 2


def _prism(ring: Points, along: Point) -> tuple[Points, Triangles]:
    """A prism over a convex ring, its triangles turned outward."""
    count = len(ring)
    points = np.vstack([ring, ring + along])
    ends = [(0, k + 1, k) for k in range(1, count - 1)]
    ends += [(count, count + k, count + k + 1) for k in range(1, count - 1)]
    walls = []
    for k in range(count):
        following = (k + 1) % count
        walls += [(k, following, following + count), (k, following + count, k + count)]
    triangles = np.array(ends + walls)
    corners = points[triangles] - points.mean(axis=0)
    volume = float(np.einsum("ij,ij->", corners[:, 0], cross_products(corners[:, 1], corners[:, 2])))
    return points, triangles if volume > 0 else triangles[:, ::-1]


def _pin(name: str, geometry: PartGeometry, at: Point, axis: Vector3, radius: float, gap: float) -> SolidBarrier:
    first, second = tangents(axis)
    angles = 2 * np.pi * np.arange(_SIDES) / _SIDES
    ring = at + radius * (np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second)
    middle = max(0.0, -float(geometry.surface.distances(ring).min()))
    half, depth = radius, np.inf
    for _ in range(_CUTS):
        ends = np.vstack([ring - half * axis, ring + half * axis])
        depth = max(middle, -float(geometry.surface.distances(ends).min()))
        if depth <= _POKES * middle + gap:
            break
        half /= 2
    points, triangles = _prism(ring - half * axis, 2 * half * axis)
    return SolidBarrier(name, points[triangles], depth, assumed=True)
