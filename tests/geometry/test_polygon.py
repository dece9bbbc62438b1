"""Planar parts: contacts on edges and at vertices of polygons, and polygons that are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.errors import DimensionError, GeometryError, OffSurfaceError, UnsupportedError
from fixture_design.geometry import polygon_contact, polygon_of
from fixture_design.layout import Answer, Element, Layout, PadTip, Part, Pose
from fixture_design.verification import verify
from tests.geometry.parts import element, polygon_part, unit

#: The body of the thesis's figure 8: an apex at (-2, 0) between (-1, 1) and (-1, -1).
FIGURE_8 = [[-2, 0], [-1, -1], [3, -1], [3, 1], [-1, 1]]
L_SHAPE = [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]


def touch(vertices: object, at: object, radius: float | None = None, pose: Pose | None = None, gap: float = 1e-5):
    return polygon_contact(element(at, radius), polygon_part(vertices, pose), 0.2, gap)


@pytest.mark.parametrize(
    ("at", "clauses", "feature"),
    [
        ([1, 1], [[[0, 4]]], "facet 4"),
        ([0, -1], [[[0, -4]]], "facet 2"),
        ([3, 0], [[[2, 0]]], "facet 3"),
        ([-2, 0], [[[-1, 1], [-1, -1]]], "apex 1"),
        ([-1.5, 0.5], [[[-1, 1]]], "facet 5"),
    ],
)
def test_figure_8_of_the_thesis(at: list[float], clauses: list, feature: str) -> None:
    contact = touch(FIGURE_8, at)
    assert [[normal.tolist() for normal in clause] for clause in contact.clauses] == clauses
    assert contact.feature == feature
    assert contact.provenance.normal_error == 0
    assert contact.point.tolist() == at


def test_reflex_vertex_is_an_and_and_edges_in_one_line_are_one_facet() -> None:
    assert [[n.tolist() for n in clause] for clause in touch(L_SHAPE, [2, 2]).clauses] == [[[0, 2]], [[2, 0]]]
    for at in ([1, 0], [2, 0], [3, 0]):
        contact = touch(L_SHAPE, at)
        assert contact.feature == "facet 1"
        assert [normal.tolist() for normal in contact.normals] == [[0, -4]]
    rolled = touch(np.roll(L_SHAPE, -1, axis=0), [1, 0])
    assert rolled.feature == "facet 7"
    assert [normal.tolist() for normal in rolled.normals] == [[0, -4]]


@given(x=st.floats(-1, 5), y=st.floats(-1, 5))
def test_distance_is_that_of_shapely(x: float, y: float) -> None:
    shape, point = shapely.Polygon(L_SHAPE), shapely.Point(x, y)
    distance, nearest = polygon_of(polygon_part(L_SHAPE)).nearest(np.array([x, y]))
    assert abs(distance) == pytest.approx(shape.exterior.distance(point), abs=1e-12)
    assert shape.exterior.distance(shapely.Point(nearest)) < 1e-12
    if abs(distance) > 1e-9:
        assert (distance < 0) == shape.contains(point)


def test_placed_polygon() -> None:
    pose = Pose.from_xy_theta([5, 6], np.pi / 2)
    contact = touch(FIGURE_8, pose.points(np.array([[-2.0, 0.0]]))[0], pose=pose)
    np.testing.assert_allclose(contact.normals, [[-1, -1], [1, -1]], atol=1e-15)
    np.testing.assert_allclose(contact.point, [5, 4], atol=1e-15)


def test_off_the_surface() -> None:
    with pytest.raises(OffSurfaceError, match=r"'E1' is 500 mm off.*'polygon'.*facet 4"):
        touch(FIGURE_8, [1, 1.5])
    with pytest.raises(OffSurfaceError, match="inside"):
        touch(FIGURE_8, [1, 0.9])


def test_balls_in_the_plane() -> None:
    assert touch(L_SHAPE, [3, 2], 0.5).normals[0].tolist() == [0, 2]
    np.testing.assert_allclose(touch(FIGURE_8, [-2, 0], 0.5).normals[0], [-1, 0], atol=1e-15)
    assert touch(FIGURE_8, [-2, 0], 0.5).provenance.normal_error == pytest.approx(np.pi / 4)
    np.testing.assert_allclose(touch(FIGURE_8, [-2 - 3e-6, 1e-6], 0.5).normals[0], unit([-3, 1]), atol=1e-6)
    with pytest.raises(GeometryError, match="concave apex 5"):
        touch(L_SHAPE, [2, 2], 0.5)
    with pytest.raises(GeometryError, match=r"cuts 250 mm into facet 5.*room at \[2\.5, 2\.0\]"):
        touch(L_SHAPE, [2.25, 2], 0.5)
    with pytest.raises(GeometryError, match="radius > 0"):
        touch(L_SHAPE, [3, 2], 0.0)


def test_unusable_elements() -> None:
    with pytest.raises(UnsupportedError, match="pad tips"):
        polygon_contact(
            Element("P", "clamp", np.zeros(2), PadTip(1.0, 1.0, np.array([1.0, 0]))), polygon_part(L_SHAPE), 0.0, 1e-5
        )
    with pytest.raises(DimensionError, match="2 coordinates"):
        touch(L_SHAPE, [0, 0, 0])


@pytest.mark.parametrize(
    ("vertices", "words"),
    [
        ([[0, 0], [1, 0]], "three or more"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "three or more"),
        ([[0, 0], [1, 0], [np.nan, 1]], "not finite.*vertex 3"),
        (L_SHAPE[::-1], "clockwise.*counter-clockwise"),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], "twice.*vertices 2 and 3"),
        ([[0, 0], [1, 0], [1, 1], [0, 0]], "twice.*vertices 1 and 4"),
        ([[0, 0], [2, 2], [2, 0], [0, 1]], "not simple.*Self-intersection"),
        ([[0, 0], [1, 0], [2, 0]], "not simple|no area"),
        ([[0, 0], [2, 0], [2, 2], [2, 0.5], [0, 2]], "not simple"),
    ],
)
def test_polygons_that_are_none(vertices: list, words: str) -> None:
    with pytest.raises(GeometryError, match=f"'polygon'.*({words})"):
        polygon_of(polygon_part(vertices))


def ring(count: int, turn: float = 0.0) -> np.ndarray:
    angles = 2 * np.pi * np.arange(count) / count + turn
    return np.column_stack([np.cos(angles), np.sin(angles)])


@pytest.mark.parametrize("count", [12, 64, 200])
def test_a_polygon_that_stands_for_a_disc_is_never_form_closed(count: int) -> None:
    """Facet normals of a tessellated disc suggest closure; a disc always spins."""
    rng = np.random.default_rng(count)
    disc = Part("disc", "polygon", None, ring(count), 1.0, Pose.identity(2))
    for _ in range(10):
        angles = rng.uniform(0, 2 * np.pi, size=5)
        at = np.column_stack([np.cos(angles), np.sin(angles)])
        elements = tuple(Element(f"E{i}", "locator", point) for i, point in enumerate(at))
        layout = Layout("disc", "planar", disc, surface_gap=0.1, elements=elements)
        assert verify(layout).groups["all"].findings["form_closure"].answer is not Answer.YES


def test_a_bow_of_small_turns_is_no_exact_facet() -> None:
    """Two hundred edges that turn 9e-5 each are nearly one line, and their mean normal is off by what they turn."""
    headings = 9e-5 * np.arange(200)
    bow = np.cumsum(np.column_stack([np.cos(headings), np.sin(headings)]), axis=0)
    polygon = polygon_of(Part("bow", "polygon", None, np.vstack([bow, [[0, 100.0]]]), 1.0, Pose.identity(2)))
    surface = polygon.local((bow[0] + bow[1]) / 2)
    assert surface.provenance.normal_error > 8e-3


@pytest.mark.parametrize("count", [5, 6, 8, 10])
def test_a_regular_polygon_may_be_a_coarse_circle_until_the_designer_says_that_it_is_none(count: int) -> None:
    part = Part("bar", "polygon", None, ring(count), 1.0, Pose.identity(2))
    unsure = polygon_of(part).provenance.values()
    assert {provenance.kind for provenance in unsure} == {"approximate"}
    assert {round(provenance.normal_error, 9) for provenance in unsure} == {round(np.pi / count, 9)}
    meant = polygon_of(replace(part, faceted=True)).provenance.values()
    assert {provenance.kind for provenance in meant} == {"exact"}


def test_a_square_with_chamfers_has_exact_facets() -> None:
    """Its eight corners lie on a circle, yet its sides are not equal."""
    outline = np.array([[3, -1], [3, 1], [1, 3], [-1, 3], [-3, 1], [-3, -1], [-1, -3], [1, -3]], dtype=float)
    polygon = polygon_of(Part("block", "polygon", None, outline, 1.0, Pose.identity(2)))
    assert {provenance.kind for provenance in polygon.provenance.values()} == {"exact"}
