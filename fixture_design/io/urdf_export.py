"""A layout's elements as URDF: each a tip, a stem and a body that stand on the part's surface, for any simulator.

The root link `fixture` is W. Each element is a link of its name at its contact, z along the part's outward normal: a
ball whose lowest point touches, a stem (cylinder) and a body (box) further out. Sizes are those of the tip where it has
some, else fractions of the part's size.
"""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Contact, tangents, unit_normal
from fixture_design.errors import UnsupportedError
from fixture_design.io.pose_angles import roll_pitch_yaw
from fixture_design.io.text_file import write_text
from fixture_design.layout import Element, Layout, Pose, SoftTip, SphereTip, Verdict, element_name

#: Radius of a point's ball, length of a stem, side of a body, as parts of half the diagonal of the part's box [-].
_BALL, _STEM, _BODY = 0.02, 0.2, 0.12
#: A stem's radius next to its ball's [-].
_SLIM = 0.8


def write_urdf(layout: Layout, verdict: Verdict, path: str | Path) -> None:
    """Writes the elements as URDF, in metres.

    Args:
        verdict: of the layout: it has the contacts with their normals, and the part's size.

    Raises:
        UnsupportedError: a planar layout.  FileFormatError: the file cannot be written.
    """
    write_text(Path(path), urdf_text(layout, verdict))


def urdf_text(layout: Layout, verdict: Verdict) -> str:
    """The URDF file's text. Raises like `write_urdf`."""
    if layout.space == "planar":
        raise UnsupportedError("a planar layout has no URDF form", expected="`--csv`, or a spatial layout")
    contacts: dict[str, Contact] = {}
    for contact in verdict.contacts:
        contacts.setdefault(element_name(contact.name), contact)
    parts = [_element(one, contacts[one.name], verdict.length) for one in layout.elements if one.name in contacts]
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


def _element(element: Element, contact: Contact, size: float) -> str:
    radius = element.tip.radius if isinstance(element.tip, SphereTip | SoftTip) else _BALL * size
    stem, body = _STEM * size, _BODY * size
    shapes = [
        (f'<sphere radius="{radius!r}"/>', radius),
        (f'<cylinder radius="{_SLIM * radius!r}" length="{stem!r}"/>', radius + stem / 2),
        (f'<box size="{body!r} {body!r} {body!r}"/>', radius + stem + body / 2),
    ]
    solids = "\n".join(
        f'    <{use}><origin xyz="0 0 {height!r}"/><geometry>{shape}</geometry></{use}>'
        for shape, height in shapes
        for use in ("visual", "collision")
    )
    name = quoteattr(element.name)
    pose = _upright(contact.point, unit_normal(contact.normals[0]))
    xyz, rpy = (" ".join(repr(float(x)) for x in values) for values in (pose.translation, roll_pitch_yaw(pose)))
    return (
        f"  <link name={name}>\n{solids}\n  </link>\n"
        f'  <joint name={quoteattr(f"fixture to {element.name}")} type="fixed">\n'
        f'    <parent link="fixture"/><child link={name}/><origin xyz="{xyz}" rpy="{rpy}"/>\n  </joint>'
    )


def _upright(point: Point, normal: Point) -> Pose:
    """At the contact, z along the outward normal."""
    first, second = tangents(normal)
    # right-handed whichever way round the two tangents come
    if np.linalg.det(np.column_stack([first, second, normal])) < 0:
        first, second = second, first
    return Pose(np.column_stack([first, second, normal]), point)
