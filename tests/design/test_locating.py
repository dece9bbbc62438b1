"""Exchange search for locators, against all subsets and against inverses computed outright."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from fixture_design.contacts import face_vectors
from fixture_design.design.locating import Features, apart, exchanged, inaccuracy, independent, volume
from tests.design.fakes import box, candidates, polygon


def best_volume(rows: np.ndarray, count: int) -> float:
    return max(volume(rows, np.array(some)) for some in combinations(range(len(rows)), count))


@pytest.mark.parametrize("seed", range(3))
def test_restarts_reach_the_largest_volume_of_all_subsets(seed: int) -> None:
    rows = candidates(box(2, seed)).rows[:, 0]
    pool = np.arange(len(rows))
    found = []
    for attempt in range(8):
        start = independent(rows, pool, (), np.random.default_rng(attempt), 6)
        found.append(volume(rows, exchanged(rows, pool, start, ())))
    assert max(found) == pytest.approx(best_volume(rows, 6))
    assert min(found) >= 0.7 * max(found)


def test_exchanges_of_fewer_rows_than_freedoms_enlarge_what_they_span() -> None:
    rows = candidates(box(2, 0)).rows[:, 0]
    pool = np.arange(len(rows))
    start = independent(rows, pool, (), np.random.default_rng(0), 6)[:6]
    assert volume(rows, exchanged(rows, pool, start, start[:2])) >= volume(rows, start)
    assert set(start[:2]) <= set(exchanged(rows, pool, start, start[:2]))


def features_of(spots: object, points: np.ndarray, directions: np.ndarray) -> Features:
    some = candidates(spots)  # type: ignore[arg-type]
    rows = face_vectors(points - some.scale.reference, directions)
    rows[:, 2:] /= some.scale.length
    raw = face_vectors(some.places - some.scale.reference, some.normals[:, 0])
    raw[:, 2:] /= some.scale.length
    return Features(rows, np.linalg.norm(raw, axis=1))


def test_exchanges_make_the_error_at_a_feature_as_small_as_any() -> None:
    spots = polygon(np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 4)
    some = candidates(spots)
    rows, pool = some.rows[:, 0], np.arange(len(some))
    features = features_of(spots, np.array([[3.0, 0.5]]), np.array([[0.0, 1.0]]))
    errors = []
    for attempt in range(8):
        start = independent(rows, pool, (), np.random.default_rng(attempt), 3)
        found = exchanged(rows, pool, start, (), features)
        assert inaccuracy(rows, features, found) <= inaccuracy(rows, features, start) * (1 + 1e-9)
        errors.append(inaccuracy(rows, features, found))
    every = [np.array(s) for s in combinations(range(len(rows)), 3) if volume(rows, np.array(s)) > 1e-6]
    assert min(errors) == pytest.approx(min(inaccuracy(rows, features, s) for s in every), rel=1e-6)


def test_the_error_is_that_of_locators_off_by_one_along_their_normals() -> None:
    spots = polygon(np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 4)
    some = candidates(spots)
    point, direction = np.array([3.0, 0.5]), np.array([0.0, 1.0])
    features = features_of(spots, point[None], direction[None])
    chosen = np.array([0, 3, 13])
    raw = face_vectors(some.places[chosen], some.normals[chosen, 0])
    motions = np.linalg.inv(raw)  # one column for each locator off by 1
    moved = [abs(direction @ (m[:2] + m[2] * np.array([-point[1], point[0]]))) for m in motions.T]
    assert inaccuracy(some.rows[:, 0], features, chosen) == pytest.approx(sum(moved))


def test_no_more_rows_than_are_independent() -> None:
    rows = candidates(polygon(np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 4)).rows[:, 0]
    alike = np.arange(4)  # all on one edge
    assert len(independent(rows, alike, (), np.random.default_rng(0), 3)) == 2


def test_apart_keeps_the_distance() -> None:
    places = np.array([[0.0, 0], [1, 0], [2, 0]])
    assert apart(places, [0], np.arange(3), 1.5).tolist() == [False, False, True]
    assert apart(places, [0], np.arange(3), 0.0).all()
