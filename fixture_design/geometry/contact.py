"""From an element that should touch the part to the contacts it makes: where, with which normals, how well known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite

import numpy as np

from fixture_design.arrays import Point, Rows, cross_products
from fixture_design.contacts import Contact, torsion_of_patch
from fixture_design.errors import DimensionError, GeometryError, InputError, OffSurfaceError, UnsupportedError
from fixture_design.geometry.ball import ball_normal, check_room
from fixture_design.geometry.line import line_touches
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.pad import pad_touches
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.pin import pin_touches
from fixture_design.geometry.planar_line import planar_line_touches
from fixture_design.geometry.polygon import Polygon, polygon_of
from fixture_design.geometry.surface import SolidSurface, Surface
from fixture_design.geometry.tip_touch import TipTouch
from fixture_design.layout import Element, LineTip, PadTip, Part, PinTip, PointTip, Pose, SoftTip, SphereTip

#: Decimals of a metre that count in the order of an element's contacts.
_ORDER_DECIMALS = 9


def contacts_of_element(
    element: Element,
    geometry: PartGeometry,
    X_WP: Pose,
    friction: float,
    surface_gap: float,
    part_name: str | None = None,
) -> tuple[Contact, ...]:
    """The contacts between an element and a solid part, in W, at the surface point nearest to ``element.at``.

    A point tip takes the logic of the place: one normal on a facet, the OR of a convex edge, the AND of a concave one;
    so does a soft tip, which on a single normal also resists turning about it. A ball takes one normal, and needs room.
    Pads, lines and pins touch in several points: `pad_touches`, `line_touches`, `pin_touches`; pins at no
    surface point, but around ``at`` on their axis.

    Args:
        friction: the layout's; the element's own comes first.
        surface_gap: largest distance between ``at`` and the surface [m].
        part_name: for messages, by default the geometry's.

    Returns:
        one contact with the element's name, or several named K1#1, K1#2, ... in the order of their coordinates in W.

    Raises:
        OffSurfaceError: ``at`` is further from the surface than the gap.
        UnsupportedError: pins of planar parts; see `local_surface`, `line_touches`.
        GeometryError: no room for the tip, a size that is not positive, a pad or line that does not lie flat.
        DimensionError: ``at`` or a direction has not three coordinates.
    """
    return contacts_on(element, SolidSurface(geometry), X_WP, friction, surface_gap, part_name or geometry.name)


def contact_of(
    element: Element,
    geometry: PartGeometry,
    X_WP: Pose,
    friction: float,
    surface_gap: float,
    part_name: str | None = None,
) -> Contact:
    """The one contact of an element whose tip touches in a point; arguments and errors as in `contacts_of_element`.

    Raises:
        UnsupportedError: a pad, line or pin, which may make several.
    """
    _check_single(element, "contacts_of_element")
    (contact,) = contacts_of_element(element, geometry, X_WP, friction, surface_gap, part_name)
    return contact


def polygon_contacts(
    element: Element, part: Part, friction: float, surface_gap: float, polygon: Polygon | None = None
) -> tuple[Contact, ...]:
    """The contacts between an element and a planar part, in W, placed at ``part.pose``; as `contacts_of_element`.

    In the plane a pad is a line as long as its width, and a soft tip is a point: there is no turning about a normal.

    Args:
        polygon: of the part, where it is checked already.

    Raises:
        GeometryError: also for a polygon that is none, see `polygon_of`.
    """
    polygon = polygon or polygon_of(part)
    return contacts_on(element, polygon, part.pose, friction, surface_gap, part.name)


def polygon_contact(
    element: Element, part: Part, friction: float, surface_gap: float, polygon: Polygon | None = None
) -> Contact:
    """The one contact of an element whose tip touches in a point; otherwise as `polygon_contacts`.

    Raises:
        UnsupportedError: a pad, line or pin, which may make several.
    """
    _check_single(element, "polygon_contacts")
    (contact,) = polygon_contacts(element, part, friction, surface_gap, polygon)
    return contact


def contacts_on(
    element: Element, surface: Surface, X_WP: Pose, friction: float, gap: float, part_name: str
) -> tuple[Contact, ...]:
    """The contacts between an element and a surface; arguments and errors as in `contacts_of_element`."""
    _check_sizes(element)
    dimension = len(X_WP.translation)
    p_PA = X_WP.inverse().points(_checked(element, element.at, "at", dimension)[None])[0]
    distance = None
    try:
        if isinstance(element.tip, PinTip):
            touches = _pin(element, element.tip, surface, X_WP, p_PA, gap)
        else:
            distance, p_PC = surface.nearest(p_PA)
            if abs(distance) > gap:
                raise OffSurfaceError(element.name, part_name, distance, surface.feature(p_PC), gap)
            local = surface.local(p_PC)
            touches = [_with_slips(t, local) for t in _touches(element, surface, local, X_WP, p_PA, p_PC, gap)]
    except OffSurfaceError:
        raise
    except InputError as error:
        error.place = error.place or f"element {element.name!r}"
        raise
    points = X_WP.points(np.array([touch.point for touch in touches]))
    order = np.lexsort(np.round(points, _ORDER_DECIMALS).T[::-1]).tolist() if len(points) > 1 else [0]
    return tuple(
        Contact(
            element.name if len(touches) == 1 else f"{element.name}#{number}",
            element.role,
            points[index],
            tuple(tuple(X_WP.vectors(np.array(clause))) for clause in touches[index].clauses),
            friction if element.friction is None else element.friction,
            touches[index].provenance,
            distance,
            touches[index].feature,
            touches[index].torsion,
            touches[index].clearance,
            slips=tuple(moved_with(X_WP, slips) for slips in touches[index].slips),
        )
        for number, index in enumerate(order, start=1)
    )


def _with_slips(touch: TipTouch, local: LocalSurface) -> TipTouch:
    """The touch with the motions of the surfaces there, if its normals are theirs."""
    if touch.slips:
        return touch
    mine = [normal for clause in touch.clauses for normal in clause]
    theirs = [normal for clause in local.clauses for normal in clause]
    same = len(mine) == len(theirs) and all(a is b or np.array_equal(a, b) for a, b in zip(mine, theirs, strict=True))
    return replace(touch, slips=local.slips) if same else touch


def moved_with(X_WP: Pose, motions: Rows) -> Rows:
    """Motions [v; w] about P's origin, one a row, about W's origin."""
    moved = np.empty_like(motions)
    moved[:, 3:] = X_WP.vectors(motions[:, 3:])
    moved[:, :3] = X_WP.vectors(motions[:, :3]) - cross_products(moved[:, 3:], X_WP.translation)
    return moved


def _touches(
    element: Element, surface: Surface, local: LocalSurface, X_WP: Pose, p_PA: Point, p_PC: Point, gap: float
) -> Sequence[TipTouch]:
    tip = element.tip
    if isinstance(tip, SphereTip):
        normal, provenance = ball_normal(surface, local, p_PA, p_PC)
        check_room(surface, local, p_PC, normal, tip.radius, gap)
        return (TipTouch(p_PC, ((normal,),), provenance, local.feature),)
    if isinstance(tip, PadTip | LineTip):
        along = X_WP.inverse().vectors(_checked(element, tip.along, "along", len(p_PC))[None])[0]
        if isinstance(surface, Polygon):
            length = tip.width if isinstance(tip, PadTip) else tip.length
            return planar_line_touches(surface, local, p_PC, length, along, gap)
        assert isinstance(surface, SolidSurface)
        if isinstance(tip, PadTip):
            return pad_touches(surface.geometry, local, p_PC, tip, along, gap)
        return line_touches(surface.geometry, local, p_PC, tip, along, gap)
    # where several normals meet, which of them turning would be about is open: none, to be safe
    flat = local.shape == "flat" and len(p_PC) == 3
    torsion = torsion_of_patch(tip.radius) if isinstance(tip, SoftTip) and flat else 0.0
    return (TipTouch(p_PC, local.clauses, local.provenance, local.feature, torsion, slips=local.slips),)


def _pin(element: Element, tip: PinTip, surface: Surface, X_WP: Pose, p_PA: Point, gap: float) -> Sequence[TipTouch]:
    if not isinstance(surface, SolidSurface):
        raise UnsupportedError("this version does not evaluate pin tips of planar parts", expected="point tips")
    if element.axis is None:
        raise GeometryError("a pin needs an axis", expected="axis: [x, y, z]")
    if tip.shape == "diamond" and tip.along is None:
        raise GeometryError("a diamond pin needs a direction", expected="along: [x, y, z]")
    to_part = X_WP.inverse().vectors
    axis = to_part(_checked(element, element.axis, "axis", 3)[None])[0]
    along = None
    if tip.shape == "diamond" and tip.along is not None:
        along = to_part(_checked(element, tip.along, "along", 3)[None])[0]
    return pin_touches(surface.geometry, p_PA, tip, axis, along, gap)


def _check_sizes(element: Element) -> None:
    tip = element.tip
    match tip:
        case PointTip():
            return
        case SphereTip():
            what, sizes = "a ball needs a radius", (tip.radius,)
        case SoftTip():
            what, sizes = "a soft tip needs a radius", (tip.radius,)
        case PadTip():
            what, sizes = "a pad needs a width and a height", (tip.width, tip.height)
        case LineTip():
            what, sizes = "a line needs a length", (tip.length,)
        case PinTip():
            what, sizes = "a pin needs a diameter", (tip.diameter,)
            if not (np.isfinite(tip.clearance) and tip.clearance >= 0):
                raise GeometryError(f"element {element.name!r}: a pin needs a clearance >= 0", found=str(tip.clearance))
    if not all(np.isfinite(size) and size > 0 for size in sizes):
        found = ", ".join(str(size) for size in sizes)
        raise GeometryError(f"element {element.name!r}: {what} > 0", found=found, expected="metres")


def _checked(element: Element, values: Point, key: str, dimension: int) -> Point:
    """A point of an element, or a direction of its at about length one, as an array of the right length."""
    found = np.asarray(values, dtype=np.float64)
    if found.shape != (dimension,):
        raise DimensionError(
            f"element {element.name!r}: `{key}` needs {dimension} coordinates", found=str(found.tolist())
        )
    if not all(map(isfinite, found.tolist())):
        raise GeometryError(f"element {element.name!r}: `{key}` is not finite", found=str(found.tolist()))
    if key != "at" and not found.any():
        raise GeometryError(f"element {element.name!r}: `{key}` has zero length", expected="a direction")
    # by a power of two, which rounds nothing: squares of 1e-200 are zero
    return found if key == "at" else np.ldexp(found, -int(np.frexp(np.abs(found).max())[1]))


def _check_single(element: Element, instead: str) -> None:
    if not isinstance(element.tip, PointTip | SphereTip | SoftTip):
        kind = type(element.tip).__name__.removesuffix("Tip").lower()
        raise UnsupportedError(
            f"element {element.name!r}: {kind} tips may make several contacts",
            expected=f"a point or sphere tip, or a soft one; or `{instead}`",
        )
