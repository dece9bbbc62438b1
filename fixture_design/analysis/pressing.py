"""What presses a part onto its locators: gravity, and clamps that push with given forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.analysis.acting import wrench_at
from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Element, Group, Layout, element_name
from fixture_design.tolerances import DEFAULT


def pressing_wrench(layout: Layout, group: Group, weight: Vector | None) -> Vector | None:
    """[f; m] about W's origin [N, N m], without friction; None where it is not known.

    Not known are clamps, fingers and supports whose force is not given or has no one line of action. Loads do not
    count: the part is seated before they act.

    Args:
        weight: the wrench of gravity, None where it is not known.
    """
    pushing = [contact for contact in group.contacts if contact.role != "locator"]
    clamps = _clamp_wrench(layout, pushing)
    if clamps is None:
        return None
    if not group.gravity or layout.gravity is None or not np.any(layout.gravity):
        return clamps if pushing else None
    return None if weight is None else clamps + weight


def weight_as_given(layout: Layout) -> Vector | None:
    """[f; m] of gravity from the mass and centre that the layout gives; None if it does not."""
    part = layout.part
    if part is None or part.center is None or part.mass is None or layout.gravity is None:
        return None
    return wrench_at(part.pose.points(part.center[None])[0], part.mass * layout.gravity)


def _clamp_wrench(layout: Layout, contacts: Sequence[Contact]) -> Vector | None:
    """The wrench of all contacts that push; zero without any."""
    elements = {element.name: element for element in layout.elements}
    plane = 2 if layout.space == "planar" else 3
    total = np.zeros(3 if plane == 2 else 6)
    by_element: dict[str, list[Contact]] = {}
    for contact in contacts:
        by_element.setdefault(element_name(contact.name), []).append(contact)
    for name, members in by_element.items():
        wrench = _push(elements.get(name), members)
        if wrench is None:
            return None
        total = total + wrench
    return total


def _push(element: Element | None, contacts: Sequence[Contact]) -> Vector | None:
    """Of one element with a preload and one point."""
    if element is None or element.role != "clamp" or element.preload is None:
        return None
    normals = [normal for contact in contacts for normal in contact.normals]
    # how a pad's force spreads over its corners is not known
    if len(normals) != 1 or contacts[0].provenance.normal_error > DEFAULT.zero:
        return None
    return wrench_at(contacts[0].point, -element.preload * unit_normal(normals[0]))
