"""Cylinders, spheres and capsules: closed, fine enough, on the true surface, and remembered exactly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixture_design.errors import GeometryError
from fixture_design.geometry import PartGeometry, load_part
from fixture_design.geometry.edges import edges_of, neighbours
from fixture_design.geometry.piece import SmoothPatch, area_vectors, heights
from fixture_design.geometry.primitives import Primitive, capsule, cylinder, sphere
from fixture_design.geometry.urdf import read_urdf
from tests.geometry.parts import part

SHAPES = {
    "cylinder": (cylinder(0.02, 0.05), '<cylinder radius="0.02" length="0.05"/>', ["cylinder"]),
    "sphere": (sphere(0.02), '<sphere radius="0.02"/>', ["sphere"]),
    "capsule": (capsule(0.02, 0.05), '<capsule radius="0.02" length="0.05"/>', ["sphere", "cylinder", "sphere"]),
    "flat capsule": (capsule(0.02, 1e-5), '<capsule radius="0.02" length="1e-5"/>', ["sphere", "cylinder", "sphere"]),
    "disc": (cylinder(0.05, 0.001), '<cylinder radius="0.05" length="0.001"/>', ["cylinder"]),
    "wire": (cylinder(0.0005, 0.5), '<cylinder radius="0.0005" length="0.5"/>', ["cylinder"]),
}
VOLUMES = {
    "cylinder": np.pi * 0.02**2 * 0.05,
    "sphere": 4 / 3 * np.pi * 0.02**3,
    "capsule": np.pi * 0.02**2 * 0.05 + 4 / 3 * np.pi * 0.02**3,
    "disc": np.pi * 0.05**2 * 0.001,
    "wire": np.pi * 0.0005**2 * 0.5,
}


def model(folder: Path, shape: str, origin: str = "") -> Path:
    file = folder / "shape.urdf"
    link = f'<link name="l"><collision>{origin}<geometry>{shape}</geometry></collision></link>'
    file.write_text(f'<robot name="r">{link}</robot>')
    return file


def distances(patch: SmoothPatch, points: np.ndarray) -> np.ndarray:
    """How far points are outside of the surface of a patch."""
    away = points - patch.point
    if patch.kind == "cylinder":
        away = away - np.outer(away @ patch.axis, patch.axis)
    return np.linalg.norm(away, axis=1) - patch.radius


@pytest.mark.parametrize("name", SHAPES)
def test_closed_with_outward_normals_and_no_slivers(name: str) -> None:
    shape: Primitive = SHAPES[name][0]
    edges = edges_of(shape.triangles, len(shape.vertices))
    assert (edges.uses == 2).all()
    assert (edges.balance == 0).all()
    first, second, third = (shape.vertices[shape.triangles[:, corner]] for corner in range(3))
    volume = float(np.einsum("ij,ij->", first, np.cross(second, third))) / 6
    if name in VOLUMES:
        # inside the true solid, and within 0.4 % of it
        assert 0.996 * VOLUMES[name] < volume < VOLUMES[name]
    # rounding turns no triangle by more than a millionth
    turn = shape.rounding.max() / heights(shape.vertices, shape.triangles)
    assert turn.max() < 1e-6


@pytest.mark.parametrize("name", SHAPES)
def test_strips_turn_by_at_most_ten_degrees_and_lie_on_the_surface(name: str) -> None:
    shape, _, kinds = SHAPES[name]
    assert [patch.kind for patch in shape.smooth] == kinds
    units = area_vectors(shape.vertices, shape.triangles)
    units /= np.linalg.norm(units, axis=1, keepdims=True)
    across = neighbours(shape.triangles, len(shape.vertices))
    covered = np.concatenate([patch.triangles for patch in shape.smooth])
    assert len(np.unique(covered)) == len(covered)
    for patch in shape.smooth:
        corners = shape.vertices[shape.triangles[patch.triangles]]
        assert np.abs(distances(patch, corners.reshape(-1, 3))).max() < 1e-15
        for triangle in patch.triangles:
            smooth = [other for other in across[triangle] if other in patch.triangles]
            assert np.degrees(np.arccos(np.clip(units[smooth] @ units[triangle], -1, 1))).max() < 10
        # chords stay within a thousandth of the radius, where the surface curves both ways within two
        middles = corners.mean(axis=1)
        assert -(1e-3 if patch.kind == "cylinder" else 2e-3) * patch.radius < distances(patch, middles).min() < 0
    # what no patch covers is flat
    flat = np.setdiff1d(np.arange(len(shape.triangles)), covered)
    assert (np.abs(units[flat][:, 2]) == 1).all()


@pytest.mark.parametrize("name", SHAPES)
def test_urdf_gives_the_shape_where_its_origin_puts_it(tmp_path: Path, name: str) -> None:
    shape, text, kinds = SHAPES[name]
    file = model(tmp_path, text, '<origin xyz="0.1 0.2 -0.3" rpy="0.3 -0.4 0.5"/>')
    (piece,), notes = read_urdf(file)
    assert notes == ()
    assert [patch.kind for patch in piece.smooth] == kinds
    rotation = Rotation.from_euler("xyz", [0.3, -0.4, 0.5]).as_matrix()
    for patch, own in zip(piece.smooth, shape.smooth, strict=True):
        np.testing.assert_allclose(patch.axis, rotation[:, 2], atol=1e-15)
        np.testing.assert_allclose(patch.point, rotation @ own.point + [0.1, 0.2, -0.3], atol=1e-15)
        assert np.abs(distances(patch, piece.vertices[piece.triangles[patch.triangles].ravel()])).max() < 1e-15


@pytest.mark.parametrize("name", SHAPES)
def test_loaded_part_keeps_its_triangles_and_what_they_stand_for(tmp_path: Path, name: str) -> None:
    shape, text, _ = SHAPES[name]
    link = '<link name="{}"><collision>{}<geometry>{}</geometry></collision></link>'
    first = link.format("a", "", '<box size="0.01 0.01 0.01"/>')
    second = link.format("b", '<origin xyz="1 0 0"/>', text)
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    file = tmp_path / "two.urdf"
    file.write_text(f'<robot name="r">{first}{second}{joint}</robot>')
    geometry: PartGeometry = load_part(part(file))
    assert len(geometry.triangles) == 12 + len(shape.triangles)
    assert len(geometry.given) == len(shape.smooth)
    for patch in geometry.given:
        points = geometry.vertices[geometry.triangles[patch.triangles].ravel()]
        assert np.abs(distances(patch, points)).max() < 1e-15


def test_distance_is_the_spheres_up_to_its_facets(tmp_path: Path) -> None:
    geometry = load_part(part(model(tmp_path, '<sphere radius="0.02"/>')))
    directions = np.random.default_rng(5).normal(size=(50, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    for direction in directions:
        assert geometry.surface.at(0.03 * direction)[0] == pytest.approx(0.01, abs=2e-3 * 0.02)
    # the outermost points are vertices
    assert geometry.surface.at(np.array([0.0, 0.03, 0.0]))[0] == pytest.approx(0.01, abs=1e-15)


def test_a_shape_thinner_than_vertices_are_told_apart_is_refused(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"shape\.urdf: link 'l', collision"):
        load_part(part(model(tmp_path, '<cylinder radius="1e-11" length="1"/>')))
