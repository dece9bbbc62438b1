"""The kernel's promises: Tucker's theorem, double description step by step, the nearest point of a hull."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones.cone import unit_rows
from fixture_design.cones.kernel import (
    DoubleDescription,
    double_description,
    minimum_norm_point,
    nonnegative_least_squares,
    tucker_partition,
)
from tests import exact
from tests.checks import same_linear_span, same_rays
from tests.strategies import Vectors, float_rows, vector_sets

ZERO = 1e-9


@given(vector_sets(both_ways=False, most=12))
def test_tucker_s_theorem(vectors: Vectors):
    """Of  w_i > 0  and  d_i . u < 0  exactly one holds for every row; D^T w = 0, D u <= 0; B is the exact one."""
    rows, kept = unit_rows(vectors.array)
    found = tucker_partition(rows, ZERO)
    assert found.balanced.tolist() == [b for b, k in zip(exact.balanced(vectors.rows), kept, strict=True) if k]
    assert ((found.weights > 0) == found.balanced).all()
    assert np.abs(found.weights @ rows).max(initial=0) < 1e-10
    assert found.weights.sum() == pytest.approx(1.0) or not found.balanced.any()
    heights = rows @ found.motion if found.motion is not None else np.zeros(len(rows))
    assert ((heights < -1e-6) == ~found.balanced).all()
    assert np.abs(heights[found.balanced]).max(initial=0) < 1e-10
    balanced = [row for row, b in zip(vectors.array[kept].tolist(), found.balanced, strict=True) if b]
    assert same_linear_span(found.span, exact.echelon(balanced))
    assert np.allclose(found.span @ found.span.T, np.eye(len(found.span)), atol=1e-12)


@given(vector_sets(both_ways=False, most=12))
def test_closes_and_escape(vectors: Vectors):
    found = tucker_partition(unit_rows(vectors.array)[0], ZERO)
    assert found.closes == exact.closes(vectors.rows, vectors.dimension)
    assert (found.escape is None) == found.closes
    if found.escape is not None:
        assert np.linalg.norm(found.escape) == pytest.approx(1.0)
        assert (unit_rows(vectors.array)[0] @ found.escape <= 1e-10).all()


@given(st.sampled_from([3, 6]).flatmap(lambda d: float_rows(d, most=16)))
def test_tucker_s_theorem_for_floats(rows: np.ndarray):
    unit, _ = unit_rows(rows)
    found = tucker_partition(unit, ZERO)
    if found.balanced.any():
        assert np.abs(found.weights @ unit).max() < 1e-10
        assert (found.weights[found.balanced] > 0).all()
    if found.motion is not None:
        assert (unit[~found.balanced] @ found.motion < 0).all()
        assert np.abs(unit[found.balanced] @ found.motion).max(initial=0) < 1e-10
    assert found.closes or found.escape is not None


@given(vector_sets(both_ways=False), st.randoms(use_true_random=False))
def test_rows_added_one_by_one_in_any_order_give_the_cone(vectors: Vectors, random):
    rows, _ = unit_rows(vectors.array)
    order = list(range(len(rows)))
    random.shuffle(order)
    state = DoubleDescription.whole_space(vectors.dimension, ZERO)
    for index in order:
        state = state.add_row(rows[index])
    at_once = double_description(rows, np.zeros((0, vectors.dimension)), ZERO)
    assert same_rays(state.rays, at_once.rays)
    assert same_linear_span(state.lines, at_once.lines)
    assert (state.incidence == (np.abs(state.rays @ state.rows.T) <= ZERO)).all()
    rays, lines = exact.extreme(vectors.rows, dimension=vectors.dimension)
    assert same_rays(state.rays, rays)
    assert same_linear_span(state.lines, lines)
    assert state.rows.tolist() == rows[order].tolist()


def test_a_state_goes_on_in_several_directions():
    start = DoubleDescription.whole_space(2, ZERO).add_row(np.array([-1.0, 0.0]))
    up, down = start.add_row(np.array([0.0, -1.0])), start.add_row(np.array([0.0, 1.0]))
    assert same_rays(up.rays, [[1, 0], [0, 1]])
    assert same_rays(down.rays, [[1, 0], [0, -1]])
    assert len(start.rows) == 1


def test_values_near_the_tolerance_are_recorded():
    tilted = np.array([[1.0, 0.0], [-1.0, 2e-9]])
    state = double_description(tilted / np.linalg.norm(tilted, axis=1, keepdims=True), np.zeros((0, 2)), ZERO)
    assert not state.is_certain(30.0)


@given(st.sampled_from([2, 3]).flatmap(lambda d: float_rows(d, least=1, most=6)), st.floats(0, 3))
def test_the_nearest_point_against_brute_force(rows: np.ndarray, shift: float):
    unit, _ = unit_rows(rows)
    unit = unit + shift * np.eye(unit.shape[1])[0]
    point, weights = minimum_norm_point(unit)
    assert np.linalg.norm(point) == pytest.approx(nearest_by_brute_force(unit), abs=1e-9)
    assert (weights >= 0).all()
    assert weights.sum() == pytest.approx(1.0)
    assert weights @ unit == pytest.approx(point, abs=1e-12)
    assert int((weights > 0).sum()) <= unit.shape[1] + 1


def nearest_by_brute_force(rows: np.ndarray) -> float:
    """Smallest norm over the affine hulls of all subsets whose nearest point is in their convex hull."""
    best = np.inf
    for size in range(1, min(len(rows), rows.shape[1] + 1) + 1):
        for chosen in combinations(range(len(rows)), size):
            corner = rows[list(chosen)]
            matrix = np.block([[corner @ corner.T, np.ones((size, 1))], [np.ones((1, size)), np.zeros((1, 1))]])
            solution = np.linalg.lstsq(matrix, np.append(np.zeros(size), 1.0), rcond=None)[0][:size]
            if (solution >= -1e-9).all() and abs(solution.sum() - 1) < 1e-9:
                best = min(best, float(np.linalg.norm(solution @ corner)))
    return best


@given(st.sampled_from([2, 3]).flatmap(lambda d: float_rows(d, least=2, most=5)))
def test_nonnegative_least_squares_meets_its_optimality_conditions(rows: np.ndarray):
    unit, _ = unit_rows(rows)
    matrix, target = unit[:-1].T, unit[-1]
    x = nonnegative_least_squares(matrix, target)
    gradient = matrix.T @ (target - matrix @ x)
    assert (x >= 0).all()
    assert gradient.max() <= 1e-10
    assert np.abs(gradient[x > 0]).max(initial=0) <= 1e-10


def test_weights_that_must_be_uneven_are_positive_and_balance():
    rows, _ = unit_rows(np.array([[1.0, 0.0], [-1.0, 1e-4], [-1.0, -1e-4], [1.0, 1e-7]]))
    found = tucker_partition(rows, ZERO)
    assert found.closes
    assert (found.weights > 0).all()
    assert np.abs(found.weights @ rows).max() < 1e-12
