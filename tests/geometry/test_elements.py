"""From layouts to contacts: one entry for both kinds of part, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import InputError, OffSurfaceError, UnsupportedError
from fixture_design.geometry import contacts_of_elements, load_geometry
from fixture_design.layout import Body, Element, Layout, Pose
from fixture_design.tolerances import SMOOTH_ANGLE
from tests.geometry.parts import box, part, polygon_part, shared, write

POSE = Pose.from_xyz_rpy([1, 2, 3], [0, 0, np.pi / 2])


@pytest.fixture
def layout(tmp_path: Path) -> Layout:
    block = replace(part(write(tmp_path, box(0.05, 0.03, 0.02))), pose=POSE)
    elements = (
        Element("A", "locator", np.array([1.0, 2.0, 2.99])),
        Element("B", "clamp", np.array([1.0, 2.0, 3.01]), friction=0.4),
    )
    return Layout("l", part=block, elements=elements, friction=0.1)


def test_contacts_in_order_with_friction_and_box(layout: Layout) -> None:
    found = contacts_of_elements(layout)
    assert [(c.name, c.role, c.friction) for c in found.contacts] == [("A", "locator", 0.1), ("B", "clamp", 0.4)]
    np.testing.assert_allclose([c.point for c in found.contacts], [[1, 2, 2.99], [1, 2, 3.01]])
    np.testing.assert_allclose(found.box_center, [1, 2, 3])
    assert found.half_diagonal == pytest.approx(np.linalg.norm([0.05, 0.03, 0.02]) / 2)


def test_loaded_part_is_used_and_not_read_again(layout: Layout) -> None:
    assert layout.part is not None
    assert layout.part.file is not None
    geometry = load_geometry(layout.part)
    layout.part.file.unlink()
    assert len(contacts_of_elements(layout, geometry).contacts) == 2


def test_planar_layout() -> None:
    square = polygon_part([[0, 0], [2, 0], [2, 2], [0, 2]], Pose.from_xy_theta([1, 1], np.pi))
    planar = Layout("p", "planar", square, elements=(Element("A", "locator", np.array([0.0, 1.0])),))
    found = contacts_of_elements(planar)
    np.testing.assert_allclose(found.contacts[0].normals, [[0, 2]], atol=1e-15)
    np.testing.assert_allclose(found.box_center, [0, 0], atol=1e-15)
    assert found.half_diagonal == pytest.approx(np.sqrt(2))


def test_what_is_refused(layout: Layout, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no part"):
        contacts_of_elements(replace(layout, part=None))
    with pytest.raises(InputError, match="does not fit a planar layout"):
        contacts_of_elements(replace(layout, space="planar"))
    square = polygon_part([[0, 0], [2, 0], [2, 2], [0, 2]])
    planar = Layout("p", "planar", square, bodies=(Body("vee", "locator", tmp_path / "v.urdf", POSE),))
    with pytest.raises(UnsupportedError, match=r"'vee'.*no planar form"):
        contacts_of_elements(planar)
    with pytest.raises(OffSurfaceError, match="'A'"):
        contacts_of_elements(replace(layout, part=replace(layout.part, pose=Pose.identity(3))))


def test_real_adapter_takes_an_element_on_every_hundredth_triangle() -> None:
    path = "airo-models/airo_models/grippers/fingertips/originals/robotiq_adapter.stl"
    geometry = load_geometry(part(shared(path), 0.001))
    chosen = geometry.triangles[::100]
    elements = tuple(
        Element(f"E{number}", "locator", geometry.vertices[corners].mean(axis=0))
        for number, corners in enumerate(chosen)
    )
    contacts = contacts_of_elements(Layout("a", part=part(shared(path), 0.001), elements=elements), geometry).contacts
    for contact, corners in zip(contacts, geometry.vertices[chosen], strict=True):
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        cosines = [n @ normal / np.linalg.norm(n) / np.linalg.norm(normal) for n in contact.normals]
        # the facet is a chord of the round surface that was fitted
        chord = SMOOTH_ANGLE / 2 if contact.provenance.kind == "fitted" else 1e-4
        assert max(cosines) >= np.cos(contact.provenance.normal_error + chord)
