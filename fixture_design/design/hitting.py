"""The fewest candidates that stop every motion, and the proof that fewer do not: hitting sets with cuts.

A motion u that a set leaves free is a *cut*: whoever closes must have one of the candidates that stop u. So

    choose the cheapest candidates that hit all cuts known    (an integer program; its cost is a lower bound)
    find a motion that these leave free                       (a closure test; none: they close, and are the fewest)
    add it as a cut, made as strong as it gets: of a largest set of candidates that still leaves something free

until the choice closes. The choice is then proven to be the cheapest one, by cuts that anyone can check.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Points, Rows, Vector, Weights
from fixture_design.cones.kernel import closure_test, tucker_partition
from fixture_design.design.candidates import Several, flat, stops
from fixture_design.design.cover import cheapest_cover, greedy_cover
from fixture_design.design.near_tie import least_stopped
from fixture_design.design.standing import Standing
from fixture_design.tolerances import DEFAULT, Tolerances

#: Cuts after which the search says what it knows so far.
MOST_CUTS = 400

#: Candidates that may fail to join the set of a cut, one after the other, before it is taken as it is.
_FAILURES = 8


@dataclass(frozen=True, eq=False)
class Hitting:
    """What the search found.

    Attributes:
        chosen: indices of the candidates; None where none close, or the search was stopped before it had any.
        bound: no set that closes has fewer candidates than this.
        free: a motion that not even all candidates stop; None where they do.
        cuts: the motions that prove the bound, shape (c, d).
        complete: whether the search came to its end: ``chosen`` are the cheapest, or there are none.
    """

    chosen: Indices | None
    bound: int
    free: Vector | None
    cuts: Rows
    complete: bool = True


def fewest_stopping(
    rows: Several,
    base: Sequence[int] | Indices,
    pool: Sequence[int] | Indices,
    *,
    costs: Weights | None = None,
    places: Points | None = None,
    spacing: float = 0.0,
    standing: Standing | None = None,
    most_cuts: int = MOST_CUTS,
    enough: float = np.inf,
    tolerances: Tolerances = DEFAULT,
    cancelled: Callable[[], bool] = lambda: False,
) -> Hitting:
    """The cheapest of ``pool`` that close together with all of ``base``.

    Args:
        rows: of all candidates, shape (n, k, d).  base, pool: indices.
        costs: shape (len(pool),), around 1; by default all 1, and the fewest are sought.
        places, spacing: two of the pool closer than this are not chosen together.
        standing: nor are two that are in each other's way.
        enough: the search ends where the bound reaches this, with or without a choice.
    """
    base, pool = np.asarray(base, dtype=np.int64), np.asarray(pool, dtype=np.int64)
    costs = np.ones(len(pool)) if costs is None else costs
    dimension = rows.shape[2]
    if len(base) and free_motion(flat(rows, base), tolerances) is None:
        return Hitting(pool[:0], 0, None, np.empty((0, dimension)))
    free = free_motion(flat(rows, np.concatenate([base, pool])), tolerances)
    if free is not None:
        return Hitting(None, len(pool) + 1, free, np.empty((0, dimension)))
    motions: list[Vector] = []
    cuts: list[Mask] = []
    apart: list[tuple[int, int]] = []
    bound, exact = 0, False

    def found(chosen: Indices | None, least: int, complete: bool = True) -> Hitting:
        return Hitting(chosen, least, None, np.array(motions).reshape(-1, dimension), complete)

    while True:
        # a cover that is quickly made finds most of the cuts; the cheapest one has the last word
        cover = cheapest_cover(cuts, costs, apart) if exact or apart else greedy_cover(cuts, costs)
        if cover is None:
            return found(None, len(pool) + 1)
        if exact or apart:
            bound = max(bound, _at_least(float(costs[cover].sum()), costs))
        near = _too_near(cover, None if places is None else places[pool], spacing)
        if near is None and standing is not None and (pair := standing.first_conflict(pool[cover])) is not None:
            near = int(cover[pair[0]]), int(cover[pair[1]])
        if near is not None and len(cuts) + len(apart) < most_cuts and not cancelled():
            apart.append(near)
            continue
        motion = free_motion(flat(rows, np.concatenate([base, pool[cover]])), tolerances)
        if motion is None and (exact or apart) and near is None:
            return found(pool[cover], bound)
        if bound >= enough or len(cuts) + len(apart) >= most_cuts or cancelled():
            last = cheapest_cover(cuts, costs)
            least = len(pool) + 1 if last is None else _at_least(float(costs[last].sum()), costs)
            return found(None, max(bound, least), complete=False)
        exact = motion is None
        if motion is not None:
            motion, cut = strongest(rows, base, pool, cover, motion, tolerances)
            motions.append(motion)
            cuts.append(cut)


def free_motion(rows: Rows, tolerances: Tolerances = DEFAULT) -> Vector | None:
    """A unit motion that none of the rows stops by more than `tolerances.near`; None if they close for certain.

    Near a tie the test may have neither proof; then it is the motion that is stopped least of all.
    """
    motion, closes = _quick_answer(rows, tolerances)
    if motion is None and not closes:
        motion, closes = least_stopped(rows, tolerances)
    return None if closes else motion


def _quick_answer(rows: Rows, tolerances: Tolerances) -> tuple[Vector | None, bool]:
    """A motion that is stopped by no more than that, and whether the rows close; neither near a tie."""
    found = closure_test(rows, tolerances)
    if found.closes:
        return None, True
    for motion in (found.motion, tucker_partition(rows, tolerances.near).escape):
        if motion is not None and (rows @ motion).max(initial=-np.inf) <= tolerances.near:
            return motion, False
    return None, False


def _at_least(cost: float, costs: Weights) -> int:
    """How many candidates cost that much at least."""
    return int(np.ceil(cost / float(costs.max()) - DEFAULT.near))


def _too_near(cover: Indices, places: Points | None, spacing: float) -> tuple[int, int] | None:
    if places is None or spacing <= 0:
        return None
    for index, first in enumerate(cover):
        away = np.linalg.norm(places[cover[index + 1 :]] - places[first], axis=1)
        if (away < spacing).any():
            return int(first), int(cover[index + 1 + int(np.argmin(away))])
    return None


def strongest(
    rows: Several, base: Indices, pool: Indices, cover: Indices, motion: Vector, tolerances: Tolerances
) -> tuple[Vector, Mask]:
    """The motion of a largest set that has ``cover`` and still leaves something free, and who stops it.

    Candidates that the motion does not meet join at once; each other one if the set still does not close with it,
    which most often gives a new motion that others do not meet either; near a tie it stays out. After some that could
    not join the rest is left out: a cut need not be the strongest to be right.
    """
    cut = stops(rows[pool], motion, tolerances.near)
    cut[cover] = False
    tried, failures = np.zeros(len(pool), dtype=bool), 0
    inside = flat(rows, np.concatenate([base, pool[~cut]]))
    while failures < _FAILURES and (cut & ~tried).any():
        # the one that is stopped least is the likeliest to leave a motion free
        left = np.flatnonzero(cut & ~tried)
        values = (rows[pool[left]] @ motion).max(axis=1)
        candidate = int(left[np.argmin(values)])
        tried[candidate] = True
        other, _ = _quick_answer(np.vstack([inside, rows[pool[candidate]]]), tolerances)
        failures += 1
        if other is None:
            continue
        fewer = cut & stops(rows[pool], other, tolerances.near)
        fewer[candidate] = False
        if fewer.any():  # else it is free only up to rounding: all together do stop it
            motion, cut, failures = other, fewer, 0
            inside = flat(rows, np.concatenate([base, pool[~cut]]))
    return motion, cut
