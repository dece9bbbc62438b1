"""Ball tips: their normals on facets and edges, and whether there is room for them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry import PartGeometry, contact_of
from fixture_design.layout import Pose
from tests.geometry.parts import circle, element, l_shape, loaded, prism, seven_eighths, unit

IDENTITY = Pose.identity(3)
GAP = 1e-5


@pytest.fixture(scope="module")
def notched(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("notched"), seven_eighths(0.04))


def ball(geometry: PartGeometry, at: object, radius: float = 0.004, gap: float = GAP):
    return contact_of(element(at, radius), geometry, IDENTITY, 0.0, gap)


def test_on_a_facet_it_is_the_facets_normal(notched: PartGeometry) -> None:
    contact = ball(notched, [0.0, 0.01, 0.01])
    assert unit(contact.normals[0]).tolist() == [-1, 0, 0]
    assert contact.provenance.kind == "exact"


def test_on_a_convex_edge_it_is_where_the_ball_was_asked_to_be(notched: PartGeometry) -> None:
    away = unit([-1.0, -2.0, 0])
    contact = ball(notched, np.array([0.0, 0.0, 0.01]) + 5e-6 * away)
    ((normal,),) = contact.clauses
    np.testing.assert_allclose(normal, away, atol=1e-4)
    np.testing.assert_allclose(contact.point, [0, 0, 0.01], atol=1e-16)
    assert contact.provenance.normal_error < 1e-4
    exactly = ball(notched, [0.0, 0.0, 0.01])
    np.testing.assert_allclose(exactly.normals[0], unit([-1, -1, 0]), atol=1e-12)
    assert exactly.provenance.kind == "approximate"
    assert exactly.provenance.normal_error == pytest.approx(np.pi / 4)


def test_at_an_apex_the_error_reaches_every_facet(notched: PartGeometry) -> None:
    contact = ball(notched, [0.0, 0.0, 0.0])
    assert contact.provenance.normal_error == pytest.approx(np.arccos(1 / np.sqrt(3)))


def test_ball_reaches_no_concave_edge_and_no_saddle(notched: PartGeometry) -> None:
    with pytest.raises(GeometryError, match=r"E1.*cannot reach into the concave edge"):
        ball(notched, [0.03, 0.02, 0.02])
    with pytest.raises(UnsupportedError, match="convex and concave"):
        ball(notched, [0.02, 0.02, 0.04])


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf")])
def test_radius_must_be_positive(notched: PartGeometry, radius: float) -> None:
    with pytest.raises(GeometryError, match="radius > 0"):
        ball(notched, [0.0, 0.01, 0.01], radius)


def test_ball_beside_a_wall_needs_room_and_is_told_where_it_is(notched: PartGeometry) -> None:
    assert ball(notched, [0.0241, 0.03, 0.02]).feature == "facet 8"
    with pytest.raises(GeometryError) as caught:
        ball(notched, [0.023, 0.03, 0.02])
    message = str(caught.value)
    assert "cuts 1 mm into facet" in message
    assert "has room at [0.024, 0.03, 0.02] m" in message
    # what it says is true
    assert len(ball(notched, [0.024, 0.03, 0.02]).normals) == 1


def test_slot_narrower_than_the_ball_has_no_room(tmp_path: Path) -> None:
    outline = [[0, 0], [0.04, 0], [0.04, 0.02], [0.023, 0.02], [0.023, 0.01], [0.017, 0.01], [0.017, 0.02], [0, 0.02]]
    geometry = loaded(tmp_path, prism(outline, 0.02))
    assert len(ball(geometry, [0.02, 0.01, 0.01], 0.003).normals) == 1
    with pytest.raises(GeometryError, match=r"ball of radius 5 mm.*cuts 2 mm"):
        ball(geometry, [0.02, 0.01, 0.01], 0.005)


def test_ball_in_a_tessellated_bore_fits_if_it_fits_the_true_bore(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, prism(circle(0.03, 4), 0.03, [circle(0.01, 24)]))
    apothem = 0.01 * np.cos(np.pi / 24)
    for turn in (0.0, 0.5, 0.9):
        angle = np.pi / 24 * (1 + turn)
        radius = apothem / np.cos(angle - np.pi / 24)
        for size in (0.002, 0.008):
            contact = ball(geometry, [radius * np.cos(angle), radius * np.sin(angle), 0.015], size)
            assert contact.provenance.kind == "fitted"
    with pytest.raises(GeometryError, match="cuts"):
        ball(geometry, [apothem * np.cos(np.pi / 24), apothem * np.sin(np.pi / 24), 0.015], 0.015)


def test_inner_edge_of_an_l(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, l_shape(0.04, 0.02))
    with pytest.raises(GeometryError, match="cuts"):
        ball(geometry, [0.021, 0.02, 0.01])
