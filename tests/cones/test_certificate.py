"""The compiled kernel's float bounds on s, attacked: rows for which rational arithmetic knows that s is next to zero.

A lower bound above zero claims that the rows, as the floats they are, close; an upper bound below zero, that a motion
leaves them all. Either claim is checked in exact arithmetic of the same floats, where the truth is a hair away.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fixture_design.cones import kernel
from tests import exact
from tests.strategies import seeds


def check(rows: np.ndarray) -> int:
    found = kernel.closure_test(rows)
    sign = kernel.exact_closure_sign(rows, dimension=rows.shape[1])
    if found.lower > 0:
        assert sign == 1
    if found.upper < 0:
        assert sign == -1
    return sign


@pytest.fixture(autouse=True)
def _only_proven_bounds(implementation: str):
    if implementation == "numpy":
        pytest.skip("the numpy kernel's bounds are not proven to the last digit")


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


@settings(max_examples=300)
@given(seeds(), st.integers(-17, -6), st.sampled_from([2, 3, 6]))
def test_closed_or_open_by_a_hair(rng: np.random.Generator, exponent: int, d: int):
    """A simplex around the origin whose last row is pushed through the facet of the others, or almost."""
    rows = rng.normal(size=(d, d))
    weights = rng.random(d) + 0.1
    weights[0] = rng.choice([-1.0, 0.0, 1.0]) * 10.0**exponent
    check(unit(np.vstack([rows, -(weights @ rows)])))


@settings(max_examples=300)
@given(seeds(), st.integers(-17, -6))
def test_rank_deficient_by_a_hair(rng: np.random.Generator, exponent: int):
    """Opposed pairs in a hyperplane, tilted out of it by next to nothing."""
    rows = rng.integers(-3, 4, size=(5, 3)).astype(float)
    rows[:, 2] = 0
    rows = rows[rows.any(axis=1)]
    rows = np.vstack([rows, -rows])
    rows[:, 2] = rng.choice([-1.0, 0.0, 1.0], size=len(rows)) * 10.0**exponent
    if len(rows):
        check(unit(rows))


@settings(max_examples=300)
@given(seeds(), st.integers(-12, 0))
def test_weights_and_directions_of_very_different_size(rng: np.random.Generator, exponent: int):
    rows = rng.normal(size=(8, 3)) * 10.0 ** np.array([0, exponent, exponent / 2])
    rows = np.vstack([rows, -rows.sum(axis=0), -(rng.random(8) @ rows)])
    check(unit(rows))


def test_all_signs_come_up():
    rng = np.random.default_rng(0)
    signs = set()
    for _ in range(300):
        rows = rng.normal(size=(3, 3))
        weights = np.array([rng.choice([-1.0, 0.0, 1.0]) * 1e-15, 1.0, 1.0])
        signs.add(check(unit(np.vstack([rows, -(weights @ rows)]))))
    flat = unit(np.array([[3.0, 4.0, 0.0], [-3.0, -4.0, 0.0], [4.0, -3.0, 0.0], [-4.0, 3.0, 0.0]]))
    signs.add(check(flat))
    assert signs == {-1, 0, 1}


def test_the_exact_sign_is_that_of_the_tests_own_exact_route():
    rng = np.random.default_rng(1)
    for _ in range(60):
        rows = rng.normal(size=(3, 3))
        weights = np.array([rng.choice([-1.0, 0.0, 1.0]) * 1e-16, 1.0, 1.0])
        rows = unit(np.vstack([rows, -(weights @ rows)]))
        assert (check(rows) == 1) == exact.closes(rows.tolist(), 3)
