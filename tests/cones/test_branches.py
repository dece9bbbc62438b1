"""Branches of unions as batches: the same rows as one alternative a clause chosen by hand, and the union's answers."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given

from fixture_design.cones import kernel
from fixture_design.errors import ConeError
from tests import exact
from tests.strategies import seeds


@given(seeds())
def test_all_branches_of_a_union(rng: np.random.Generator):
    alternatives = rng.integers(1, 4, size=rng.integers(0, 5))
    clause = np.repeat(np.arange(len(alternatives)), alternatives)
    alternative = np.repeat(np.arange(len(clause)), rng.integers(1, 4, size=len(clause)))
    indices, offsets = kernel.branch_sets(alternative, clause)
    found = [indices[a:b].tolist() for a, b in pairwise(offsets)]
    choices = product(*[np.flatnonzero(clause == c).tolist() for c in range(len(alternatives))])
    assert found == [np.flatnonzero(np.isin(alternative, choice)).tolist() for choice in choices]
    rows = rng.integers(-2, 3, size=(len(alternative), 3)).astype(float)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    closes = kernel.closure_tests(rows / np.where(lengths > 0, lengths, 1.0), offsets, indices).closes
    assert (closes == 1).tolist() == [exact.closes(rows[branch].astype(int).tolist(), 3) for branch in found]


def test_too_many():
    clause = np.repeat(np.arange(30), 2)
    with pytest.raises(ConeError, match="1073741824 branches"):
        kernel.branch_sets(np.arange(60), clause)
