"""Where nearly parallel edges cross is known badly: how well, against more digits; what is not known is said."""

import numpy as np
import pytest

from fixture_design.assembly.edge_pairs import EdgePairs
from fixture_design.tolerances import APART, ROUND_OFF, SOLVED

LENGTH = 2.0


def crossing(rng: np.random.Generator, sine: float, beyond: float) -> EdgePairs:
    """Two edges of 2 m that touch at an angle, this far beyond the first end of one, anywhere in space."""
    t = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    s = np.sqrt(1 - sine**2) * t[0] + sine * t[1]
    place = rng.normal(size=3)
    mine = place + np.outer([beyond, beyond + LENGTH], t[0])
    theirs = place + np.outer([-0.7, LENGTH - 0.7], s)
    return EdgePairs(mine[None], theirs[None], t[2][None])


def exactly(pair: EdgePairs) -> float:
    """H with the longest numbers that there are."""
    mine, theirs = pair.my_edges[0].astype(np.longdouble), pair.their_edges[0].astype(np.longdouble)
    lengths = [np.sqrt(((e[1] - e[0]) ** 2).sum()) for e in (mine, theirs)]
    t, s = ((e[1] - e[0]) / length for e, length in zip((mine, theirs), lengths, strict=True))
    away, common = mine[0] - theirs[0], np.cross(t, s)
    squared = common @ common
    along = -(np.cross(away, s) @ common) / squared, -(np.cross(away, t) @ common) / squared
    over = [a - np.clip(a, 0, length) for a, length in zip(along, lengths, strict=True)]
    return float(np.sqrt((away @ common) ** 2 / squared + over[0] ** 2 + over[1] ** 2))


def distance(pair: EdgePairs) -> float:
    return pair.distances(np.eye(3)[None], np.zeros((1, 3)))[0, 0]


@pytest.mark.parametrize("sine", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
def test_a_crossing_is_known_to_rounding_by_the_sine(sine: float) -> None:
    """By products of cosines it would be rounding by the squared sine: at 1e-4 ten thousand times as much."""
    rng = np.random.default_rng(0)
    hidden = 16 * ROUND_OFF * LENGTH / sine
    for beyond in (1e-7, 1e-9, 0.0):
        for _ in range(20):
            pair = crossing(rng, sine, beyond)
            assert distance(pair) == pytest.approx(exactly(pair), abs=2 * hidden)


def test_what_rounding_hides_neither_touches_nor_is_apart() -> None:
    rng = np.random.default_rng(1)
    for sine, known in ((1e-1, True), (1e-2, True), (1e-4, False), (1e-5, False)):
        pair = crossing(rng, sine, -0.5)
        size = float(np.abs(pair.their_edges).max())
        assert bool(distance(pair) <= SOLVED * size) is known
        assert distance(pair) < APART * size


def test_without_ends_there_is_the_gap_alone() -> None:
    pair = crossing(np.random.default_rng(2), 0.5, 0.3)
    where = np.eye(3)[..., None], np.zeros((3, 1)), np.array([0])
    for whole, gap in zip(pair.equations(*where, ends=True), pair.equations(*where, ends=False), strict=True):
        assert len(whole) == 3
        assert len(gap) == 1
        np.testing.assert_array_equal(whole[0], gap[0])
