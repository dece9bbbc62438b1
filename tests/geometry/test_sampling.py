"""Candidate points: on the surface, spaced, within the rules, reproducible; grids, given points, polygons."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from fixture_design.errors import GeometryError, OffSurfaceError
from fixture_design.geometry import (
    Box,
    PartGeometry,
    SamplingRules,
    SurfacePoints,
    given_points,
    given_polygon_points,
    grid_points,
    load_part,
    polygon_of,
    sample_polygon,
    sample_surface,
)
from fixture_design.layout import Pose
from tests.geometry.parts import box, circle, l_shape, loaded, part, polygon_part, prism, shared, unit

HERE = Pose.identity(3)
L_SHAPE = [[0, 0], [0.04, 0], [0.04, 0.02], [0.02, 0.02], [0.02, 0.04], [0, 0.04]]
FEATURETYPE = "trimesh/models/featuretype.STL"
ADAPTER = "airo-models/airo_models/grippers/fingertips/originals/robotiq_adapter.stl"


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("block"), box(0.05, 0.03, 0.02))


@pytest.fixture(scope="module")
def ell(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("ell"), l_shape(0.04, 0.02))


def closest(found: SurfacePoints, geometry: PartGeometry) -> float:
    """The smallest distance between two points whose facets' normals are not opposite."""
    flat = np.array([unit(geometry.facets[facet].normal) for facet in found.facets.tolist()])
    pairs = KDTree(found.points).query_pairs(0.01, output_type="ndarray")
    pairs = pairs[np.einsum("ij,ij->i", *(flat[pairs[:, side]] for side in (0, 1))) > -0.5]
    return float(np.linalg.norm(found.points[pairs[:, 0]] - found.points[pairs[:, 1]], axis=1).min(initial=0.01))


def anywhere(geometry: PartGeometry, count: int = 5000) -> np.ndarray:
    mesh = trimesh.Trimesh(geometry.vertices, geometry.triangles, process=False)
    return trimesh.sample.sample_surface(mesh, count, seed=1)[0]


def to_box_edges(points: np.ndarray, sides: tuple[float, ...]) -> np.ndarray:
    """Distance to the edges of a box: from the second of the three distances to its faces."""
    return np.sort(np.array(sides) / 2 - np.abs(points), axis=1)[:, 1]


def test_points_are_on_the_surface_spaced_and_leave_no_holes(ell: PartGeometry) -> None:
    found = sample_surface(ell, HERE, 0.003)
    assert np.abs(ell.surface.distances(found.points)).max() < 1e-9 * ell.half_diagonal
    assert closest(found, ell) >= 0.003
    assert KDTree(found.points).query(anywhere(ell))[0].max() < 1.2 * 0.003
    assert 350 < len(found) < 800  # 0.7 or more for each square of the spacing's side
    for normal, facet, feature, provenance in zip(
        found.normals, found.facets.tolist(), found.features, found.provenance, strict=True
    ):
        owner = ell.facets[facet]
        np.testing.assert_allclose(np.linalg.norm(owner.normal) * normal, owner.normal, atol=1e-15)
        assert feature == owner.name
        assert provenance == owner.provenance


def test_each_point_lies_in_the_plane_of_its_facet(ell: PartGeometry) -> None:
    found = sample_surface(ell, HERE, 0.004)
    centroids = np.array([ell.facets[facet].centroid for facet in found.facets])
    assert np.abs(np.einsum("ij,ij->i", found.points - centroids, found.normals)).max() < 1e-15


@pytest.mark.parametrize(("file", "scale", "spacing"), [(FEATURETYPE, 0.0254, 0.006), (ADAPTER, 0.001, 0.003)])
def test_real_parts(file: str, scale: float, spacing: float) -> None:
    geometry = load_part(part(shared(file), scale))
    found = sample_surface(geometry, HERE, spacing)
    assert np.abs(geometry.surface.distances(found.points)).max() < 1e-9 * geometry.half_diagonal
    assert closest(found, geometry) >= spacing
    assert KDTree(found.points).query(anywhere(geometry))[0].max() < 1.5 * spacing
    # a step along the normal leads out of the material
    out = geometry.surface.distances(found.points + 1e-6 * found.normals)
    assert (out > 0).mean() > 0.99


