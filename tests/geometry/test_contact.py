"""Contacts of elements with solids: facets, edges and apices of boxes and of non-convex parts, and known answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import Contact
from fixture_design.errors import DimensionError, GeometryError, OffSurfaceError, UnsupportedError
from fixture_design.geometry import PartGeometry, contact_of
from fixture_design.geometry.nearest import distances
from fixture_design.layout import Element, PadTip, Pose
from tests.geometry.parts import box, circle, element, l_shape, loaded, prism, seven_eighths, unit, voxels

IDENTITY = Pose.identity(3)
HALF = np.array([0.025, 0.015, 0.01])
GAP = 1e-5


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("block"), box(*(2 * HALF)))


@pytest.fixture(scope="module")
def notched(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    """A cube of 40 mm without one octant."""
    return loaded(tmp_path_factory.mktemp("notched"), seven_eighths(0.04))


def touch(geometry: PartGeometry, at: object, radius: float | None = None, pose: Pose = IDENTITY) -> Contact:
    return contact_of(element(at, radius), geometry, pose, 0.2, GAP)


def directions(contact: Contact) -> list[set[tuple[float, ...]]]:
    """Clauses as sets of rounded unit normals."""
    return [{tuple((np.round(unit(n), 9) + 0.0).tolist()) for n in clause} for clause in contact.clauses]


X, Y, Z = (1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)


@pytest.mark.parametrize(
    ("at", "clauses", "feature"),
    [
        ([0.025, 0.001, 0.002], [{X}], "facet 6"),
        ([-0.02, 0.004, 0.01], [{Z}], "facet 4"),
        ([0.025, 0.015, 0.002], [{X, Y}], "edge facet 5 | facet 6"),
        ([0.025, 0.015, 0.01], [{X, Y, Z}], "apex facet 4 | facet 5 | facet 6"),
        ([0.025 + 3e-6, 0.001, 0.002], [{X}], "facet 6"),
        ([0.025 - 3e-6, 0.001, 0.002], [{X}], "facet 6"),
    ],
)
def test_places_on_a_box(block: PartGeometry, at: list[float], clauses: list, feature: str) -> None:
    contact = touch(block, at)
    assert directions(contact) == clauses
    assert contact.feature == feature
    assert contact.provenance.kind == "exact"
    assert contact.provenance.normal_error == 0
    assert contact.distance == pytest.approx(at[0] - 0.025 if abs(at[0] - 0.025) < GAP else 0.0, abs=1e-15)
    assert (contact.name, contact.role, contact.friction) == ("E1", "locator", 0.2)


@given(at=st.tuples(*[st.floats(-1, 1)] * 3), axis=st.integers(0, 2), side=st.sampled_from([-1, 1]))
def test_facet_contacts_of_a_box_everywhere(block: PartGeometry, at: tuple, axis: int, side: int) -> None:
    point = 0.999 * HALF * np.array(at)
    point[axis] = side * HALF[axis]
    contact = touch(block, point)
    assert directions(contact) == [{tuple(((np.eye(3)[axis] * side) + 0.0).tolist())}]
    np.testing.assert_allclose(contact.point, point, atol=1e-16)


@pytest.mark.parametrize(
    ("at", "clauses"),
    [
        ([0.03, 0.03, 0.02], [{Z}]),
        ([0.03, 0.02, 0.02], [{Y}, {Z}]),
        ([0.02, 0.02, 0.02], [{X}, {Y}, {Z}]),
        ([0.02, 0.04, 0.03], [{X, Y}]),
        ([0.02, 0.02, 0.04], [{X, Z}, {Y, Z}]),
        ([0.02, 0.04, 0.02], [{X, Y}, {Y, Z}]),
        ([0.02, 0.04, 0.04], [{X, Y, Z}]),
        ([0.04, 0.04, 0.0], [{X, Y, (0, 0, -1.0)}]),
    ],
    ids=["notch floor", "concave edge", "inner corner", "convex edge", "saddle", "saddle 2", "apex", "outer apex"],
)
def test_places_in_a_notch(notched: PartGeometry, at: list[float], clauses: list) -> None:
    found = directions(touch(notched, at))
    assert sorted(map(sorted, found)) == sorted(map(sorted, clauses))


def test_logic_of_every_corner_is_what_looking_into_the_part_says(tmp_path: Path) -> None:
    """A point tip may go where there is no material: brute force over random motions, on a heap of cubes."""
    cells = {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (2, 0, 0), (2, 1, 0), (2, 1, 1), (1, 2, 0)}
    size = 0.01
    geometry = loaded(tmp_path, voxels(cells, size))
    assert geometry.is_one_shell
    motions = np.random.default_rng(5).normal(size=(200, 3))
    looked_at = 0
    for vertex in geometry.vertices:
        contact = touch(geometry, vertex)
        for motion in motions:
            # the part moves by v, so the tip moves by -v in it
            cell = tuple(np.floor((vertex - 1e-3 * size * motion) / size).astype(int).tolist())
            admissible = all(any(normal @ motion <= 0 for normal in clause) for clause in contact.clauses)
            assert admissible == (cell not in cells), contact.feature
            looked_at += 1
    assert looked_at == 200 * len(geometry.vertices)


def test_distance_and_point_agree_with_brute_force_over_triangles(notched: PartGeometry) -> None:
    corners = notched.vertices[notched.triangles]
    for point in np.random.default_rng(6).uniform(-0.01, 0.05, (300, 3)):
        distance, nearest = notched.surface.at(point)
        assert abs(distance) == pytest.approx(distances(corners, point).min(), abs=1e-15)
        assert distances(corners, nearest).min() < 1e-15
        solid = (point > 0).all() and (point < 0.04).all() and not (point > 0.02).all()
        assert (distance < 0) == solid


def test_normal_on_random_places_is_that_of_the_triangle_there(notched: PartGeometry) -> None:
    rng = np.random.default_rng(7)
    for triangle in notched.triangles:
        corners = notched.vertices[triangle]
        weights = rng.dirichlet(np.full(3, 5.0))
        contact = touch(notched, weights @ corners)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        (clause,) = contact.clauses
        np.testing.assert_allclose([unit(n) for n in clause], [unit(normal)], atol=1e-15)


def test_placed_part_gives_the_placed_contact(notched: PartGeometry) -> None:
    pose = Pose.from_xyz_rpy([0.3, -0.2, 0.1], [0.4, 0.5, 0.6])
    for at in ([0.03, 0.03, 0.02], [0.03, 0.02, 0.02], [0.02, 0.02, 0.04]):
        here, there = touch(notched, at), touch(notched, pose.points(np.array([at]))[0], pose=pose)
        np.testing.assert_allclose(there.point, pose.points(here.point[None])[0], atol=1e-15)
        np.testing.assert_allclose(there.normals, pose.vectors(np.array(here.normals)), atol=1e-15)
        assert there.feature == here.feature


@pytest.mark.parametrize("offset", [4.2e-3, -2e-4])
def test_off_the_surface_is_an_error_with_the_distance(block: PartGeometry, offset: float) -> None:
    with pytest.raises(OffSurfaceError) as caught:
        contact_of(element([0.025 + offset, 0.001, 0.002]), block, IDENTITY, 0.0, GAP, "bracket")
    assert caught.value.distance == pytest.approx(offset)
    assert caught.value.feature == "facet 6"
    for word in ("E1", "bracket", "4.2 mm off" if offset > 0 else "200 um inside", "10 um"):
        assert word in str(caught.value)


def test_friction_of_the_element_comes_first(block: PartGeometry) -> None:
    assert contact_of(element([0.025, 0, 0], friction=0.5), block, IDENTITY, 0.2, GAP).friction == 0.5


def test_unusable_elements(block: PartGeometry) -> None:
    with pytest.raises(UnsupportedError, match=r"'P'.*pad tips.*point or sphere"):
        contact_of(
            Element("P", "locator", np.zeros(3), PadTip(0.01, 0.01, np.array([1.0, 0, 0]))), block, IDENTITY, 0.0, GAP
        )
    with pytest.raises(DimensionError, match="3 coordinates"):
        touch(block, [0.025, 0])
    with pytest.raises(GeometryError, match="not finite"):
        touch(block, [np.nan, 0, 0])


@pytest.mark.parametrize("count", [12, 48])
def test_shaft_has_one_normal_on_strips_and_between_them(tmp_path: Path, count: int) -> None:
    geometry = loaded(tmp_path, prism(circle(0.01, count), 0.03))
    step = 2 * np.pi / count
    for angle in (step / 2, step, 0.7 * step):
        apothem = 0.01 * np.cos(step / 2)
        radius = apothem / np.cos((angle % step) - step / 2)
        contact = touch(geometry, [radius * np.cos(angle), radius * np.sin(angle), 0.01])
        ((normal,),) = contact.clauses
        true = np.array([np.cos(angle), np.sin(angle), 0])
        assert contact.provenance.kind == "fitted"
        assert np.linalg.norm(unit(normal) - true) <= contact.provenance.normal_error < 1e-12
        assert contact.feature == "cylinder 1"
        # on the shaft, not on the chord
        assert np.hypot(*contact.point[:2]) == pytest.approx(0.01, rel=1e-12)


def test_a_place_on_the_true_shaft_is_on_its_surface_though_off_the_mesh(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, prism(circle(0.01, 16), 0.03))
    contact = touch(geometry, [0.01 * np.cos(np.pi / 16), 0.01 * np.sin(np.pi / 16), 0.01])
    assert contact.distance == pytest.approx(0, abs=1e-12)


def test_rim_of_a_shaft_is_an_or_of_two_and_of_a_bore_too(tmp_path: Path) -> None:
    shaft = loaded(tmp_path, prism(circle(0.01, 24), 0.03))
    for angle in (0.0, np.pi / 24):
        radius = 0.01 if angle == 0 else 0.01 * np.cos(np.pi / 24)
        radial = (np.cos(angle), np.sin(angle), 0)
        (clause,) = touch(shaft, [radius * radial[0], radius * radial[1], 0.03]).clauses
        np.testing.assert_allclose(sorted(unit(n).tolist() for n in clause), sorted([list(radial), list(Z)]), atol=1e-9)
    blind = loaded(tmp_path, prism(circle(0.03, 4), 0.03, [circle(0.01, 24)]))
    clauses = touch(blind, [0.01, 0, 0.03]).clauses
    assert [len(clause) for clause in clauses] == [2]


def test_tip_of_a_cone_is_unsupported(tmp_path: Path) -> None:
    import trimesh

    cone = trimesh.creation.cone(0.02, 0.03, sections=36)
    geometry = loaded(tmp_path, (np.array(cone.vertices), np.array(cone.faces)))
    with pytest.raises(UnsupportedError, match=r"E1.*no normal"):
        touch(geometry, [0, 0, 0.03])


def test_inner_edge_of_an_l_of_two_touching_boxes(tmp_path: Path) -> None:
    """Solids that share a face are one body: what lies between them is inside."""
    (low, first), (high, second) = box(0.04, 0.04, 0.02), box(0.02, 0.04, 0.02)
    vertices = np.vstack([low, high + np.array([-0.01, 0, 0.02])])
    geometry = loaded(tmp_path, (vertices, np.vstack([first, second + 8])))
    assert sorted(map(sorted, directions(touch(geometry, [0.0, 0.0, 0.01])))) == [[Z], [X]]
    assert directions(touch(geometry, [-0.02, 0.0, 0.01])) == [{(-1.0, 0, 0)}]
    with pytest.raises(GeometryError, match="inside the part"):
        touch(geometry, [-0.01, 0.003, 0.01])


def test_l_shape_matches_its_own_boxes(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, l_shape(0.04, 0.02))
    assert directions(touch(geometry, [0.02, 0.02, 0.01])) in ([{X}, {Y}], [{Y}, {X}])
