"""Bounds on accuracy against all subsets."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from fixture_design.design import design
from fixture_design.design.accuracy_bounds import largest_volume, least_error
from fixture_design.design.locating import inaccuracy, volume
from fixture_design.layout import KeyFeature
from tests.design.fakes import Fake, ball, box, candidates, polygon, task
from tests.design.test_locating import features_of


@pytest.mark.parametrize("seed", range(3))
def test_no_subset_spans_more_than_the_bound(seed: int) -> None:
    for spots, count in ((box(2, seed), 6), (polygon(np.array([[0.0, 0], [3, 0], [2, 1]]), 4), 3), (ball(12, seed), 3)):
        rows = candidates(spots).rows[:, 0]
        best = max(volume(rows, np.array(some)) for some in combinations(range(len(rows)), count))
        assert best <= largest_volume(rows) * (1 + 1e-9)
        assert best >= 0.4 * largest_volume(rows)


def test_no_subset_has_a_smaller_error_than_the_bound() -> None:
    spots = polygon(np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 4)
    rows, pool = candidates(spots).rows[:, 0], np.arange(16)
    features = features_of(spots, np.array([[2.0, 0.5], [0.5, 0.5]]), np.array([[0.0, 1.0], [0.6, 0.8]]))
    every = [np.array(some) for some in combinations(range(16), 3) if volume(rows, np.array(some)) > 1e-6]
    best = min(inaccuracy(rows, features, some) for some in every)
    assert least_error(rows, features, pool) <= best * (1 + 1e-9)
    assert least_error(rows, features, pool) >= 0.5 * best


def test_a_design_states_how_accurate_it_could_be() -> None:
    spots = polygon(np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 8)
    feature = KeyFeature("bore", np.array([2.9, 0.5]), np.array([0.0, 1.0]), 0.01)
    result = design(task(spots, key_features=(feature,)), Fake(spots))
    assert result.accuracy is not None
    assert result.best_accuracy is not None
    assert result.best_accuracy <= result.accuracy * (1 + 1e-9) <= 1.2 * result.best_accuracy
