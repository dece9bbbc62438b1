"""Clamps against locators: the fewest that close, where they hold best; and locators that some clamps close with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Indices, Points, Rows, Weights
from fixture_design.cones.kernel import closure_tests, double_description
from fixture_design.design.candidates import Several, flat
from fixture_design.design.hitting import free_motion
from fixture_design.design.locating import apart
from fixture_design.design.standing import Standing
from fixture_design.tolerances import BETTER, DEFAULT, SUPPORT

#: Rounds of moving every element once, at most.
_MOST_ROUNDS = 20
#: The motions that more rows leave free are too many to be listed every time.
_FEW_ROWS = 16


def margins(rows: Several, sets: np.ndarray) -> np.ndarray:
    """A lower bound of the margin of closure for sets of candidates, all of one size: shape (s, size) to (s,)."""
    each = rows.shape[1]
    flat_rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[2]))
    places = (sets[:, :, None] * each + np.arange(each)).reshape(len(sets), each * sets.shape[1])
    offsets = np.arange(len(sets) + 1) * places.shape[1]
    return closure_tests(flat_rows, offsets, np.ascontiguousarray(places.ravel())).lower


def margins_with(rows: Several, rest: Indices, pool: Indices, least: float = 0.0) -> Weights:
    """Lower bounds of the margin of closure of the rest with each of the pool; 0 for those not above ``least``.

    What the rest leaves free, a motion u with |u| = 1, is stopped by the one that joins alone: no margin is above its
    max_j d_j . u. That leaves few to be looked at.
    """
    found = np.zeros(len(pool))
    likely = np.flatnonzero(_most_with(rows, rest, pool) > least)
    found[likely] = margins(rows, np.column_stack([np.broadcast_to(rest, (len(likely), len(rest))), pool[likely]]))
    return np.where(found > least, found, 0.0)


def _most_with(rows: Several, rest: Indices, pool: Indices) -> Weights:
    """An upper bound of the margin of closure of the rest with each of the pool; infinite where none is known."""
    there = flat(rows, rest)
    if len(there) > _FEW_ROWS:
        return np.full(len(pool), np.inf)
    free = double_description(there, there[:0], DEFAULT.tie)
    motions = np.vstack([free.rays, free.lines, -free.lines])
    return (rows[pool] @ motions.T).max(axis=1).min(axis=1, initial=np.inf)


def held_best(
    rows: Several,
    others: Sequence[int] | Indices,
    moving: Sequence[int] | Indices,
    pool: Indices,
    places: Points | None = None,
    spacing: float = 0.0,
    standing: Standing | None = None,
) -> tuple[Indices, float]:
    """Places for some elements of a closed set with the largest margin, moved one after the other; and the margin.

    Args:
        others: indices of those that stay.  moving: indices of those that may move, to any of ``pool``.
        places, spacing: they keep this far from each other [m].  standing: and out of each other's way.
    """
    moving = np.array(moving, dtype=np.int64)
    others = np.asarray(others, dtype=np.int64)
    best = float(margins(rows, np.concatenate([others, moving])[None])[0])
    for _ in range(_MOST_ROUNDS):
        before = best
        for place in range(len(moving)):
            rest = np.concatenate([others, np.delete(moving, place)])
            free = pool[~np.isin(pool, rest)]
            if places is not None:
                free = free[apart(places, rest, free, spacing)]
            if standing is not None:
                free = free[standing.free(rest, free)]
            if not len(free):
                continue
            found = margins_with(rows, rest, free, best)
            if found.max() > best * (1 + BETTER):
                best = float(found.max())
                moving[place] = free[int(np.argmax(found))]
        if best <= before * (1 + BETTER):
            break
    return moving, best


def locators_for(
    rows: Rows, pool: Indices, clamps: Sequence[int] | Indices, rng: np.random.Generator
) -> Indices | None:
    """Independent locators, as many as the part has freedoms, that close with these clamps; None where not found.

    They are the support of a basic solution of  sum w_i d_i + sum v_k d_k = 0, w >= 0, v >= 1, over the locators i and
    clamps k, for an objective drawn at random.

    Args:
        rows: unit rows of all candidates, shape (n, d).
    """
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    both = np.concatenate([pool, np.asarray(clamps, dtype=np.int64)])
    costs = np.concatenate([0.1 + rng.random(len(pool)), rng.random(len(clamps))])
    low = np.concatenate([np.zeros(len(pool)), np.ones(len(clamps))])
    limits = np.column_stack([low, np.full(len(both), np.inf)])
    found = linprog(costs, A_eq=rows[both].T, b_eq=np.zeros(rows.shape[1]), bounds=limits, method="highs-ds")
    if found.x is None:
        return None
    weights = found.x[: len(pool)]
    chosen = pool[weights > SUPPORT * weights.max(initial=0.0)]
    if len(chosen) != rows.shape[1] or free_motion(rows[np.concatenate([chosen, clamps])]) is not None:
        return None
    return chosen


def closes(rows: Several, chosen: Sequence[int] | Indices) -> bool:
    """Whether candidates close for certain."""
    return free_motion(flat(rows, chosen)) is None
