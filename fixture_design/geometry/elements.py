"""The contacts of all elements of a layout, with what a verdict needs to know of the part."""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.arrays import Point
from fixture_design.contacts import Contact
from fixture_design.errors import InputError
from fixture_design.geometry.bodies import contacts_of_bodies
from fixture_design.geometry.contact import contact_of, polygon_contact
from fixture_design.geometry.load import load_part
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.polygon import Polygon, polygon_of
from fixture_design.layout import Element, Layout, Part


@dataclass(frozen=True, eq=False)
class GeometryContacts:
    """What geometry has to say about a layout.

    Attributes:
        contacts: of the elements in their order, then of the bodies.
        notes: about the part and the bodies, for people.
        box_center: centre of the part's bounding box (taken in its own frame P), in W [m].
        half_diagonal: of that box [m]: the length that makes margins dimensionless, however the part is placed.
    """

    contacts: tuple[Contact, ...]
    notes: tuple[str, ...]
    box_center: Point
    half_diagonal: float


def load_geometry(part: Part) -> PartGeometry | Polygon:
    """The geometry of a part of either kind, to be handed to `contacts_of_elements` again and again."""
    return polygon_of(part) if part.kind == "polygon" else load_part(part)


def contacts_of_elements(layout: Layout, geometry: PartGeometry | Polygon | None = None) -> GeometryContacts:
    """The contacts of a layout's elements and bodies with its part.

    Args:
        geometry: of ``layout.part``, where it is loaded already; a batch of layouts loads its part once.

    Raises:
        InputError: elements without a part; a part that does not fit the layout's space; see `contact_of`.
    """
    part = layout.part
    if part is None:
        raise InputError(
            "there are elements or bodies but no part for them to touch", source=layout.source, expected="part: ..."
        )
    if (part.kind == "polygon") != (layout.space == "planar"):
        problem = f"part {part.name!r} does not fit a {layout.space} layout"
        raise InputError(problem, source=layout.source, found=f"kind {part.kind!r}")
    geometry = geometry or load_geometry(part)
    try:
        contacts = tuple(_contact(element, layout, part, geometry) for element in layout.elements)
        of_bodies, notes = contacts_of_bodies(layout, geometry)
    except InputError as error:
        if layout.source:
            error.within(layout.source)
        raise
    center = part.pose.points(geometry.box_center[None])[0]
    return GeometryContacts((*contacts, *of_bodies), (*geometry.notes, *notes), center, geometry.half_diagonal)


def _contact(element: Element, layout: Layout, part: Part, geometry: PartGeometry | Polygon) -> Contact:
    if isinstance(geometry, Polygon):
        return polygon_contact(element, part, layout.friction, layout.surface_gap, geometry)
    return contact_of(element, geometry, part.pose, layout.friction, layout.surface_gap, part.name)
