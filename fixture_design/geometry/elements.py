"""The contacts of all elements of a layout, with what a verdict needs to know of the part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Contact
from fixture_design.errors import GeometryError, InputError, UnsupportedError, format_length, looking_at
from fixture_design.geometry.bodies import contacts_of_bodies
from fixture_design.geometry.contact import contacts_on
from fixture_design.geometry.load import load_part
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.polygon import Polygon, polygon_of
from fixture_design.geometry.surface import SolidSurface, Surface
from fixture_design.layout import Element, Layout, Part, PinTip, Pose


@dataclass(frozen=True, eq=False)
class GeometryContacts:
    """What geometry has to say about a layout.

    Attributes:
        contacts: of the elements in their order, then of the bodies.
        notes: about the part and the bodies, for people.
        box_center: centre of the part's bounding box (taken in its own frame P), in W [m].
        half_diagonal: of that box [m]: the length that makes margins dimensionless, however the part is placed.
        geometry: of the part.
    """

    contacts: tuple[Contact, ...]
    notes: tuple[str, ...]
    box_center: Point
    half_diagonal: float
    geometry: PartGeometry | Polygon


def load_geometry(part: Part) -> PartGeometry | Polygon:
    """The geometry of a part of either kind, to be handed to `contacts_of_elements` again and again."""
    return polygon_of(part) if part.kind == "polygon" else load_part(part)


def contacts_of_elements(layout: Layout, geometry: PartGeometry | Polygon | None = None) -> GeometryContacts:
    """The contacts of a layout's elements and bodies with its part.

    Args:
        geometry: of ``layout.part``, where it is loaded already; a batch of layouts loads its part once.

    Raises:
        InputError: elements without a part; a part that does not fit the layout's space; a `surface_gap` as large as
            the part; see `contacts_of_element`.
    """
    part = layout.part
    if part is None:
        place = layout.places.get(("elements", layout.elements[0].name)) if layout.elements else None
        problem = f"there are {'elements' if layout.elements else 'bodies'} but no part for them to touch"
        raise InputError(problem, source=layout.source, place=place, expected="part: ...")
    if (part.kind == "polygon") != (layout.space == "planar"):
        problem = f"part {part.name!r} does not fit a {layout.space} layout"
        raise InputError(problem, source=layout.source, place=layout.places.get(("part",)), found=f"kind {part.kind!r}")
    with looking_at(layout.source, layout.places.get(("part",))):
        geometry = geometry or load_geometry(part)
    if layout.surface_gap > geometry.half_diagonal:
        gap, half = format_length(layout.surface_gap), format_length(geometry.half_diagonal)
        problem = f"`surface_gap` is {gap}, and the part {part.name!r} is only {half} from its middle to its corners"
        raise InputError(problem, source=layout.source, expected="a small part of that: what touches is this near")
    surface = geometry if isinstance(geometry, Polygon) else _surface_near(layout.elements, geometry, part.pose)
    contacts = tuple(c for element in layout.elements for c in _contacts(element, layout, part, surface))
    of_bodies, notes = contacts_of_bodies(layout, geometry)
    center = part.pose.points(geometry.box_center[None])[0]
    return GeometryContacts(
        (*contacts, *of_bodies), (*geometry.notes, *notes), center, geometry.half_diagonal, geometry
    )


def contacts_one_by_one(
    elements: Sequence[Element], part: Part, geometry: PartGeometry | Polygon, surface_gap: float
) -> list[tuple[Contact, ...]]:
    """The contacts of elements that are tried, without friction: of each alone, none where it cannot stand.

    Why it cannot is not told: there are thousands to choose from.
    """
    surface = geometry if isinstance(geometry, Polygon) else _surface_near(elements, geometry, part.pose)
    found: list[tuple[Contact, ...]] = []
    for element in elements:
        try:
            found.append(contacts_on(element, surface, part.pose, 0.0, surface_gap, part.name))
        except (GeometryError, UnsupportedError):
            found.append(())
    return found


def _surface_near(elements: Sequence[Element], geometry: PartGeometry, X_WP: Pose) -> SolidSurface:
    """The part's surface, looked at where its elements should touch; points that are none are left to `contacts_on`.

    Pins are in the middle of holes, and touch around them.
    """
    asked = [np.asarray(element.at) for element in elements if not isinstance(element.tip, PinTip)]
    places = [at for at in asked if at.shape == (3,) and np.isfinite(at).all()]
    return SolidSurface.near(geometry, X_WP.inverse().points(np.array(places, dtype=np.float64).reshape(-1, 3)))


def _contacts(element: Element, layout: Layout, part: Part, surface: Surface) -> tuple[Contact, ...]:
    with looking_at(layout.source, layout.places.get(("elements", element.name))):
        return contacts_on(element, surface, part.pose, layout.friction, layout.surface_gap, part.name)
