"""The fewest that stop every motion, against all subsets."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from fixture_design.cones.kernel import closure_test
from fixture_design.design.candidates import flat, stops
from fixture_design.design.closing import fewest_closing
from fixture_design.design.cover import cheapest_cover
from fixture_design.design.hitting import fewest_stopping, free_motion
from tests.design.fakes import Spots, ball, box, candidates, polygon


def by_hand(rows: np.ndarray, base: list[int], pool: list[int]) -> int | None:
    """The size of the smallest subset that closes with the base; every subset is tried."""
    for size in range(len(pool) + 1):
        for chosen in combinations(pool, size):
            if closure_test(flat(rows, [*base, *chosen])).closes:
                return size
    return None


def random_polygon(seed: int, corners: int) -> np.ndarray:
    """Corners of a convex polygon, counter-clockwise."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    return np.column_stack([np.cos(angles), 0.7 * np.sin(angles)])


@given(seed=st.integers(0, 10**6), corners=st.integers(3, 6), friction=st.sampled_from([0.0, 0.3]))
@settings(max_examples=25)
def test_planar_numbers_are_those_of_all_subsets(seed: int, corners: int, friction: float) -> None:
    spots = candidates(polygon(random_polygon(seed, corners), 2), friction)
    rows = spots.rows_with_friction if friction else spots.rows
    pool = list(range(len(spots)))
    base = pool[: seed % 3]
    found = fewest_stopping(rows, base, pool[len(base) :])
    assert (None if found.chosen is None else len(found.chosen)) == by_hand(rows, base, pool[len(base) :])
    if found.chosen is not None:
        assert found.bound == len(found.chosen)
    else:
        assert found.free is not None
        assert not stops(rows, found.free, 1e-7).any()


@pytest.mark.parametrize("seed", range(4))
def test_clamps_of_a_box_are_those_of_all_subsets(seed: int) -> None:
    rows = candidates(box(2, seed)).rows
    rng = np.random.default_rng(seed)
    base = rng.choice(len(rows), 5, replace=False).tolist()
    pool = [index for index in range(len(rows)) if index not in base]
    found = fewest_stopping(rows, base, pool)
    assert (None if found.chosen is None else len(found.chosen)) == by_hand(rows, base, pool)


@pytest.mark.parametrize("seed", range(3))
def test_cuts_prove_the_bound(seed: int) -> None:
    rows = candidates(box(3, seed)).rows
    base, pool = list(range(9)), list(range(9, 18))
    found = fewest_stopping(rows, base, pool)
    assert found.chosen is not None
    for cut in found.cuts:
        assert not stops(rows[base], cut, 3e-8).any()
    hits = np.array([stops(rows[pool], cut, 3e-8) for cut in found.cuts])
    fewer = (hits[:, list(some)].any(axis=1).all() for some in combinations(range(len(pool)), found.bound - 1))
    assert not any(fewer)


def test_costs_decide_between_equals_and_distances_are_kept() -> None:
    spots = candidates(polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 4))
    base, pool = [0, 3, 4], list(range(5, 16))
    costs = np.ones(len(pool))
    free = fewest_stopping(spots.rows, base, pool)
    assert free.chosen is not None
    costs[~np.isin(pool, free.chosen)] = 0.9
    other = fewest_stopping(spots.rows, base, pool, costs=costs)
    assert other.chosen is not None
    assert len(other.chosen) == len(free.chosen)
    assert not set(other.chosen.tolist()) & set(free.chosen.tolist())
    far = fewest_stopping(spots.rows, base, pool, places=spots.places, spacing=1.0)
    assert far.chosen is not None
    away = np.linalg.norm(spots.places[far.chosen][:, None] - spots.places[far.chosen][None], axis=2)
    assert away[~np.eye(len(away), dtype=bool)].min() >= 1.0


@given(seed=st.integers(0, 10**6))
@example(seed=120870)  # a candidate like one of a pair, but not in it
def test_covers_are_cheapest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cuts = [rng.random(7) < 0.4 for _ in range(rng.integers(1, 6))]
    costs = rng.choice([1.0, 0.5, 2.0], 7) if seed % 2 else np.ones(7)
    apart = [(0, 1)] if seed % 3 == 0 else []
    subsets = [list(s) for size in range(8) for s in combinations(range(7), size)]
    fit = [s for s in subsets if all(cut[s].any() for cut in cuts) and not (apart and {0, 1} <= set(s))]
    found = cheapest_cover(cuts, costs, apart)
    if not fit:
        assert found is None
        return
    assert found is not None
    assert all(cut[found].any() for cut in cuts)
    assert costs[found].sum() == pytest.approx(min(costs[s].sum() for s in fit))


def ellipsoid(seed: int) -> Spots:
    spots = ball(60, seed)
    axes = np.array([1.0, 1.4, 2.1])
    normals = spots.points / axes
    return Spots(spots.points * axes, normals / np.linalg.norm(normals, axis=1, keepdims=True), spots.features)


@pytest.mark.parametrize("seed", range(3))
def test_seven_rows_close_a_smooth_part_and_a_box(seed: int) -> None:
    for spots in (ellipsoid(seed), box(12, seed)):
        rows = candidates(spots).rows[:, 0]
        found = fewest_closing(rows, np.random.default_rng(seed))
        assert found is not None
        assert len(found) == 7
        assert free_motion(rows[found]) is None


def test_four_rows_close_a_rectangle_and_none_a_ball() -> None:
    rows = candidates(polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 6)).rows[:, 0]
    found = fewest_closing(rows, np.random.default_rng(0))
    assert found is not None
    assert len(found) == 4
    assert fewest_closing(candidates(ball(30)).rows[:, 0], np.random.default_rng(0)) is None
