"""Contacts: the point, an arrow along the push on the part for each normal (-n), and the friction cone about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Layout, element_name
from fixture_design.viewing.palette import BLACK, ROLE_COLORS, ROLE_INKS
from fixture_design.viewing.scene.drawn_sizes import ASIDE, CONE, DOT, NORMAL, THIN
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.shapes import Arrow, Cylinder, Sphere
from fixture_design.viewing.scene.space import lifted

_CONE_OPACITY = 0.3


def contact_things(layout: Layout, contacts: Sequence[Contact], size: float) -> Iterator[Thing | Label]:
    """A dot and arrows for every contact; a cone where there is friction; names of those that belong to no element.

    Args:
        size: half diagonal of the part [m].
    """
    owners = {*(element.name for element in layout.elements), *(body.name for body in layout.bodies)}
    for number, contact in enumerate(contacts):
        point, color = lifted(contact.point), ROLE_COLORS[contact.role]
        yield Thing(f"contacts/{number}/point", Sphere(point, DOT * size), BLACK)
        for k, normal in enumerate(contact.normals):
            push = -lifted(unit_normal(normal))
            yield Thing(f"normals/{number}/{k}", Arrow(point, point + NORMAL * size * push, THIN * size), color)
            if contact.friction > 0:
                height = CONE * size / max(1.0, contact.friction)
                cone = Cylinder(point, point + height * push, 0.0, contact.friction * height)
                yield Thing(f"cones/{number}/{k}", cone, color, _CONE_OPACITY)
        if element_name(contact.name) not in owners:
            away = lifted(unit_normal(contact.normals[0]))
            yield Label(f"contacts/{number}", contact.name, point + 2 * ASIDE * size * away, ROLE_INKS[contact.role])
