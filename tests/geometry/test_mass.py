"""Mass and its centre: from the layout, from URDF inertials of several links, from the shape."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import FileFormatError
from fixture_design.geometry import load_geometry, mass_of
from fixture_design.layout import Part, Pose
from tests.geometry.parts import box, l_shape, part, write

HALVES = """<link name="a"><inertial><origin xyz="0 0 1"/><mass value="3"/></inertial>
<collision><geometry><box size="1 1 1"/></geometry></collision></link>
<link name="b"><inertial><mass value="1"/></inertial></link>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="4 0 0" rpy="0 0 0"/></joint>"""


def urdf(folder: Path, body: str) -> Part:
    file = folder / "robot.urdf"
    file.write_text(f'<robot name="r">{body}</robot>')
    return part(file)


def test_links_add_up(tmp_path: Path) -> None:
    model = urdf(tmp_path, HALVES)
    mass = mass_of(model, load_geometry(model))
    assert mass is not None
    assert mass.mass == 4
    np.testing.assert_allclose(mass.center, [1, 0, 0.75], atol=1e-15)


def test_the_layout_counts_first(tmp_path: Path) -> None:
    model = replace(urdf(tmp_path, HALVES), mass=2.0, center=np.array([0.1, 0.2, 0.3]))
    mass = mass_of(model, load_geometry(model))
    assert mass is not None
    assert (mass.mass, mass.center.tolist(), mass.note) == (2.0, [0.1, 0.2, 0.3], None)


def test_a_mesh_has_no_mass_of_its_own(tmp_path: Path) -> None:
    model = part(write(tmp_path, box(1, 1, 1)))
    assert mass_of(model, load_geometry(model)) is None


def test_the_centre_of_a_solid_wherever_it_is(tmp_path: Path) -> None:
    vertices, triangles = l_shape(0.04, 0.02)
    away = np.array([5.0, -3.0, 1.0])
    model = replace(part(write(tmp_path, (vertices + away, triangles))), mass=1.0)
    mass = mass_of(model, load_geometry(model))
    assert mass is not None
    assert mass.note is not None
    # three quarters of a square of 40 mm: (3 * 20 - ... ) by hand: (10 + 10 + 30) / 3, (10 + 30 + 10) / 3
    np.testing.assert_allclose(mass.center - away, [0.05 / 3, 0.05 / 3, 0.01], atol=1e-6)


def test_the_centre_of_a_polygon() -> None:
    corners = np.array([[1, 1], [3, 1], [3, 2], [2, 2], [2, 3], [1, 3]], dtype=float)
    model = Part("polygon", "polygon", None, corners, 1.0, Pose.identity(2), mass=1.0)
    mass = mass_of(model, load_geometry(model))
    assert mass is not None
    np.testing.assert_allclose(mass.center, [11 / 6, 11 / 6], atol=1e-12)


@pytest.mark.parametrize(
    ("body", "word"), [("<inertial/>", "no mass"), ('<inertial><mass value="-1"/></inertial>', "below zero")]
)
def test_inertials_that_cannot_be_used(tmp_path: Path, body: str, word: str) -> None:
    shape = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    model = urdf(tmp_path, f'<link name="a">{body}{shape}</link>')
    with pytest.raises(FileFormatError, match=word):
        mass_of(model, load_geometry(model))
