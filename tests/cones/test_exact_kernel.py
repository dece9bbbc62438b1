"""The exact kernel against the tests' own exact route, on rational data of every kind."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones import kernel
from fixture_design.errors import ConeError, DimensionError
from tests import exact
from tests.strategies import Vectors, seeds, vector_sets

#: Integers that overflow a machine word at once, and such that do after some steps.
SCALES = (1, 10**6, 3**45)


@given(vector_sets(), st.sampled_from(SCALES), seeds())
def test_double_description(vectors: Vectors, scale: int, rng: np.random.Generator):
    def blurred(row):
        return tuple(scale * v + int(bool(scale > 1 and v)) * int(rng.integers(-2, 3)) for v in row)

    rows, both_ways = [blurred(row) for row in vectors.rows], [blurred(row) for row in vectors.both_ways]
    found = kernel.exact_double_description(rows, both_ways, dimension=vectors.dimension)
    rays, lines = exact.extreme(rows, both_ways, dimension=vectors.dimension)
    assert list(found.rays) == rays
    assert list(found.lines) == lines
    on = [[exact.dot(row, ray) == 0 for row in rows] for ray in rays]
    assert found.incidence.tolist() == on
    assert found.ambient == vectors.dimension - exact.rank(both_ways)


@given(vector_sets(both_ways=False, most=12), st.sampled_from(SCALES))
def test_tucker_s_partition(vectors: Vectors, scale: int):
    rows = [tuple(scale * v + (i % 3 if scale > 1 else 0) for i, v in enumerate(row)) for row in vectors.rows]
    found = kernel.exact_tucker_partition(rows, dimension=vectors.dimension)
    assert found.balanced.tolist() == exact.balanced(rows)
    assert [weight > 0 for weight in found.weights] == found.balanced.tolist()
    primitive = exact.integer_rows(rows)
    for column in zip(*primitive, strict=True):
        assert exact.dot(column, found.weights) == 0
    for row, balanced in zip(rows, found.balanced, strict=True):
        height = 0 if found.motion is None else exact.dot(row, found.motion)
        assert (height == 0) if balanced else (height < 0)
    assert list(found.span) == exact.echelon([row for row, b in zip(rows, found.balanced, strict=True) if b])
    assert found.closes == exact.closes(rows, vectors.dimension)


@given(vector_sets(both_ways=False, most=12))
def test_the_sign_of_closure(vectors: Vectors):
    sign = kernel.exact_closure_sign(vectors.rows, dimension=vectors.dimension)
    assert (sign == 1) == exact.closes(vectors.rows, vectors.dimension)
    assert (sign == -1) == exact.separable([row for row in vectors.rows if any(row)])


@given(seeds())
def test_signs_of_float_rows_are_those_of_the_numbers_they_are(rng: np.random.Generator):
    """Unit rows of a grid: whatever rounding made of the ties, the answer is that of the rounded rows."""
    sets = [rng.integers(-1, 2, size=(rng.integers(0, 9), 3)).astype(float) for _ in range(20)]
    sets = [rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1) for rows in sets]
    offsets = np.concatenate([[0], np.cumsum([len(rows) for rows in sets])])
    signs = kernel.exact_closure_signs(np.vstack(sets), offsets)
    for rows, sign in zip(sets, signs, strict=True):
        exactly = [[Fraction(v) for v in row] for row in rows.tolist()]
        assert (sign == 1) == exact.closes(exactly, 3)
        assert (sign == -1) == exact.separable([row for row in exactly if any(row)])


@pytest.mark.parametrize("small", [5e-324, 1e-300, 1e-200, 1e-170, 1e-161, 1e-154, 1e-140, 1e-120])
@pytest.mark.parametrize(
    "rows",
    [[[1.0], [-1.0]], [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]], [[1.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]],
)
def test_rows_whose_squares_underflow_count(rows: list[list[float]], small: float):
    """They close without the first row's size mattering; without the first row they do not."""
    rows = [[small * value for value in rows[0]], *rows[1:]]
    signs = kernel.exact_closure_signs(np.array([*rows, *rows[1:]]), np.array([0, len(rows), 2 * len(rows) - 1]))
    assert signs[0] == 1
    assert signs[1] < 1


def test_numbers_are_what_they_say():
    given_as = [["0.1", "0.3"], [Fraction(1, 10), Decimal("0.3")], [1, 3.0]]
    assert kernel.integer_rows(given_as, 2) == [(1, 3)] * 3
    assert kernel.integer_rows([[0.1, 0.3]], 2) == [(3602879701896397, 10808639105689190)]
    assert kernel.integer_rows(np.array([[2, 4], [0, 0]]), 2) == [(1, 2), (0, 0)]


@pytest.mark.parametrize("bad", [[["x", 1]], [[float("nan"), 1]], [[float("inf"), 1]], [["1/0", 1]], [["1e", 2]]])
def test_what_is_no_number(bad: list):
    with pytest.raises(ConeError, match="row 0 is not made of rational numbers"):
        kernel.exact_double_description(bad, dimension=2)


def test_rows_of_another_length():
    with pytest.raises(DimensionError, match="row 1 has 3 numbers"):
        kernel.exact_tucker_partition([[1, 2], [1, 2, 3]], dimension=2)


def test_too_many_rays():
    rows = [[1, t, t * t, t**3] for t in range(1, 12)]
    with pytest.raises(ConeError, match="more than 5 extreme rays"):
        kernel.exact_double_description(rows, dimension=4, max_rays=5)
