"""Elements by role and tip: the tip where it touches, a stem out of the surface, a foot that tells the role."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.contacts import Contact, Role, tangents, unit_normal
from fixture_design.layout import (
    Element,
    Layout,
    LineTip,
    PadTip,
    PinTip,
    PointTip,
    SoftTip,
    SphereTip,
    element_name,
)
from fixture_design.viewing.palette import ROLE_COLORS, ROLE_INKS
from fixture_design.viewing.scene.drawn_sizes import ASIDE, FOOT, STEM, STEM_LENGTH
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.shapes import Box, Cylinder, Mesh, Points3, Shape, Sphere, Vector3
from fixture_design.viewing.scene.space import lifted

#: Stems are no thicker than this part of their tip; pins reach this many diameters out of and into their hole [-].
_OF_TIP, _PIN_OUT, _PIN_IN = 0.7, 1.6, 0.9

#: How far a diamond pin is relieved across `along` [-].
_RELIEVED = 0.45


@dataclass(frozen=True, eq=False)
class _Stand:
    """Where an element stands: its point on the surface, the direction away from the part, and the size of things."""

    point: Vector3
    away: Vector3
    size: float


def element_path(layout: Layout, name: str) -> str | None:
    """The path of all that is drawn of an element or body; None for contacts given outright."""
    for number, element in enumerate(layout.elements):
        if element.name == name:
            return f"elements/{element.role}/{number}"
    for number, body in enumerate(layout.bodies):
        if body.name == name:
            return f"bodies/{number}"
    return None


def element_things(layout: Layout, contacts: Sequence[Contact], size: float) -> Iterator[Thing | Label]:
    """Tip, stem and foot of every element, and its name at the foot.

    Args:
        contacts: of the layout; elements without any (which `verify` refuses) are left out.
        size: half diagonal of the part [m].
    """
    for number, element in enumerate(layout.elements):
        own = [contact for contact in contacts if element_name(contact.name) == element.name]
        if not own:
            continue
        stand = _stand(element, own, size)
        path = f"elements/{element.role}/{number}"
        color = ROLE_COLORS[element.role]
        tip, start, radius = _tip(element, stand)
        end = start + _length(radius, size) * stand.away
        shapes = [
            *tip,
            Cylinder(start, end, radius),
            _foot(element.role, end, stand.away, max(FOOT * size, 2 * radius)),
        ]
        for k, shape in enumerate(shapes):
            yield Thing(f"{path}/{k}", shape, color)
        yield Label(path, element.name, end + (ASIDE * size + radius) * stand.away, ROLE_INKS[element.role])


def _length(radius: float, size: float) -> float:
    return max(STEM_LENGTH * size, 4 * radius)


def _stand(element: Element, contacts: Sequence[Contact], size: float) -> _Stand:
    """The middle of its contacts, and the mean of their unit normals; a pin stands behind its end."""
    point = np.mean([lifted(contact.point) for contact in contacts], axis=0)
    normals = [lifted(unit_normal(normal)) for contact in contacts for normal in contact.normals]
    mean = np.mean(normals, axis=0)
    if isinstance(element.tip, PinTip) and element.axis is not None:
        return _Stand(lifted(element.at), -lifted(unit_normal(element.axis)), size)
    length = float(np.linalg.norm(mean))
    return _Stand(point, mean / length if length > STEM else normals[0], size)


def _tip(element: Element, stand: _Stand) -> tuple[list[Shape], Vector3, float]:
    """Shapes of the tip, and where the stem starts with which radius."""
    tip, point, away = element.tip, stand.point, stand.away
    stem = STEM * stand.size
    match tip:
        case PointTip():
            start = point + 2.5 * stem * away
            return [Cylinder(point, start, 0.0, stem)], start, stem
        case SphereTip():
            center = point + tip.radius * away
            return [Sphere(center, tip.radius)], center, min(stem, _OF_TIP * tip.radius)
        case PadTip():
            thick = min(0.3 * min(tip.width, tip.height), stem)
            axes = _frame(away, lifted(tip.along))
            sides = np.array([tip.width, tip.height, thick])
            start = point + thick * away
            return [Box(point + thick / 2 * away, axes, sides)], start, min(stem, 0.35 * min(tip.width, tip.height))
        case LineTip():
            return _wedge(tip, stand), point + 2 * stem * away, stem
        case SoftTip():
            start = point + 0.6 * tip.radius * away
            bulge = Cylinder(point, start, tip.radius, 0.75 * tip.radius)
            return [bulge], start, min(stem, _OF_TIP * tip.radius)
        case PinTip():
            return _pin(tip, stand), point + _PIN_OUT * tip.diameter / 2 * away, max(tip.diameter * 0.35, stem)


def _wedge(tip: LineTip, stand: _Stand) -> list[Shape]:
    """A blade with its edge on the line."""
    along = _frame(stand.away, lifted(tip.along))[:, 0] * tip.length / 2
    height = 2 * STEM * stand.size
    across = np.cross(stand.away, along)
    across *= height / 2 / np.linalg.norm(across)
    top = stand.point + height * stand.away
    vertices = np.array(
        [stand.point - along, stand.point + along]
        + [top + a * along + b * across for a in (-1, 1) for b in (-1, 1)],
    )  # fmt: skip
    corners = [[0, 2, 4], [0, 4, 1], [0, 1, 5], [0, 5, 3], [2, 3, 5], [2, 5, 4], [0, 3, 2], [1, 4, 5]]
    return [Mesh(vertices, np.array(corners))]


def _pin(tip: PinTip, stand: _Stand) -> list[Shape]:
    """A rod in the hole; of a diamond, a rhombic one."""
    low = stand.point - _PIN_IN * tip.diameter * stand.away
    high = stand.point + _PIN_OUT * tip.diameter * stand.away
    radius = tip.diameter / 2
    if tip.shape == "round" or tip.along is None:
        return [Cylinder(low, high, radius)]
    axes = _frame(stand.away, lifted(tip.along))
    outline = [(radius, 0.0), (0.0, _RELIEVED * radius), (-radius, 0.0), (0.0, -_RELIEVED * radius)]
    ring = np.array([x * axes[:, 0] + y * axes[:, 1] for x, y in outline])
    here, there = np.arange(4), (np.arange(4) + 1) % 4
    sides = [np.column_stack([here, there, there + 4]), np.column_stack([here, there + 4, here + 4])]
    caps = [np.array([[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]])]
    return [Mesh(np.vstack([low + ring, high + ring]), np.vstack([*sides, *caps]))]


def _frame(away: Vector3, along: Vector3) -> Points3:
    """Columns: ``along`` made square to ``away``, the third one, and between them; right-handed."""
    first = along - (along @ away) * away
    length = float(np.linalg.norm(first))
    first = first / length if length > STEM else tangents(away)[0]
    return np.column_stack([first, np.cross(away, first), away])


def _foot(role: Role, point: Vector3, away: Vector3, side: float) -> Shape:
    """Told apart without colours: locators stand on a block, clamps have a knob, supports a cone, fingers a ball."""
    match role:
        case "locator":
            return Box(point, _frame(away, np.roll(away, 1)), np.array([side, side, 0.35 * side]))
        case "clamp":
            return Cylinder(point - 0.25 * side * away, point + 0.25 * side * away, 0.62 * side)
        case "support":
            return Cylinder(point + 0.5 * side * away, point - 0.5 * side * away, 0.6 * side, 0.0)
        case "finger":
            return Sphere(point, 0.5 * side)
