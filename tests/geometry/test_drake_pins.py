"""Each behaviour of Drake that the package relies on, so that a newer Drake which changes one is noticed here."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.errors import GeometryError
from fixture_design.geometry.distance import DistanceField, guarded, obj_text
from tests.geometry.parts import box, l_shape

HALF = np.array([0.025, 0.015, 0.01])


@pytest.fixture(scope="module")
def block() -> DistanceField:
    return DistanceField(*box(0.05, 0.03, 0.02), "block")


def box_distance(point: np.ndarray) -> float:
    away = np.abs(point) - HALF
    return float(np.linalg.norm(np.maximum(away, 0)) + min(away.max(), 0.0))


def test_distance_to_a_mesh_is_that_of_the_box_to_rounding(block: DistanceField) -> None:
    points = np.random.default_rng(2).uniform(-0.05, 0.05, (300, 3))
    for point in points:
        distance, nearest = block.at(point)
        assert distance == pytest.approx(box_distance(point), abs=1e-15)
        assert np.linalg.norm(point - nearest) == pytest.approx(abs(distance), abs=1e-15)


def test_mesh_is_its_true_surface_and_not_its_hull() -> None:
    field = DistanceField(*l_shape(0.04, 0.02), "L")
    assert field.at(np.array([0.03, 0.03, 0.01]))[0] == pytest.approx(0.01)


def test_on_the_surface_distance_is_zero_and_the_point_its_own_nearest(block: DistanceField) -> None:
    for point in ([0.025, 0.001, 0.002], [0.025, 0.015, 0.002], [0.025, 0.015, 0.01]):
        distance, nearest = block.at(np.array(point))
        assert abs(distance) < 1e-16
        np.testing.assert_allclose(nearest, point, atol=1e-17)


def test_seventeen_digits_survive_the_text(block: DistanceField) -> None:
    vertices = box(1, 1, 1)[0] * (1 / 3) + np.pi
    field = DistanceField(vertices, box(1, 1, 1)[1], "thirds")
    for vertex in vertices:
        np.testing.assert_allclose(field.at(vertex)[1], vertex, rtol=2e-16)
    assert f"{vertices[0, 0]:.17g}" in obj_text(vertices, box(1, 1, 1)[1])


def test_inside_out_mesh_has_the_wrong_sign_silently() -> None:
    vertices, triangles = box(0.05, 0.03, 0.02)
    assert DistanceField(vertices, triangles[:, ::-1], "turned").at(np.zeros(3))[0] == pytest.approx(0.01)


def test_drake_answers_nan_with_minus_infinity_so_it_is_not_asked(block: DistanceField) -> None:
    (raw,) = block._query.ComputeSignedDistanceToPoint(np.array([np.nan, 0, 0]))
    assert raw.distance == -np.inf
    for bad in ([np.nan, 0, 0], [np.inf, 0, 0]):
        with pytest.raises(GeometryError, match="not finite"):
            block.at(np.array(bad))


def test_mesh_folded_on_itself_is_refused_and_translated() -> None:
    # two sheets over one another: closed, with a dihedral angle of 180 degrees at each edge
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1e-9]], dtype=float)
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    with pytest.raises(GeometryError, match="refuses 'fold'") as caught:
        DistanceField(vertices, triangles, "fold").at(np.array([0.2, 0.2, 1.0]))
    assert isinstance(caught.value.__cause__, RuntimeError)


def test_assertions_of_drake_are_system_exits_and_translated() -> None:
    from pydrake.geometry import Box

    with pytest.raises(GeometryError, match="Failure at") as caught:
        guarded(lambda: Box(-1, 1, 1), "bad box")
    assert isinstance(caught.value.__cause__, SystemExit)


def test_other_exits_pass_through() -> None:
    def leave() -> None:
        raise SystemExit(3)

    with pytest.raises(SystemExit):
        guarded(leave, "part")
