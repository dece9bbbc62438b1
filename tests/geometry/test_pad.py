"""Pads against known overlaps and against every point of the overlap."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
import shapely.affinity
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import Contact, velocity
from fixture_design.errors import DimensionError, GeometryError, OffSurfaceError, UnsupportedError
from fixture_design.geometry import PartGeometry, contact_of, contacts_of_element
from fixture_design.layout import Element, PadTip, Pose
from tests.geometry.parts import box, circle, l_shape, loaded, prism, unit, voxels

IDENTITY = Pose.identity(3)
GAP = 1e-5
OUTLINE = [[0, 0], [0.1, 0], [0.1, 0.06], [0, 0.06]]
HOLE = circle(0.004, 48, (0.03, 0.03))
SLOT = [[0.06, 0.02], [0.065, 0.02], [0.065, 0.05], [0.06, 0.05]]


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    """A plate with a round hole and a slot, from z = 0 to 10 mm."""
    return loaded(tmp_path_factory.mktemp("plate"), prism(OUTLINE, 0.01, [HOLE, SLOT]))


def pad(
    geometry: PartGeometry, at: object, size: tuple[float, float], along: object = (1, 0, 0), pose: Pose = IDENTITY
) -> tuple[Contact, ...]:
    tip = PadTip(*size, np.array(along, dtype=float))
    return contacts_of_element(Element("K1", "clamp", np.array(at, dtype=float), tip), geometry, pose, 0.2, GAP)


def corners(contacts: tuple[Contact, ...]) -> list[list[float]]:
    return np.round([contact.point for contact in contacts], 12).tolist()


def test_pad_inside_a_facet_touches_with_its_corners(plate: PartGeometry) -> None:
    contacts = pad(plate, [0.015, 0.015, 0.01], (0.01, 0.004))
    assert corners(contacts) == [[0.01, 0.013, 0.01], [0.01, 0.017, 0.01], [0.02, 0.013, 0.01], [0.02, 0.017, 0.01]]
    assert [contact.name for contact in contacts] == ["K1#1", "K1#2", "K1#3", "K1#4"]
    for contact in contacts:
        ((normal,),) = contact.clauses
        np.testing.assert_array_equal(unit(normal), [0, 0, 1])
        assert (contact.friction, contact.role, contact.provenance.kind) == (0.2, "clamp", "exact")
        assert contact.feature == contacts[0].feature
        assert contact.distance == pytest.approx(0, abs=1e-15)


def test_overhang_is_cut_at_the_edge(plate: PartGeometry) -> None:
    contacts = pad(plate, [0.002, 0.003, 0.01], (0.01, 0.01))
    assert corners(contacts) == [[0, 0, 0.01], [0, 0.008, 0.01], [0.007, 0, 0.01], [0.007, 0.008, 0.01]]


def test_width_runs_along_the_projection(plate: PartGeometry) -> None:
    turned = pad(plate, [0.015, 0.015, 0.01], (0.01, 0.004), along=(0, 2, 5))
    assert corners(turned) == [[0.013, 0.01, 0.01], [0.013, 0.02, 0.01], [0.017, 0.01, 0.01], [0.017, 0.02, 0.01]]


def test_slot_is_bridged_and_its_walls_bound_a_pad_that_ends_in_it(plate: PartGeometry) -> None:
    across = pad(plate, [0.055, 0.03, 0.01], (0.03, 0.002))
    assert [c[0] for c in corners(across)] == pytest.approx([0.04, 0.04, 0.07, 0.07])
    ending = pad(plate, [0.055, 0.03, 0.01], (0.016, 0.002))
    assert [c[0] for c in corners(ending)] == pytest.approx([0.047, 0.047, 0.06, 0.06])


def test_two_solids_in_one_plane_count_as_one_facet(tmp_path: Path) -> None:
    (low, first), (high, second) = box(0.02, 0.02, 0.02), box(0.02, 0.02, 0.02)
    geometry = loaded(tmp_path, (np.vstack([low, high + np.array([0.03, 0, 0])]), np.vstack([first, second + 8])))
    contacts = pad(geometry, [0.005, 0.001, 0.01], (0.04, 0.004))
    assert corners(contacts) == [
        [-0.01, -0.001, 0.01],
        [-0.01, 0.003, 0.01],
        [0.025, -0.001, 0.01],
        [0.025, 0.003, 0.01],
    ]


@given(
    x=st.floats(0.001, 0.099),
    y=st.floats(0.001, 0.059),
    angle=st.floats(0, np.pi),
    width=st.floats(0.002, 0.05),
    height=st.floats(0.002, 0.05),
)
def test_hull_is_that_of_the_overlap_with_the_outline(
    plate: PartGeometry, x: float, y: float, angle: float, width: float, height: float
) -> None:
    """By another route: the outline with its holes as one polygon, without triangles.

    Where an edge of the pad lies along one of the outline's, a hair decides whether the edge is touched beyond it.
    """
    top = shapely.Polygon(OUTLINE, [HOLE, SLOT])
    if not top.buffer(-1e-6).contains(shapely.Point(x, y)):
        return
    rectangle = shapely.affinity.translate(
        shapely.affinity.rotate(shapely.box(-width / 2, -height / 2, width / 2, height / 2), angle, (0, 0), True), x, y
    )
    least, most = (
        shapely.convex_hull(shapely.intersection(top, rectangle.buffer(hair, join_style="mitre"))).buffer(1e-7)
        for hair in (-1e-9, 1e-9)
    )
    contacts = pad(plate, [x, y, 0.01], (width, height), (np.cos(angle), np.sin(angle), 0))
    found = shapely.convex_hull(shapely.multipoints([contact.point[:2] for contact in contacts]))
    assert most.contains(found)
    assert found.buffer(2e-7).contains(least)
    assert [c.name for c in contacts] == [f"K1#{k}" for k in range(1, len(contacts) + 1)]
    order = [tuple(np.round(contact.point, 9)) for contact in contacts]
    assert order == sorted(order)


def test_corners_allow_exactly_the_motions_that_all_of_the_overlap_allows(plate: PartGeometry) -> None:
    """Random motions against a thousand points of pad and facet: none of them may move into the pad."""
    rng = np.random.default_rng(3)
    contacts = pad(plate, [0.036, 0.03, 0.01], (0.02, 0.012), (1, 0.3, 0))
    top = shapely.Polygon(OUTLINE, [HOLE, SLOT])
    x, y = unit([1, 0.3]), unit([-0.3, 1])
    flat = np.array([0.036, 0.03]) + rng.uniform(-1, 1, (3000, 2)) @ np.array([0.01 * x, 0.006 * y])
    inside = flat[shapely.contains_xy(top, flat)]
    points = np.column_stack([inside, np.full(len(inside), 0.01)])
    allowed = 0
    for motion in rng.normal(size=(4000, 6)) * [1, 1, 0.02, 1, 1, 1]:
        by_corners = max(velocity(motion, contact.point)[2] for contact in contacts)
        by_points = (motion[2] + motion[3] * points[:, 1] - motion[4] * points[:, 0]).max()
        assert by_points <= by_corners + 1e-12
        # the sampled points come close to the corners
        assert by_corners <= by_points + 2e-3 * np.linalg.norm(motion[3:5])
        allowed += by_corners <= 0
    assert allowed > 100


def test_placed_part_gives_the_placed_pad(plate: PartGeometry) -> None:
    pose = Pose.from_xyz_rpy([0.3, -0.2, 0.1], [0.4, 0.5, 0.6])
    here = pad(plate, [0.055, 0.03, 0.01], (0.03, 0.02), (1, 1, 0))
    at, along = pose.points(np.array([[0.055, 0.03, 0.01]]))[0], pose.vectors(np.array([[1.0, 1, 0]]))[0]
    there = pad(plate, at, (0.03, 0.02), along, pose)
    moved = pose.points(np.array([contact.point for contact in here]))
    distances = np.linalg.norm(moved[:, None] - np.array([contact.point for contact in there]), axis=2)
    assert distances.min(axis=1).max() < 1e-15
    assert len(here) == len(there)


def test_pad_near_a_wall_is_an_error_with_place_and_depth(tmp_path: Path) -> None:
    """On the floor of an L, 6 mm from its wall, half of a pad of 20 mm reaches 4 mm behind it."""
    vertices, triangles = l_shape(0.04, 0.02)
    geometry = loaded(tmp_path, (vertices, triangles))
    assert len(pad(geometry, [0.03, 0.02, 0.01], (0.01, 0.01))) == 4
    with pytest.raises(GeometryError, match=r"K1.*pad cuts 4 mm into 'part' at \[0\.02, 0\.02, 0\.01\]"):
        pad(geometry, [0.026, 0.02, 0.01], (0.02, 0.01))
    assert len(pad(geometry, [0.026, 0.02, 0.01], (0.012 + GAP, 0.01))) == 4


def test_small_boss_under_a_pad_is_in_the_way(tmp_path: Path) -> None:
    cells = {(x, y, 0) for x in range(9) for y in range(9)}
    geometry = loaded(tmp_path, voxels(cells | {(6, 4, 1)}, 0.005))
    with pytest.raises(GeometryError, match="pad cuts"):
        pad(geometry, [0.0225, 0.0225, 0.005], (0.03, 0.03))
    assert len(pad(geometry, [0.0225, 0.0225, 0.005], (0.014, 0.03))) == 4


def test_where_a_pad_cannot_be(plate: PartGeometry, tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"K1.*centred on edge.*inside a facet"):
        pad(plate, [0.1, 0.03, 0.01], (0.01, 0.01))
    with pytest.raises(GeometryError, match=r"K1.*along the normal"):
        pad(plate, [0.015, 0.015, 0.01], (0.01, 0.004), (0, 0, 1))
    shaft = loaded(tmp_path, prism(circle(0.01, 24), 0.03))
    middle = 0.01 * np.cos(np.pi / 24) * np.array([np.cos(np.pi / 24), np.sin(np.pi / 24), 1.0])
    with pytest.raises(GeometryError, match=r"K1.*curved surface"):
        pad(shaft, middle, (0.01, 0.002), (0, 0, 1))
    with pytest.raises(OffSurfaceError, match="1 mm off"):
        pad(plate, [0.015, 0.015, 0.011], (0.01, 0.004))
    with pytest.raises(GeometryError, match="width and a height > 0"):
        pad(plate, [0.015, 0.015, 0.01], (0.01, 0.0))
    with pytest.raises(DimensionError, match=r"along.*3 coordinates"):
        pad(plate, [0.015, 0.015, 0.01], (0.01, 0.004), (1, 0))
    element = Element("K1", "clamp", np.zeros(3), PadTip(0.01, 0.01, np.array([1.0, 0, 0])))
    with pytest.raises(UnsupportedError, match=r"pad tips.*contacts_of_element"):
        contact_of(element, plate, IDENTITY, 0.0, GAP)


def test_floor_of_a_bore_takes_no_more_than_its_corners(tmp_path: Path) -> None:
    """A pad over the end of a shaft: the hull is the polygon of the shaft, whatever its triangles."""
    shaft = loaded(tmp_path, prism(circle(0.01, 24), 0.03))
    contacts = pad(shaft, [0.001, 0.002, 0.03], (0.05, 0.05))
    assert sorted(corners(contacts)) == sorted(np.round([[*xy, 0.03] for xy in circle(0.01, 24)], 12).tolist())