def test_same_seed_same_points_and_another_seed_others(ell: PartGeometry) -> None:
    first, again, other = (sample_surface(ell, HERE, 0.005, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.points, again.points)
    assert first.features == again.features
    assert len(other) != len(first) or not np.allclose(other.points, first.points)


def test_the_stream_of_random_numbers_is_the_same_in_all_versions() -> None:
    np.testing.assert_allclose(
        np.random.default_rng(0).random(3), [0.6369616873214543, 0.2697867137638703, 0.04097352393619469], rtol=1e-15
    )


@settings(max_examples=20)
@given(xyz=st.tuples(*[st.floats(-1, 1)] * 3), rpy=st.tuples(*[st.floats(-3, 3)] * 3))
def test_moved_part_has_moved_points(xyz: tuple[float, ...], rpy: tuple[float, ...], block: PartGeometry) -> None:
    pose = Pose.from_xyz_rpy(xyz, rpy)
    still, moved = (sample_surface(block, X_WP, 0.01) for X_WP in (HERE, pose))
    np.testing.assert_allclose(moved.points, pose.points(still.points), atol=1e-14)
    np.testing.assert_allclose(moved.normals, pose.vectors(still.normals), atol=1e-14)


def test_margin_keeps_away_from_edges_and_uses_what_is_left(block: PartGeometry) -> None:
    found = sample_surface(block, HERE, 0.004, SamplingRules(edge_margin=0.005))
    away = to_box_edges(found.points, (0.05, 0.03, 0.02))
    assert away.min() >= 0.005
    assert away.min() < 0.0055
    assert {"facet 1", "facet 6"} <= set(found.features)


def test_strips_of_a_shaft_have_no_edges_but_its_ends_have(tmp_path: Path) -> None:
    shaft = loaded(tmp_path, prism(circle(0.01, 48), 0.03))
    found = sample_surface(shaft, HERE, 0.003, SamplingRules(edge_margin=0.004))
    around = np.abs(found.normals[:, 2]) < 0.5
    assert around.sum() > 50
    assert found.points[around][:, 2].min() >= 0.004
    assert found.points[around][:, 2].max() <= 0.026
    assert np.linalg.norm(found.points[~around][:, :2], axis=1).max() <= 0.006


def test_round_surfaces_give_their_own_normals(tmp_path: Path) -> None:
    sleeve = loaded(tmp_path, prism(circle(0.02, 60), 0.03, [circle(0.01, 48)]))
    found = sample_surface(sleeve, HERE, 0.003)
    around = np.abs(found.normals[:, 2]) < 0.5
    across = np.linalg.norm(found.points[:, :2], axis=1)
    radial = np.column_stack([found.points[:, :2] / across[:, None], np.zeros(len(found))])
    side = np.where(across > 0.015, 1.0, -1.0)[:, None]
    assert {-1.0, 1.0} == set(side[around].ravel().tolist())
    np.testing.assert_allclose(found.normals[around], (side * radial)[around], atol=1e-6)
    assert [sleeve.provenance_of(facet) for facet in found.facets.tolist()] == list(found.provenance)


def test_only_facets_that_are_allowed(ell: PartGeometry) -> None:
    found = sample_surface(ell, HERE, 0.004, SamplingRules(facets=[3, 4]))
    assert set(found.features) == {"facet 3", "facet 4"}
    with pytest.raises(GeometryError, match="no facet 9") as caught:
        sample_surface(ell, HERE, 0.004, SamplingRules(facets=[3, 9]))
    assert caught.value.expected == "numbers of 1 to 8"


def test_boxes_are_in_the_world(block: PartGeometry) -> None:
    X_WP = Pose.from_xyz_rpy([1, 2, 3], [0, 0, np.pi / 2])  # the long side is now along y
    out = Box(np.array([0.0, 2.01, 0]), np.array([2.0, 4, 5]))
    keep = Box(np.array([0.0, 1.98, 0]), np.array([2.0, 4, 5]))
    found = sample_surface(block, X_WP, 0.004, SamplingRules(keep_out=[out], keep_in=[keep]))
    assert 1.98 <= found.points[:, 1].min() < 1.983
    assert 2.007 < found.points[:, 1].max() < 2.01


def test_nothing_left_says_which_rule_took_how_many(block: PartGeometry) -> None:
    with pytest.raises(GeometryError, match="no candidate points are left") as caught:
        sample_surface(block, HERE, 0.004, SamplingRules(edge_margin=0.016))
    assert "edge_margin" in str(caught.value.found)
    assert "16 mm" in str(caught.value.expected)
    everywhere = Box(np.full(3, -1.0), np.full(3, 1.0))
    with pytest.raises(GeometryError, match=r"removed by keep_out \d+"):
        sample_surface(block, HERE, 0.004, SamplingRules(keep_out=[everywhere]))


def test_rules_and_spacings_that_are_none(block: PartGeometry) -> None:
    for spacing in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(GeometryError, match="length > 0"):
            sample_surface(block, HERE, spacing)
    with pytest.raises(GeometryError, match="too small"):
        sample_surface(block, HERE, 1e-6)
    with pytest.raises(GeometryError, match="0 or more"):
        SamplingRules(edge_margin=-1.0)
    with pytest.raises(GeometryError, match="lowest"):
        SamplingRules(keep_in=[Box(np.ones(3), np.zeros(3))])


def test_both_sides_of_a_thin_wall_are_covered(tmp_path: Path) -> None:
    sheet = loaded(tmp_path, box(0.05, 0.05, 0.001))
    found = sample_surface(sheet, HERE, 0.005, SamplingRules(edge_margin=0.0006))
    top, bottom = ((found.normals[:, 2] * side > 0.5).sum() for side in (1, -1))
    assert min(top, bottom) > 50


def test_grid_meets_top_and_bottom_over_the_holes(ell: PartGeometry) -> None:
    found = grid_points(ell, HERE, np.array([0.005, 0.005, -1.0]), 0.01)
    assert set(np.round(found.points[:, 2], 15).tolist()) == {0.0, 0.02}
    on_top = found.points[found.normals[:, 2] > 0][:, :2]
    expected = [[x, y] for x in (5, 15, 25, 35) for y in (5, 15, 25, 35) if x < 20 or y < 20]
    np.testing.assert_allclose(sorted(np.round(on_top * 1000, 9).tolist()), sorted(expected))
    assert len(found) == 24


def test_grid_on_an_edge_between_triangles_counts_once_and_other_planes_work(block: PartGeometry) -> None:
    found = grid_points(block, HERE, np.zeros(3), 0.005, "yz", SamplingRules(edge_margin=1e-4))
    assert set(np.round(found.points[:, 0], 12).tolist()) == {-0.025, 0.025}
    assert len(found) == len({tuple(point) for point in np.round(found.points, 12).tolist()}) == 2 * 5 * 3
    assert len(grid_points(block, HERE, np.zeros(3), 0.005, "xz", SamplingRules(facets=[2], edge_margin=1e-4))) == 27


def test_grid_that_misses_says_so(block: PartGeometry) -> None:
    with pytest.raises(GeometryError, match="0 points tried"):
        grid_points(block, HERE, np.array([0.05, 0.05, 0]), 0.1)


def test_given_points_move_onto_the_surface(block: PartGeometry) -> None:
    X_WP = Pose.from_xyz_rpy([1, 2, 3], [0, 0, np.pi / 2])
    chosen = X_WP.points(np.array([[0.025 + 1e-6, 0.001, 0.002], [0.01, 0.015, 0.0]]))
    found = given_points(block, X_WP, chosen)
    assert found.features == ("facet 6", "facet 5")
    np.testing.assert_allclose(
        X_WP.inverse().points(found.points), [[0.025, 0.001, 0.002], [0.01, 0.015, 0]], atol=1e-15
    )
    np.testing.assert_allclose(found.normals, [[0, 1, 0], [-1, 0, 0]], atol=1e-15)
    with pytest.raises(OffSurfaceError, match="'candidate 2' is 1 mm off"):
        given_points(block, HERE, np.array([[0.025, 0, 0], [0.026, 0, 0]]))
    with pytest.raises(GeometryError, match="removed by facets 2"):
        given_points(block, X_WP, chosen, SamplingRules(facets=[1]))


def test_points_along_a_polygon() -> None:
    polygon = polygon_of(polygon_part(L_SHAPE))
    found = sample_polygon(polygon, Pose.identity(2), 0.003, SamplingRules(edge_margin=0.002))
    assert max(abs(polygon.nearest(point)[0]) for point in found.points) < 1e-17
    assert KDTree(found.points).query(found.points, 2)[0][:, 1].min() >= 0.003 - 1e-15
    away = KDTree(polygon.vertices).query(found.points)[0]
    assert 0.002 - 1e-10 <= away.min() < 0.004
    steps = np.linspace(0, 1, 101)[:, None]
    walk = np.vstack([start + steps * edge for start, edge in zip(polygon.vertices, polygon.edges, strict=True)])
    walk = walk[KDTree(polygon.vertices).query(walk)[0] >= 0.002]
    assert KDTree(found.points).query(walk)[0].max() < 1.5 * 0.003
    np.testing.assert_allclose(found.normals[found.facets == 1], [[1, 0]] * int((found.facets == 1).sum()))
    assert set(found.features) == {f"facet {number}" for number in range(1, 7)}
    only = sample_polygon(polygon, Pose.identity(2), 0.003, SamplingRules(facets=[2, 5]))
    assert set(only.features) == {"facet 2", "facet 5"}


def test_moved_polygon_and_boxes_in_the_world() -> None:
    polygon, pose = polygon_of(polygon_part(L_SHAPE)), Pose.from_xy_theta([1, 2], 0.7)
    still, moved = (sample_polygon(polygon, X_WP, 0.003) for X_WP in (Pose.identity(2), pose))
    np.testing.assert_allclose(moved.points, pose.points(still.points), atol=1e-15)
    np.testing.assert_allclose(moved.normals, pose.vectors(still.normals), atol=1e-15)
    rules = SamplingRules(keep_out=[Box(np.array([0.0, 0]), np.array([0.05, 0.02]))])
    assert sample_polygon(polygon, Pose.identity(2), 0.003, rules).points[:, 1].min() > 0.02


def test_arcs_of_a_polygon_have_no_apices() -> None:
    polygon = polygon_of(polygon_part(circle(0.01, 60)))
    found = sample_polygon(polygon, Pose.identity(2), 0.003, SamplingRules(edge_margin=0.005))
    assert 14 <= len(found) <= 21


def test_polygon_rules_that_cannot_be_met() -> None:
    polygon = polygon_of(polygon_part([[0, 0], [1, 0], [2, 0], [2, 1], [0, 1]]))
    with pytest.raises(GeometryError, match="no facet 2") as caught:
        sample_polygon(polygon, Pose.identity(2), 0.1, SamplingRules(facets=[2]))
    assert caught.value.expected == "one of 1, 3, 4, 5"
    with pytest.raises(GeometryError, match="removed by edge_margin"):
        sample_polygon(polygon, Pose.identity(2), 0.1, SamplingRules(edge_margin=1.1))
    with pytest.raises(GeometryError, match="too small"):
        sample_polygon(polygon, Pose.identity(2), 1e-6)


def test_given_points_of_a_polygon() -> None:
    polygon = polygon_of(polygon_part(L_SHAPE))
    found = given_polygon_points(polygon, Pose.identity(2), np.array([[0.04, 0.01], [0.02, 0.02], [0.01, -1e-6]]))
    assert found.features == ("facet 2", "facet 4", "facet 1")
    np.testing.assert_allclose(found.points[2], [0.01, 0])
    with pytest.raises(OffSurfaceError, match="'candidate 1'"):
        given_polygon_points(polygon, Pose.identity(2), np.array([[0.05, 0.01]]))
