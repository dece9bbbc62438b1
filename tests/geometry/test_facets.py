"""Facets: what is one plane, how they are named, and which stand for a curved surface."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fixture_design.geometry import PartGeometry, load_part
from tests.geometry.parts import Mesh, box, circle, l_shape, loaded, part, prism, seven_eighths, unit, write


def approximate(geometry: PartGeometry) -> set[str]:
    return {facet.name for facet in geometry.facets if facet.provenance.kind == "approximate"}


def flats(geometry: PartGeometry) -> set[str]:
    return {facet.name for facet in geometry.facets} - approximate(geometry)


def test_box_has_six_exact_facets_in_coordinate_order(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, box(0.05, 0.03, 0.02))
    normals = [unit(facet.normal).tolist() for facet in geometry.facets]
    assert normals == [[-1, 0, 0], [0, -1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert [facet.name for facet in geometry.facets] == [f"facet {number}" for number in range(1, 7)]
    assert all(facet.normal_error == 0 for facet in geometry.facets)
    # the area vector: twice the area long
    assert np.linalg.norm(geometry.facets[5].normal) == pytest.approx(2 * 0.03 * 0.02)
    assert geometry.facets[5].width == pytest.approx(0.02)


@pytest.mark.parametrize(("mesh", "count"), [(l_shape(), 8), (seven_eighths(), 9)], ids=["L", "7/8"])
def test_coplanar_triangles_are_one_facet_where_they_are_connected(tmp_path: Path, mesh: Mesh, count: int) -> None:
    assert len(loaded(tmp_path, mesh).facets) == count


def test_names_do_not_depend_on_the_order_of_triangles(tmp_path: Path) -> None:
    vertices, triangles = l_shape()
    shuffled = np.roll(np.random.default_rng(3).permutation(triangles), 1, axis=1)
    one, other = loaded(tmp_path, (vertices, triangles)), loaded(tmp_path, (vertices, shuffled))
    for first, second in zip(one.facets, other.facets, strict=True):
        np.testing.assert_allclose(first.centroid, second.centroid, atol=1e-15)
        np.testing.assert_allclose(first.normal, second.normal, atol=1e-15)


def test_dihedral_angles_have_the_sign_of_the_edge(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, l_shape())
    angles = [angle for facet in geometry.facets for angle in facet.angles.values()]
    assert sorted(np.round(np.degrees(angles))) == [-90.0] * 2 + [90.0] * 34


def test_rotated_box_has_errors_of_rounding_only(tmp_path: Path) -> None:
    vertices, triangles = box(0.05, 0.03, 0.02)
    turned = vertices @ Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).as_matrix().T
    exact = loaded(tmp_path, (turned, triangles))
    assert len(exact.facets) == 6
    assert 0 < max(facet.normal_error for facet in exact.facets) < 1e-14
    single = loaded(tmp_path, (turned.astype(np.float32), triangles))
    decimals = loaded(tmp_path, (np.round(turned, 6), triangles))
    for geometry, low, high in ((single, 1e-8, 1e-6), (decimals, 1e-5, 1e-3)):
        for facet, true in zip(geometry.facets, exact.facets, strict=True):
            angle = np.arccos(np.clip(unit(facet.normal) @ unit(true.normal), -1, 1))
            assert angle <= facet.normal_error + 1e-7
            assert low < facet.normal_error < high


def test_chamfers_are_not_a_curved_surface(tmp_path: Path) -> None:
    c, s = 0.005, 0.04
    outline = [[c, 0], [s - c, 0], [s, c], [s, s - c], [s - c, s], [c, s], [0, s - c], [0, c]]
    assert approximate(loaded(tmp_path, prism(outline, 0.01))) == set()


def test_flats_between_fillets_are_flat_and_fillets_are_not(tmp_path: Path) -> None:
    r, s, steps = 0.004, 0.04, 6
    outline = []
    for x, y, start in ((s - r, r, -90), (s - r, s - r, 0), (r, s - r, 90), (r, r, 180)):
        for angle in np.radians(start + np.linspace(0, 90, steps + 1)):
            outline.append([x + r * np.cos(angle), y + r * np.sin(angle)])
    geometry = loaded(tmp_path, prism(outline, 0.01))
    assert len(flats(geometry)) == 6
    assert len(approximate(geometry)) == 4 * steps
    for facet in geometry.facets:
        if facet.name in approximate(geometry):
            assert facet.normal_error == pytest.approx(np.radians(90 / steps), rel=1e-6)


@pytest.mark.parametrize("count", [12, 36, 100])
def test_strips_of_shafts_and_bores_are_approximate_and_caps_are_not(tmp_path: Path, count: int) -> None:
    shaft = loaded(tmp_path, prism(circle(0.01, count), 0.03))
    bore = loaded(tmp_path, prism(circle(0.03, 4), 0.03, [circle(0.01, count)]))
    assert (len(flats(shaft)), len(approximate(shaft))) == (2, count)
    assert (len(flats(bore)), len(approximate(bore))) == (6, count)
    step = 2 * np.pi / count
    assert {round(f.normal_error / step, 6) for f in shaft.facets if f.provenance.kind == "approximate"} == {1.0}


def test_last_strips_of_half_a_shaft_are_approximate_too(tmp_path: Path) -> None:
    half = [xy for xy in circle(0.01, 36) if xy[1] > -1e-9]
    geometry = loaded(tmp_path, prism(half, 0.03))
    assert (len(flats(geometry)), len(approximate(geometry))) == (3, 18)


@pytest.mark.parametrize(
    ("mesh", "flat_count"),
    [
        (trimesh.creation.icosphere(3, 0.02), 0),
        (trimesh.creation.uv_sphere(0.02), 0),
        (trimesh.creation.torus(0.03, 0.01, 48, 24), 0),
        (trimesh.creation.cone(0.02, 0.03, sections=36), 1),
    ],
    ids=["icosphere", "sphere", "torus", "cone"],
)
def test_doubly_curved_surfaces_are_approximate(tmp_path: Path, mesh: trimesh.Trimesh, flat_count: int) -> None:
    geometry = loaded(tmp_path, (np.array(mesh.vertices), np.array(mesh.faces)))
    assert len(flats(geometry)) == flat_count


def test_slivers_join_the_plane_they_lie_in(tmp_path: Path) -> None:
    # a box whose top has a vertex a few float32 roundings from its edge, and so a sliver along it
    vertices, triangles = (array.copy() for array in box(0.05, 0.03, 0.02))
    top = int(np.flatnonzero((vertices[triangles][:, :, 2] > 0).all(axis=1))[0])
    a, b, c = triangles[top]
    near = (vertices[a] + vertices[b]) / 2 + 1e-8 * unit(vertices[c] - vertices[a]) + np.array([0, 0, 2e-9])
    vertices = np.vstack([vertices, near]).astype(np.float32).astype(float)
    split = [[a, b, 8], [b, c, 8], [c, a, 8]]
    geometry = loaded(tmp_path, (vertices, np.vstack([np.delete(triangles, top, axis=0), split])))
    assert len(geometry.facets) == 6
    assert unit(geometry.facets[3].normal)[2] == pytest.approx(1, abs=1e-10)


def test_stl_of_a_box_is_exact_in_any_unit(tmp_path: Path) -> None:
    from fixture_design.geometry import load_part
    from tests.geometry.parts import part

    geometry = load_part(part(write(tmp_path, box(0.05, 0.03, 0.02), "b.stl", 1 / 0.0254), 0.0254))
    assert [facet.normal_error for facet in geometry.facets] == [0.0] * 6


def test_strips_narrower_than_their_vertices_are_known_are_not_called_exact(tmp_path: Path) -> None:
    vertices, triangles = prism(circle(0.001, 60), 0.03)
    geometry = loaded(tmp_path, (np.round(vertices, 6), triangles))
    strips = [facet for facet in geometry.facets if facet.name in approximate(geometry)]
    assert len(strips) == 60
    for facet in strips:
        true = unit([*facet.centroid[:2], 0])
        assert np.arccos(np.clip(unit(facet.normal) @ true, -1, 1)) <= facet.normal_error


@pytest.mark.parametrize("count", [5, 6, 7, 8, 10])
def test_equal_facets_all_around_may_be_a_coarse_shaft(tmp_path: Path, count: int) -> None:
    file = write(tmp_path, prism(circle(0.01, count), 0.03))
    unsure = load_part(part(file))
    assert (len(flats(unsure)), len(approximate(unsure))) == (2, count)
    assert max(facet.normal_error for facet in unsure.facets) == pytest.approx(np.pi / count, rel=1e-9)
    meant = load_part(replace(part(file), faceted=True))
    assert approximate(meant) == set()


@pytest.mark.parametrize(
    "mesh",
    [
        trimesh.creation.torus(0.03, 0.01, 6, 8),
        trimesh.creation.uv_sphere(0.02, count=[6, 6]),
        trimesh.creation.cone(0.02, 0.03, sections=7),
        trimesh.creation.icosahedron(),
    ],
    ids=["torus", "sphere", "cone", "icosahedron"],
)
def test_coarse_meshes_of_double_curvature_are_approximate(tmp_path: Path, mesh: trimesh.Trimesh) -> None:
    geometry = loaded(tmp_path, (np.array(mesh.vertices), np.array(mesh.faces)))
    curved = [facet for facet in geometry.facets if abs(unit(facet.normal)[2]) < 0.999]
    assert {facet.provenance.kind for facet in curved} == {"approximate"}


def test_a_square_bar_with_equal_chamfers_is_no_shaft(tmp_path: Path) -> None:
    c, s = 0.01, 0.04
    outline = [[c, 0], [s - c, 0], [s, c], [s, s - c], [s - c, s], [c, s], [0, s - c], [0, c]]
    assert approximate(loaded(tmp_path, prism(outline, 0.01))) == set()


@pytest.mark.parametrize("seed", range(4))
def test_vertices_that_are_off_by_more_than_they_are_written_to_are_noticed(tmp_path: Path, seed: int) -> None:
    vertices, triangles = seven_eighths(0.02)
    off = 1.3e-8
    shaken = vertices + off * np.random.default_rng(seed).uniform(-1, 1, vertices.shape)
    geometry = loaded(tmp_path, (shaken, triangles))
    assert all(unit(facet.normal).tolist().count(0.0) == 2 for facet in geometry.facets)
    assert all(0 < facet.squared < 1e-5 for facet in geometry.facets)
    assert "taken as square to the axes" in " ".join(geometry.notes)
    # turned, there are no axes to be square to: the error remains, and covers what is true
    turn = Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).as_matrix()
    turned = loaded(tmp_path, (shaken @ turn.T, triangles))
    for facet in turned.facets:
        true = turn @ np.round(turn.T @ unit(facet.normal))
        assert 1e-8 < np.linalg.norm(unit(facet.normal) - true) <= facet.normal_error < 1e-5


def test_a_flat_that_runs_into_fine_fillets_keeps_its_normal(tmp_path: Path) -> None:
    """Written to six decimals, the first strip of a fillet is a sliver, as its normal is hardly known."""
    r, s, steps = 0.002, 0.2, 24
    outline = []
    for x, y, start in ((s - r, r, -90), (s - r, s - r, 0), (r, s - r, 90), (r, r, 180)):
        for angle in np.radians(start + np.linspace(0, 90, steps + 1)):
            outline.append([x + r * np.cos(angle), y + r * np.sin(angle)])
    vertices, triangles = prism(outline, 0.1)
    turn = Rotation.from_euler("z", 0.3).as_matrix()
    geometry = loaded(tmp_path, (np.round(vertices @ turn.T, 6), triangles))
    sides = sorted(geometry.facets, key=lambda facet: -facet.width * np.hypot(*unit(facet.normal)[:2]))[:4]
    for facet in sides:
        true = turn @ np.round(turn.T @ unit(facet.normal))
        assert np.linalg.norm(unit(facet.normal) - true) <= facet.normal_error < 1e-3


@pytest.mark.parametrize("taper", [5e-5, 9e-5, 1.2e-4])
def test_a_taper_is_not_squared_away(tmp_path: Path, taper: float) -> None:
    vertices, triangles = box(0.05, 0.03, 0.02)
    tapered = vertices * np.where(vertices[:, 2:] > 0, [[1 - 0.02 / 0.025 * taper, 1, 1]], 1)
    geometry = loaded(tmp_path, (tapered, triangles))
    sides = [facet for facet in geometry.facets if abs(unit(facet.normal)[0]) > 0.9]
    assert [facet.squared for facet in sides] == [0.0, 0.0]
    for facet in sides:
        assert unit(facet.normal)[2] == pytest.approx(taper, rel=0.01)
        assert facet.normal_error < 1e-4
