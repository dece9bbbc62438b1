"""Cones and tori that touch something round: an error rather than a contact left out; none where none is missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from fixture_design.errors import UnsupportedError
from fixture_design.geometry import contacts_of_elements
from fixture_design.layout import Body, Layout, Part, Pose
from tests.geometry.parts import Mesh, part, write

Profile = list[list[float]]


def turned(profile: Profile, sections: int = 48) -> Mesh:
    """A profile of [radius, height], turned about z."""
    mesh = trimesh.creation.revolve(np.array(profile), sections=sections)
    mesh.merge_vertices()
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.fix_normals()
    assert mesh.is_watertight
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def body(folder: Path, name: str, mesh: Mesh, *boxes: str) -> Body:
    file = write(folder, mesh, f"{name}.obj")
    shapes = [f'<geometry><mesh filename="{file.name}"/></geometry>', *boxes]
    collisions = "".join(f"<collision>{shape}</collision>" for shape in shapes)
    urdf = folder / f"{name}.urdf"
    urdf.write_text(f'<robot name="{name}"><link name="{name}">{collisions}</link></robot>')
    return Body(name, "locator", urdf, Pose.identity(3))


def ball(folder: Path, radius: float, height: float) -> Part:
    file = folder / "ball.urdf"
    shape = f'<geometry><sphere radius="{radius}"/></geometry>'
    file.write_text(f'<robot name="ball"><link name="ball"><collision>{shape}</collision></link></robot>')
    return Part("ball", "urdf", file, None, 1.0, Pose.from_xyz_rpy([0, 0, height], [0, 0, 0]))


def block(z: float) -> str:
    return f'<origin xyz="0 0 {z}"/><geometry><box size="0.02 0.02 0.01"/></geometry>'


CUP: Profile = [[0, -0.008], [0.002, -0.008], [0.01, 0], [0.02, 0], [0.02, -0.015], [0, -0.015]]


@pytest.mark.parametrize("sections", [24, 64])
def test_ball_in_a_conical_seat_is_not_left_out(tmp_path: Path, sections: int) -> None:
    """The plate above it makes a contact; without the seat's the ball would be free to leave downwards."""
    height = -0.01 + 0.005 * 2**0.5
    seat = body(tmp_path, "seat", turned(CUP, sections), block(height + 0.005 + 0.005))
    layout = Layout("coupling", part=ball(tmp_path, 0.005, height), bodies=(seat,))
    with pytest.raises(UnsupportedError, match=r"sphere 1 of the part touches cone 1 of body 'seat' near .* not eval"):
        contacts_of_elements(layout)


def test_ball_above_its_seat_touches_the_plate_only(tmp_path: Path) -> None:
    height = -0.01 + 0.005 * 2**0.5 + 1e-4
    seat = body(tmp_path, "seat", turned(CUP), block(height + 0.005 + 0.005))
    (contact,) = contacts_of_elements(Layout("above", part=ball(tmp_path, 0.005, height), bodies=(seat,))).contacts
    np.testing.assert_allclose(contact.point, [0, 0, height + 0.005], atol=1e-12)


def test_pin_in_a_bore_with_a_rounded_mouth(tmp_path: Path) -> None:
    """The fillet touches the pin only where it ends in the bore, and there the bore's contacts are made."""
    angles = np.linspace(0, np.pi / 2, 9)
    mouth = [[0.015 - 0.003 * np.cos(a), 0.007 + 0.003 * np.sin(a)] for a in angles]
    plate = turned([[0.012, 0], *mouth, [0.04, 0.01], [0.04, 0], [0.012, 0]], 64)
    pin = turned([[0, -0.01], [0.012, -0.01], [0.012, 0.03], [0, 0.03]], 64)
    layout = Layout("pin", part=part(write(tmp_path, plate, "plate.obj")), bodies=(body(tmp_path, "pin", pin),))
    found = contacts_of_elements(layout).contacts
    assert len(found) >= 16
    for contact in found:
        radial = contact.point[:2] / np.linalg.norm(contact.point[:2])
        np.testing.assert_allclose(contact.normals[0] / np.linalg.norm(contact.normals[0]), [*-radial, 0], atol=1e-6)


def ring() -> Mesh:
    """Of 8 mm tube around 30 mm, lying on z = 0, turned by half a section so that no vertex is on the x axis."""
    tube = np.linspace(0, 2 * np.pi, 17)
    vertices, triangles = turned([[0.03 + 0.008 * np.cos(a), 0.008 + 0.008 * np.sin(a)] for a in tube], 48)
    cosine, sine = np.cos(np.pi / 48), np.sin(np.pi / 48)
    return vertices @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]]), triangles


def test_shaft_against_a_ring_is_not_left_out(tmp_path: Path) -> None:
    """A dowel beside the tube, which it touches halfway up, between vertices; a stop elsewhere makes a contact."""
    vertices, triangles = turned([[0, 0.001], [0.01, 0.001], [0.01, 0.03], [0, 0.03]], 64)
    stop = '<origin xyz="-0.043 0 0.015"/><geometry><box size="0.01 0.02 0.02"/></geometry>'
    nest = body(tmp_path, "nest", (vertices + np.array([0.048, 0, 0]), triangles), stop)
    layout = Layout("ring", part=part(write(tmp_path, ring(), "ring.obj")), bodies=(nest,))
    with pytest.raises(UnsupportedError, match="torus 1 of the part touches cylinder 1 of body 'nest'"):
        contacts_of_elements(layout)


def test_ring_on_a_floor_is_not_left_out(tmp_path: Path) -> None:
    corner = turned([[0, 0.001], [0.01, 0.001], [0.01, 0.03], [0, 0.03]], 64)
    floor = '<origin xyz="0 0 -0.005"/><geometry><box size="0.2 0.2 0.01"/></geometry>'
    stop = '<origin xyz="-0.043 0 0.015"/><geometry><box size="0.01 0.02 0.02"/></geometry>'
    nest = body(tmp_path, "nest", corner, floor, stop)
    layout = Layout("ring", part=part(write(tmp_path, ring(), "ring.obj")), bodies=(nest,))
    with pytest.raises(UnsupportedError, match=r"torus 1 of the part touches facet .* of body 'nest'"):
        contacts_of_elements(layout)


def test_block_with_rounded_edges_stands_on_its_flat(tmp_path: Path) -> None:
    """The rounding's lowest circle is the border of the flat, whose contacts are made."""
    rounding = [[0.027 + 0.003 * np.sin(a), 0.003 - 0.003 * np.cos(a)] for a in np.linspace(0, np.pi / 2, 9)]
    puck = turned([[0, 0], *rounding, [0.03, 0.02], [0, 0.02]], 48)
    floor = body(tmp_path, "floor", turned([[0, -0.01], [0.1, -0.01], [0.1, 0], [0, 0]], 6))
    found = contacts_of_elements(Layout("puck", part=part(write(tmp_path, puck, "puck.obj")), bodies=(floor,))).contacts
    assert len(found) >= 8
    assert {tuple(np.round(n / np.linalg.norm(n), 9)) for c in found for n in c.normals} == {(0.0, 0.0, -1.0)}
