"""The number of elements against brute force: every set of locators with a way out, every set of clamps."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from fixture_design.arrays import Rows
from fixture_design.cones.kernel import closure_tests
from fixture_design.design import design
from fixture_design.layout import Answer
from tests.design.fakes import Fake, Spots, box, candidates, chamfered, polygon, solid, task


def fewest_clamps(spots: Spots) -> int | None:
    """The least number of clamps against as many locators as freedoms that are independent and left at once."""
    rows = candidates(spots).rows[:, 0]
    every, dimension = let_go(spots, rows), rows.shape[1]
    for size in range(dimension + 1):
        sets = [[*some, *more] for some in every.tolist() for more in combinations(range(len(rows)), size)]
        sets = [s for s in sets if len(set(s)) == len(s)]
        if not sets:
            continue
        places = np.array(sets)
        tests = closure_tests(rows, np.arange(len(sets) + 1) * places.shape[1], places.ravel())
        if (tests.closes == 1).any():
            return size
    return None


def let_go(spots: Spots, rows: Rows) -> np.ndarray:
    """Sets of as many locators as freedoms that are independent and left at once, shape (n, d)."""
    dimension = rows.shape[1]
    every = np.array(list(combinations(range(len(rows)), dimension)))
    ranks = np.abs(np.linalg.det(rows[every])) > 1e-7
    tests = closure_tests(spots.normals, np.arange(len(every) + 1) * dimension, every.ravel())
    return every[ranks & (tests.leaves == 1)]


def drawn(seed: int) -> Spots:
    """A random polygon, two to four points on each edge."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 6))))
    corners = np.column_stack([np.cos(angles), 0.6 * np.sin(angles)])
    return polygon(corners, 14 // len(corners))


@pytest.mark.parametrize("seed", range(8))
def test_planar_layouts_have_as_few_clamps_as_any(seed: int) -> None:
    spots = drawn(seed)
    compare(spots)


def wedge(count: int, seed: int) -> Spots:
    slope = np.array([0.6, 0.0, 0.8])
    normals = np.vstack([[[0, 1, 0], [0, -1, 0], [0, 0, -1], [-1, 0, 0]], slope])
    return solid(normals, np.array([0.5, 0.5, 0.0, 1.0, 0.6]), 1.5, count, seed)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("part", [box, chamfered, wedge])
def test_spatial_layouts_have_as_few_clamps_as_any(part: object, seed: int) -> None:
    spots = part(2, seed)  # type: ignore[operator]
    compare(spots)


def compare(spots: Spots) -> None:
    least = fewest_clamps(spots)
    result = design(task(spots, require=REQUIRE), Fake(spots, frozenset({"loadable"})))
    if least is None:
        assert result.layout is None
        assert result.satisfied is Answer.NO
        return
    assert result.bound is not None
    assert result.bound.clamps <= least
    assert result.layout is not None, result.reason
    found = sum(element.role == "clamp" for element in result.layout.elements)
    assert found >= least  # or brute force is wrong
    assert found == least


REQUIRE = {"locators": ("deterministic", "strongly_accessible", "loadable"), "all": ("form_closure",)}
