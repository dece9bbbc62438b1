"""From an element that should touch the part to the contact it makes: where, with which normals, how well known."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Contact
from fixture_design.errors import DimensionError, GeometryError, InputError, OffSurfaceError, UnsupportedError
from fixture_design.geometry.ball import ball_normal, check_room
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.polygon import Polygon, polygon_of
from fixture_design.geometry.surface import SolidSurface, Surface
from fixture_design.layout import Element, Part, PointTip, Pose, SphereTip


def contact_of(
    element: Element,
    geometry: PartGeometry,
    X_WP: Pose,
    friction: float,
    surface_gap: float,
    part_name: str | None = None,
) -> Contact:
    """The contact between an element and a solid part, in W, at the surface point nearest to ``element.at``.

    A point tip takes the logic of the place: one normal on a facet, the OR of a convex edge, the AND of a concave one.
    A ball takes one normal, and needs room.

    Args:
        friction: the layout's; the element's own comes first.
        surface_gap: largest distance between ``at`` and the surface [m].
        part_name: for messages, by default the geometry's.

    Raises:
        OffSurfaceError: ``at`` is further from the surface than the gap.
        UnsupportedError: other tips than points and balls; see `local_surface`.
        GeometryError: a ball where there is no room for it, a radius that is not positive.
        DimensionError: ``at`` has not three coordinates.
    """
    return _contact(element, SolidSurface(geometry), X_WP, friction, surface_gap, part_name or geometry.name)


def polygon_contact(
    element: Element, part: Part, friction: float, surface_gap: float, polygon: Polygon | None = None
) -> Contact:
    """The contact between an element and a planar part, in W, placed at ``part.pose``; the rest as in `contact_of`.

    Args:
        polygon: of the part, where it is checked already.

    Raises:
        GeometryError: also for a polygon that is none, see `polygon_of`.
    """
    polygon = polygon or polygon_of(part)
    return _contact(element, polygon, part.pose, friction, surface_gap, part.name)


def _contact(element: Element, surface: Surface, X_WP: Pose, friction: float, gap: float, part_name: str) -> Contact:
    radius = _radius(element)
    p_PA = X_WP.inverse().points(_checked(element, len(X_WP.translation))[None])[0]
    distance, p_PC = surface.nearest(p_PA)
    if abs(distance) > gap:
        raise OffSurfaceError(element.name, part_name, distance, surface.feature(p_PC), gap)
    try:
        local = surface.local(p_PC)
        clauses, provenance = local.clauses, local.provenance
        if radius is not None:
            normal, provenance = ball_normal(surface, local, p_PA, p_PC)
            check_room(surface, local, p_PC, normal, radius, gap)
            clauses = ((normal,),)
    except InputError as error:
        error.place = error.place or f"element {element.name!r}"
        raise
    return Contact(
        element.name,
        element.role,
        X_WP.points(p_PC[None])[0],
        tuple(tuple(X_WP.vectors(np.array(clause))) for clause in clauses),
        friction if element.friction is None else element.friction,
        provenance,
        distance,
        local.feature,
    )


def _radius(element: Element) -> float | None:
    """Of a ball; None for a point."""
    if isinstance(element.tip, PointTip):
        return None
    if not isinstance(element.tip, SphereTip):
        kind = type(element.tip).__name__.removesuffix("Tip").lower()
        raise UnsupportedError(
            f"element {element.name!r}: this version does not evaluate {kind} tips", expected="a point or sphere tip"
        )
    if not (np.isfinite(element.tip.radius) and element.tip.radius > 0):
        raise GeometryError(
            f"element {element.name!r}: a ball needs a radius > 0", found=str(element.tip.radius), expected="metres"
        )
    return element.tip.radius


def _checked(element: Element, plane: int) -> Point:
    at = np.asarray(element.at, dtype=np.float64)
    if at.shape != (plane,):
        raise DimensionError(f"element {element.name!r}: `at` needs {plane} coordinates", found=str(at.tolist()))
    if not np.isfinite(at).all():
        raise GeometryError(f"element {element.name!r}: `at` is not finite", found=str(at.tolist()))
    return at
