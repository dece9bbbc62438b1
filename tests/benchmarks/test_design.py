"""How long design takes: seven elements of many candidates, the bound of a region, a whole box."""

from __future__ import annotations

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from fixture_design.design import design
from fixture_design.design.closing import fewest_closing
from fixture_design.design.hitting import fewest_stopping
from tests.design.fakes import Fake, Spots, box, candidates, task


def many(count: int) -> Spots:
    """Points spread over a box, as many as wanted."""
    rng, half = np.random.default_rng(0), np.array([0.05, 0.03, 0.02])
    points, normals = rng.uniform(-1, 1, (count, 3)) * half, np.zeros((count, 3))
    axis, side = np.arange(count) % 3, np.where(np.arange(count) // 3 % 2, 1.0, -1.0)
    points[np.arange(count), axis] = side * half[axis]
    normals[np.arange(count), axis] = side
    return Spots(points, normals, tuple(f"facet {k % 6}" for k in range(count)))


@pytest.mark.parametrize("count", [1_000, 100_000])
def test_seven_elements_of_many_candidates(benchmark: BenchmarkFixture, count: int) -> None:
    rows = np.ascontiguousarray(candidates(many(count)).rows[:, 0])
    found = benchmark(lambda: fewest_closing(rows, np.random.default_rng(0)))
    assert len(found) == 7


def test_the_bound_of_a_region(benchmark: BenchmarkFixture) -> None:
    spots = candidates(many(3_000))
    leaves = (spots.normals[:, 0] @ [1.0, 2.0, 3.0]) < 0
    found = benchmark(lambda: fewest_stopping(spots.rows, np.flatnonzero(leaves), np.flatnonzero(~leaves)))
    assert found.bound == 3


def test_a_box_from_candidates_to_a_verified_layout(benchmark: BenchmarkFixture) -> None:
    spots = box(10)
    result = benchmark(lambda: design(task(spots), Fake(spots)))
    assert result.layout is not None
