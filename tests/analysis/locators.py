"""Locators on boxes for the tests of accuracy: contacts as the geometry would find them, and the layout around them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from fixture_design.analysis import accurate
from fixture_design.contacts import Contact
from fixture_design.layout import (
    Answer,
    Element,
    FeatureError,
    Finding,
    Group,
    KeyFeature,
    Layout,
    LocatingErrors,
    Part,
    Pose,
    groups_of,
)
from fixture_design.verification.accuracy_proofs import accuracy_fault


def tip(name: str, point: Sequence[float], normal: Sequence[float]) -> Contact:
    return Contact.on_facet(name, "locator", point, normal)


def pad(name: str, center: Sequence[float], size: float) -> list[Contact]:
    """A square pad under the part."""
    x, y, z = center
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return [
        tip(f"{name}#{i + 1}", [x + a * size / 2, y + b * size / 2, z], [0, 0, -1]) for i, (a, b) in enumerate(signs)
    ]


def pin(
    name: str, center: Sequence[float], radius: float, clearance: float, walls: Sequence[Sequence[float]]
) -> list[Contact]:
    """A pin that touches walls at center + radius * direction, all across."""
    contacts = [
        tip(f"{name}#{i + 1}", np.add(center, radius * np.array(wall)).tolist(), (-np.array(wall)).tolist())
        for i, wall in enumerate(walls)
    ]
    return [replace(contact, clearance=clearance) for contact in contacts]


def feature(point: Sequence[float], direction: Sequence[float], tolerance: float, name: str = "bore") -> KeyFeature:
    return KeyFeature(name, np.array(point, dtype=float), np.array(direction, dtype=float), tolerance)


def layout_of(
    contacts: Sequence[Contact],
    tolerances: Mapping[str, float | None],
    features: Sequence[KeyFeature],
    *,
    form: float | None = None,
    center: Sequence[float] | None = None,
    preloads: Mapping[str, float] | None = None,
) -> tuple[Layout, Group]:
    """A layout with elements of these tolerances, and the group of all its contacts; gravity with a centre."""
    plane = len(contacts[0].point)
    elements = tuple(Element(name, "locator", np.zeros(plane), tolerance=t) for name, t in tolerances.items())
    clamps = tuple(Element(name, "clamp", np.zeros(plane), preload=force) for name, force in (preloads or {}).items())
    part = Part("part", "mesh", None, None, 1.0, Pose.identity(plane), 1.0, form_error=form)
    gravity = np.array([0.0] * (plane - 1) + [-9.81]) if center is not None else None
    layout = Layout(
        "boxes",
        "planar" if plane == 2 else "spatial",
        part=replace(part, center=None if center is None else np.array(center, dtype=float)),
        gravity=gravity,
        elements=(*elements, *clamps),
        contacts=tuple(contacts),
        key_features=tuple(features),
    )
    return layout, next(group for group in groups_of(layout, contacts) if group.name == "all")


def asked(contacts: Sequence[Contact], *arguments: object, **given: object) -> Finding:
    """The finding, which the checker must confirm."""
    layout, group = layout_of(contacts, *arguments, **given)  # type: ignore[arg-type]
    finding = accurate(layout, group, np.zeros(len(contacts[0].point)))
    if finding.answer is not Answer.UNDECIDED:
        assert accuracy_fault(finding, contacts) is None
    return finding


def evidence(finding: Finding) -> LocatingErrors:
    assert isinstance(finding.use, LocatingErrors)
    return finding.use


def only(finding: Finding) -> FeatureError:
    (error,) = evidence(finding).features
    return error


#: Three under the part, two on its side y = 0, one on x = 0, of a box 100 x 80 x 40 mm.
THREE_TWO_ONE = (
    tip("A", [0.01, 0.01, 0], [0, 0, -1]),
    tip("B", [0.09, 0.01, 0], [0, 0, -1]),
    tip("C", [0.05, 0.07, 0], [0, 0, -1]),
    tip("D", [0.02, 0, 0.02], [0, -1, 0]),
    tip("E", [0.08, 0, 0.02], [0, -1, 0]),
    tip("F", [0, 0.04, 0.02], [-1, 0, 0]),
)
UNDER = THREE_TWO_ONE[:3]
ROUND = ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0))
ACROSS_X = ((0, 1, 0), (0, -1, 0))
