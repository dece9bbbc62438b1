"""Sliding over surfaces: around a box, over spheres, through vertices, there and back, and never off real parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from fixture_design.errors import GeometryError, OffSurfaceError
from fixture_design.geometry import PartGeometry, load_part, slide
from fixture_design.geometry.nearest import touched_triangles
from tests.geometry.parts import Mesh, box, circle, l_shape, loaded, part, prism, seven_eighths, shared, unit, voxels


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("block"), box(0.05, 0.03, 0.02))


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    mesh = trimesh.creation.icosphere(4, 0.02)
    return loaded(tmp_path_factory.mktemp("ball"), (np.array(mesh.vertices), np.array(mesh.faces)))


def measured(path: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def some_place(geometry: PartGeometry, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A point on a triangle, by area, and a direction."""
    mesh = trimesh.Trimesh(geometry.vertices, geometry.triangles, process=False)
    triangle = rng.choice(len(mesh.faces), p=mesh.area_faces / mesh.area)
    return rng.dirichlet(np.ones(3)) @ mesh.triangles[triangle], rng.normal(size=3)


def test_straight_on_a_facet(block: PartGeometry) -> None:
    found = slide(block, np.array([0.0, 0.001, 0.01]), np.array([3.0, 0, 0]), 0.012)
    np.testing.assert_allclose(found.point, [0.012, 0.001, 0.01], atol=1e-16)
    np.testing.assert_allclose(found.direction, [1, 0, 0], atol=1e-15)
    assert block.facets[found.facet].name == "facet 4"
    assert found.length == 0.012


