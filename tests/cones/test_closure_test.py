"""Closure tests and memberships: the right answer, a witness for each, and the same one by one and in batches."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones import kernel
from fixture_design.cones.cone import unit_rows
from fixture_design.errors import ConeError
from fixture_design.tolerances import DEFAULT
from tests import exact
from tests.strategies import Vectors, float_rows, seeds, vector_sets


def unit(vectors: Vectors) -> np.ndarray:
    """Unit rows, zero rows kept."""
    lengths = np.linalg.norm(vectors.array, axis=1, keepdims=True)
    return vectors.array / np.where(lengths > 0, lengths, 1.0)


def check_witnesses(rows: np.ndarray, found: kernel.Closure) -> None:
    said = rows[rows.any(axis=1)]
    assert found.lower <= found.upper
    if found.closes is False:
        assert found.motion is not None
        assert np.linalg.norm(found.motion) == pytest.approx(1.0)
        assert (said @ found.motion <= max(found.upper, 0) + 1e-12).all()
    if found.closes or found.leaves is False:
        assert found.weights is not None
        assert (found.weights >= 0).all()
        assert found.weights.sum() == pytest.approx(1.0)
        assert np.linalg.norm(found.weights @ rows) < 1e-10
    if found.closes:
        assert (found.weights[rows.any(axis=1)] > 0).all()
        assert np.linalg.matrix_rank(said) == rows.shape[1]
    if found.leaves:
        assert (said @ found.motion < -DEFAULT.near / 2).all()


@given(vector_sets(both_ways=False, most=14))
def test_the_answer_is_the_exact_one_and_proves_itself(vectors: Vectors):
    found = kernel.closure_test(unit(vectors))
    assert found.closes is exact.closes(vectors.rows, vectors.dimension)
    assert found.leaves is exact.separable([row for row in vectors.rows if any(row)])
    check_witnesses(unit(vectors), found)


@given(st.sampled_from([3, 6]).flatmap(lambda d: float_rows(d, most=20)))
def test_random_floats(rows: np.ndarray):
    rows, _ = unit_rows(rows)
    found = kernel.closure_test(rows)
    sign = kernel.exact_closure_sign(rows, dimension=rows.shape[1])
    assert found.closes in {sign == 1, None}
    assert found.leaves in {sign == -1, None}
    check_witnesses(rows, found)


@given(st.lists(vector_sets(6, both_ways=False, most=10), min_size=1, max_size=6), st.sampled_from([1, 3]))
def test_batches_say_what_single_tests_say(sets: list[Vectors], threads: int):
    parts = [unit(vectors) for vectors in sets]
    rows, offsets = np.vstack(parts), np.concatenate([[0], np.cumsum([len(part) for part in parts])])
    together = kernel.closure_tests(rows, offsets, witnesses=True, threads=threads)
    assert together.weights is not None
    assert together.motions is not None
    for number, part in enumerate(parts):
        alone = kernel.closure_test(part)
        assert {1: True, 0: False, -1: None}[int(together.closes[number])] is alone.closes
        assert {1: True, 0: False, -1: None}[int(together.leaves[number])] is alone.leaves
        assert (together.lower[number], together.upper[number]) == (alone.lower, alone.upper)
        weights = together.weights[offsets[number] : offsets[number + 1]]
        assert weights.tolist() == (np.zeros(len(part)) if alone.weights is None else alone.weights).tolist()
        assert together.motions[number].tolist() == (np.zeros(6) if alone.motion is None else alone.motion).tolist()


@given(seeds())
def test_sets_may_share_rows(rng: np.random.Generator):
    rows, _ = unit_rows(rng.normal(size=(12, 3)))
    chosen = [rng.permutation(12)[: rng.integers(0, 9)] for _ in range(7)]
    offsets = np.concatenate([[0], np.cumsum([len(c) for c in chosen])])
    found = kernel.closure_tests(rows, offsets, np.concatenate(chosen).astype(np.int64))
    assert found.weights is None
    alone = [kernel.closure_test(rows[c]).closes for c in chosen]
    assert [{1: True, 0: False, -1: None}[int(answer)] for answer in found.closes] == alone


@given(vector_sets(both_ways=False), seeds())
def test_membership(vectors: Vectors, rng: np.random.Generator):
    rows, kept = unit_rows(vectors.array)
    target = rng.integers(-2, 3, size=vectors.dimension)
    if rng.random() < 0.5 and kept.any():
        target = (rng.integers(0, 3, size=int(kept.sum())) @ vectors.array[kept]).astype(int)
    if not target.any():
        return
    found = kernel.membership_test(target / np.linalg.norm(target), rows)
    assert found.inside is exact.in_cone(target.tolist(), [row for row in vectors.rows if any(row)])
    assert (found.weights >= 0).all()
    if found.inside:
        assert found.weights @ rows == pytest.approx(target / np.linalg.norm(target), abs=1e-9)
    else:
        assert (rows @ found.separating <= 1e-10).all()
        assert target @ found.separating > 0


@given(seeds(), st.sampled_from([1, 3]))
def test_memberships_in_batches(rng: np.random.Generator, threads: int):
    parts = [unit_rows(rng.integers(-2, 3, size=(rng.integers(0, 7), 3)).astype(float))[0] for _ in range(8)]
    vectors, _ = unit_rows(rng.normal(size=(8, 3)))
    offsets = np.concatenate([[0], np.cumsum([len(part) for part in parts])])
    found = kernel.membership_tests(vectors, np.vstack(parts), offsets, threads=threads)
    for k, part in enumerate(parts):
        alone = kernel.membership_test(vectors[k], part)
        assert {1: True, 0: False, -1: None}[int(found.inside[k])] is alone.inside
        assert found.distances[k] == alone.distance
        assert found.weights[offsets[k] : offsets[k + 1]].tolist() == alone.weights.tolist()
    with pytest.raises(ConeError, match="7 vectors for 8 sets"):
        kernel.membership_tests(vectors[:7], np.vstack(parts), offsets)


@pytest.mark.parametrize("slope", [1e-12, 1e-10, 1e-9, 1e-8, 1e-6])
def test_near_a_tie_it_is_undecided_and_beyond_it_is_not(slope: float):
    """Three rows around the origin, two of them `slope` off one line: s is about half of it."""
    rows, _ = unit_rows(np.array([[1.0, slope], [-1.0, slope], [0.0, -1.0]]))
    closes = kernel.closure_test(rows).closes
    assert closes is (True if slope == 1e-6 else False if slope == 1e-12 else None)


def test_no_rows_and_zero_rows():
    for rows in (np.zeros((0, 3)), np.zeros((4, 3))):
        found = kernel.closure_test(rows)
        assert (found.closes, found.leaves, found.upper) == (False, True, -1.0)
    assert not len(kernel.closure_tests(np.zeros((0, 3)), np.array([0])).closes)


@pytest.mark.parametrize("offsets", [[], [0], [0, 3], [1, 4], [0, 3, 2, 4], [0, 5]])
def test_offsets_that_do_not_fit(offsets: list[int]):
    with pytest.raises(ConeError, match="offsets must rise"):
        kernel.closure_tests(np.eye(4)[:, :3] + 0.0, np.array(offsets, dtype=np.int64))


@pytest.mark.parametrize("bad", [-1, 4])
def test_indices_that_are_no_rows(bad: int):
    with pytest.raises(ConeError, match=f"there is no row {bad}; there are 4"):
        kernel.closure_tests(np.eye(4), np.array([0, 1]), np.array([bad]))
