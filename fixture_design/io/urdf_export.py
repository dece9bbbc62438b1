"""A layout's elements as URDF: each a tip, a stem and a body that stand on the part's surface, for any simulator.

The root link `fixture` is W. Each element is a link of its name at its contact, z along the part's outward normal: a
ball whose lowest point touches, or a pad's plate, with a stem and a body (cylinders) further out. Of a pin z runs
against its axis, from its end to its stem. Sizes are those of `layout.stem_of` and `pin_stem`, by which design keeps
elements from cutting the part and each other.
"""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from fixture_design.arrays import Point, cross_products
from fixture_design.contacts import Contact, tangents, unit_normal
from fixture_design.errors import UnsupportedError
from fixture_design.io.pose_angles import roll_pitch_yaw
from fixture_design.io.text_file import write_text
from fixture_design.layout import (
    PIN_REACH,
    Column,
    Element,
    Layout,
    LineTip,
    PadTip,
    PinTip,
    Pose,
    Stem,
    StemSizes,
    Verdict,
    element_name,
    pin_stem,
    stem_of,
)


def write_urdf(layout: Layout, verdict: Verdict, path: str | Path, sizes: StemSizes | None = None) -> None:
    """Writes the elements as URDF, in metres.

    Args:
        verdict: of the layout: it has the contacts with their normals, and the part's size.
        sizes: of stems and bodies, where these are not the usual ones; a task's `candidates.stem`.

    Raises:
        UnsupportedError: a planar layout.  FileFormatError: the file cannot be written.
    """
    write_text(Path(path), urdf_text(layout, verdict, sizes))


def urdf_text(layout: Layout, verdict: Verdict, sizes: StemSizes | None = None) -> str:
    """The URDF file's text. Raises like `write_urdf`."""
    if layout.space == "planar":
        raise UnsupportedError("a planar layout has no URDF form", expected="`--csv`, or a spatial layout")
    contacts: dict[str, Contact] = {}
    for contact in verdict.contacts:
        contacts.setdefault(element_name(contact.name), contact)
    parts = [
        _element(one, contacts[one.name], _stem(one, verdict.length, sizes))
        for one in layout.elements
        if one.name in contacts
    ]
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            f"<robot name={quoteattr(layout.name)}>",
            '  <link name="fixture"/>',
            *parts,
            "</robot>",
            "",
        ]
    )


def _element(element: Element, contact: Contact, stem: Stem) -> str:
    # a pin stands behind its end; what touches in several points stands in its middle
    normal = unit_normal(contact.normals[0]) if element.axis is None else -unit_normal(element.axis)
    pose = _upright(np.asarray(element.at) if stem.flat else contact.point, normal, _along(element))
    shapes = [_tip(element, stem), *(_cylinder(column) for column in stem.columns)]
    solids = "\n".join(
        f'    <{use}><origin xyz="0 0 {height!r}"/><geometry>{shape}</geometry></{use}>'
        for shape, height in shapes
        for use in ("visual", "collision")
    )
    name = quoteattr(element.name)
    xyz, rpy = (" ".join(repr(float(x)) for x in values) for values in (pose.translation, roll_pitch_yaw(pose)))
    return (
        f"  <link name={name}>\n{solids}\n  </link>\n"
        f'  <joint name={quoteattr(f"fixture to {element.name}")} type="fixed">\n'
        f'    <parent link="fixture"/><child link={name}/><origin xyz="{xyz}" rpy="{rpy}"/>\n  </joint>'
    )


def _tip(element: Element, stem: Stem) -> tuple[str, float]:
    tip = element.tip
    if isinstance(tip, PadTip | LineTip):
        width, height = (tip.width, tip.height) if isinstance(tip, PadTip) else (tip.length, stem.tip)
        return f'<box size="{width!r} {height!r} {stem.tip!r}"/>', stem.tip / 2
    if isinstance(tip, PinTip):
        return _cylinder(Column(-PIN_REACH * tip.diameter, stem.tip, tip.diameter / 2))
    return f'<sphere radius="{stem.tip!r}"/>', stem.tip


def _cylinder(column: Column) -> tuple[str, float]:
    middle = (column.low + column.high) / 2
    return f'<cylinder radius="{column.radius!r}" length="{column.high - column.low!r}"/>', middle


def _stem(element: Element, size: float, sizes: StemSizes | None) -> Stem:
    tip = element.tip
    return pin_stem(tip, size) if isinstance(tip, PinTip) else stem_of(tip, size, sizes)


def _along(element: Element) -> Point | None:
    return element.tip.along if isinstance(element.tip, PadTip | LineTip) else None


def _upright(point: Point, normal: Point, along: Point | None) -> Pose:
    """At the contact, z along the outward normal, x as near to ``along`` as it gets."""
    first, second = tangents(normal)
    if along is not None:
        first = unit_normal(along - (along @ normal) * normal)
        second = cross_products(normal, first)
    # right-handed whichever way round the two tangents come
    if np.linalg.det(np.column_stack([first, second, normal])) < 0:
        first, second = second, first
    return Pose(np.column_stack([first, second, normal]), point)