def test_around_four_faces_of_a_box_back_to_the_start(block: PartGeometry) -> None:
    start = np.array([0.004, 0.003, 0.01])
    seen = [slide(block, start, np.array([1.0, 0, 0]), way) for way in (0.03, 0.05, 0.1, 0.14)]
    assert [block.facets[spot.facet].name for spot in seen] == ["facet 6", "facet 3", "facet 1", "facet 4"]
    np.testing.assert_allclose(seen[0].point, [0.025, 0.003, 0.001], atol=1e-15)
    np.testing.assert_allclose(seen[0].direction, [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(seen[-1].point, start, atol=1e-15)
    np.testing.assert_allclose(seen[-1].direction, [1, 0, 0], atol=1e-15)


def test_into_a_concave_edge_and_up_the_wall(tmp_path: Path) -> None:
    ell = loaded(tmp_path, l_shape(0.04, 0.02))
    found = slide(ell, np.array([0.03, 0.02, 0.01]), np.array([-1.0, 0, 0]), 0.015)
    np.testing.assert_allclose(found.point, [0.02, 0.025, 0.01], atol=1e-15)


def test_oblique_around_a_prism_is_straight_when_unrolled(tmp_path: Path) -> None:
    shaft = loaded(tmp_path, prism(circle(0.01, 36), 0.1))
    chord = 0.02 * np.sin(np.pi / 36)
    start = np.array([0.01 * np.cos(np.pi / 36), 0, 0.01])
    start = (np.array([0.01, 0, 0.01]) + np.array([*circle(0.01, 36)[1], 0.01])) / 2
    tangent = unit([*(np.array(circle(0.01, 36)[1]) - [0.01, 0]), 0])
    # once around while climbing by 0.05
    found = slide(shaft, start, 36 * chord * tangent + np.array([0, 0, 0.05]), float(np.hypot(36 * chord, 0.05)))
    np.testing.assert_allclose(found.point, start + np.array([0, 0, 0.05]), atol=1e-14)


@pytest.mark.parametrize("seed", range(5))
def test_great_circles_of_a_ball(ball: PartGeometry, seed: int) -> None:
    start, direction = some_place(ball, np.random.default_rng(seed))
    way = 0.02 * np.pi / 2
    found = slide(ball, start, direction, way)
    tangent = unit(direction - (direction @ start) * start / (start @ start))
    # each vertex that is passed bends the path by up to half of what is missing there: 4 pi / 2562 on average
    assert np.linalg.norm(unit(found.point) - tangent) < 0.15
    assert measured(found.path) == pytest.approx(way, rel=1e-12)


@settings(max_examples=25)
@given(seed=st.integers(0, 100_000), way=st.floats(1e-4, 0.2))
def test_there_and_back(seed: int, way: float, block: PartGeometry, ball: PartGeometry) -> None:
    for geometry in (block, ball):
        start, direction = some_place(geometry, np.random.default_rng(seed))
        there = slide(geometry, start, direction, way)
        back = slide(geometry, there.point, -there.direction, way)
        assert measured(there.path) == pytest.approx(way, rel=1e-12)
        np.testing.assert_allclose(back.point, start, atol=1e-9)


@given(seed=st.integers(0, 100_000), way=st.floats(0.001, 0.1), cut=st.floats(0.1, 0.9))
def test_two_slides_are_one(seed: int, way: float, cut: float, block: PartGeometry) -> None:
    start, direction = some_place(block, np.random.default_rng(seed))
    halfway = slide(block, start, direction, cut * way)
    there = slide(block, halfway.point, halfway.direction, (1 - cut) * way)
    np.testing.assert_allclose(there.point, slide(block, start, direction, way).point, atol=1e-9)


def test_through_a_vertex_with_as_much_on_either_side(tmp_path: Path) -> None:
    cube = loaded(tmp_path, box(0.02, 0.02, 0.02))
    # along the diagonal of the top through a corner with three right angles: 135 degrees on either side
    found = slide(cube, np.array([0.005, 0.005, 0.01]), np.array([1.0, 1, 0]), 0.01 * np.sqrt(2) / 2 + 0.012)
    np.testing.assert_allclose(found.point, [0.01, 0.01, -0.002], atol=1e-15)
    np.testing.assert_allclose(found.direction, [0, 0, -1], atol=1e-15)
    # a vertex in the middle of a facet is none
    vertices, triangles = voxels({(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)}, 0.01)
    plate = loaded(tmp_path, (vertices, triangles), "plate.obj")
    found = slide(plate, np.array([0.002, 0.005, 0.01]), np.array([8.0, 5, 0]), 0.015)
    np.testing.assert_allclose(found.point, [0.002, 0.005, 0.01] + 0.015 * unit([8, 5, 0]), atol=1e-14)


@pytest.mark.parametrize("mesh", [box(0.02, 0.02, 0.02), seven_eighths(0.02), l_shape(0.02, 0.01)])
def test_from_vertices_and_edges_and_along_edges(tmp_path: Path, mesh: Mesh) -> None:
    geometry = loaded(tmp_path, mesh)
    rng = np.random.default_rng(0)
    ends = geometry.vertices[geometry.triangles]
    starts = np.vstack([geometry.vertices, (ends + np.roll(ends, 1, axis=1)).reshape(-1, 3) / 2])
    along = np.vstack([np.eye(3), -np.eye(3), rng.normal(size=(2, 3))])
    for start in starts:
        touched = touched_triangles(geometry, start, geometry.on_edge)
        normals = np.array([unit(geometry.facets[facet].normal) for facet in geometry.facet_of_triangle[touched]])
        for direction in along:
            if np.linalg.norm(np.cross(normals, direction), axis=1).max() < 1e-9:
                with pytest.raises(GeometryError, match="along the surface"):
                    slide(geometry, start, direction, 0.0173)
                continue
            found = slide(geometry, start, direction, 0.0173)
            assert abs(geometry.surface.at(found.point)[0]) < 1e-15
            assert measured(found.path) == pytest.approx(0.0173, rel=1e-9)
            assert abs(found.direction @ unit(geometry.facets[found.facet].normal)) < 1e-12


@pytest.mark.parametrize(
    ("file", "scale"),
    [
        ("trimesh/models/featuretype.STL", 0.0254),
        ("airo-models/airo_models/grippers/fingertips/originals/robotiq_adapter.stl", 0.001),
    ],
)
def test_two_hundred_walks_never_leave_a_real_part(file: str, scale: float) -> None:
    geometry = load_part(part(shared(file), scale))
    rng = np.random.default_rng(1)
    starts = [some_place(geometry, rng) for _ in range(200)]
    for start, direction in starts:
        way = float(rng.uniform(0.1, 0.5)) * geometry.half_diagonal
        found = slide(geometry, start, direction, way)
        assert found.length == way
        assert measured(found.path) == pytest.approx(way, rel=1e-6)
        distances = geometry.surface.distances(found.path)
        assert np.abs(distances).max() < 1e-9 * geometry.half_diagonal
        middles = geometry.surface.distances((found.path[1:] + found.path[:-1]) / 2)
        assert np.abs(middles).max() < 1e-9 * geometry.half_diagonal


def test_stops_where_more_than_two_triangles_meet(tmp_path: Path) -> None:
    # two cubes that touch along an edge
    geometry = loaded(tmp_path, voxels({(0, 0, 0), (1, 1, 0)}, 0.01))
    found = slide(geometry, np.array([0.005, 0.01, 0.005]), np.array([1.0, 0, 0]), 0.02)
    np.testing.assert_allclose(found.point, [0.01, 0.01, 0.005], atol=1e-15)
    assert found.length == pytest.approx(0.005)


def test_slides_that_are_none(block: PartGeometry) -> None:
    start, ahead = np.array([0.0, 0, 0.01]), np.array([1.0, 0, 0])
    assert slide(block, start, ahead, 0.0).point.tolist() == start.tolist()
    with pytest.raises(GeometryError, match="needs a direction"):
        slide(block, start, np.zeros(3), 0.01)
    with pytest.raises(GeometryError, match="along the surface"):
        slide(block, start, np.array([0.0, 0, 2]), 0.01)
    for length in (-1.0, np.nan, np.inf):
        with pytest.raises(GeometryError, match="0 or more"):
            slide(block, start, ahead, length)
    with pytest.raises(OffSurfaceError, match="start of a slide"):
        slide(block, np.array([0.0, 0, 0.011]), ahead, 0.01)
