"""Locators that place the part as exactly as they can: exchange search.

With as many locators as the part has freedoms, D their rows and e the errors along their normals, the part is off by
D^-1 e: a key feature by at most sum_i |a D^-1|_i e_i, with a the row of its point and direction. Without features
det D is made large (D-optimal), which keeps all errors small at once.

One locator i exchanged for a candidate j multiplies det D by (d_j D^-1)_i, and changes D^-1 by a matrix of rank one, so
that all exchanges are compared at once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Points, Rows, Weights
from fixture_design.tolerances import BETTER, DEFAULT

#: Exchanges of one descent at most.
MOST_EXCHANGES = 100
#: A determinant that shrinks by more than this in one exchange is on its way to a singular layout [-].
_LEAST_RATIO = 1e-3


@dataclass(frozen=True, eq=False)
class Features:
    """What accuracy is measured by.

    Attributes:
        rows: of the features' points and directions, in the candidates' scale, not scaled to length one, divided by
            their tolerances: shape (f, d).
        levers: shape (n,), by what a candidate's unit row must be multiplied to be a row with |n| = 1.
    """

    rows: Rows
    levers: Weights


def inaccuracy(rows: Rows, features: Features, chosen: Indices) -> float:
    """The worst error of a feature, in its tolerances, for errors of 1 along each locator's normal; small is good."""
    inverse = np.linalg.inv(rows[chosen] * features.levers[chosen, None])
    return float(np.abs(features.rows @ inverse).sum(axis=1).max())


def volume(rows: Rows, chosen: Indices) -> float:
    """|det D|, or of fewer rows than freedoms the volume that they span; large is good."""
    return float(np.sqrt(max(np.linalg.det(rows[chosen] @ rows[chosen].T), 0.0)))


def independent(
    rows: Rows,
    pool: Indices,
    fixed: Sequence[int] | Indices,
    rng: np.random.Generator,
    count: int,
    joins: Callable[[Sequence[int]], Mask] | None = None,
) -> Indices:
    """``count`` independent rows of a pool after the fixed ones: each one of those that are far off the span so far.

    Args:
        joins: for rows chosen so far, which of the pool may join them: shape (len(pool),).

    Returns:
        Their indices, the fixed ones first; fewer where there are no more.
    """
    chosen = [int(index) for index in fixed]
    rest = rows.copy()
    for index in chosen:
        _project_out(rest, index)
    while len(chosen) < count:
        lengths = np.linalg.norm(rest[pool], axis=1)
        lengths[np.isin(pool, chosen)] = 0.0
        if joins is not None:
            lengths[~joins(chosen)] = 0.0
        if lengths.max(initial=0.0) <= DEFAULT.near:
            break
        far = np.flatnonzero(lengths >= rng.uniform(0.5, 1.0) * lengths.max())
        chosen.append(int(pool[rng.choice(far)]))
        _project_out(rest, chosen[-1])
    return np.array(chosen, dtype=np.int64)


def _project_out(rest: Rows, index: int) -> None:
    length = np.linalg.norm(rest[index])
    if length > DEFAULT.near:
        direction = rest[index] / length
        rest -= np.outer(rest @ direction, direction)


def exchanged(
    rows: Rows,
    pool: Indices,
    chosen: Indices,
    fixed: Sequence[int] | Indices,
    features: Features | None = None,
    allowed: Callable[[Indices, np.ndarray], np.ndarray] | None = None,
    most: int = MOST_EXCHANGES,
) -> Indices:
    """Locators after the best exchanges, one after the other, until none makes them better.

    Args:
        rows: unit rows of all candidates, shape (n, d).  pool: from which new ones are taken.
        chosen: independent ones to begin with.  fixed: those of them that stay.
        features: what accuracy is measured by; None for the volume.
        most: exchanges.
        allowed: for locators at some indices, and those of the pool that would be better while each of them leaves,
            shape (k, len(pool)): which of these may join.
    """
    basis = _span(rows, chosen)
    inside = rows @ basis.T
    movable = ~np.isin(chosen, np.asarray(fixed, dtype=np.int64))
    for _ in range(most if len(pool) and movable.any() else 0):
        gains = _gains(inside, basis, pool, chosen, features)
        gains[~movable] = 0.0
        gains[:, np.isin(pool, chosen)] = 0.0
        if allowed is not None:
            gains[~allowed(chosen, gains > 1 + BETTER)] = 0.0
        place, candidate = np.unravel_index(int(np.argmax(gains)), gains.shape)
        if gains[place, candidate] <= 1 + BETTER:
            break
        chosen = chosen.copy()
        chosen[place] = pool[candidate]
    return chosen


def _span(rows: Rows, chosen: Indices) -> Rows:
    """Orthonormal rows that span those chosen."""
    return np.linalg.svd(rows[chosen], full_matrices=False)[2]


def _gains(inside: Points, basis: Rows, pool: Indices, chosen: Indices, features: Features | None) -> np.ndarray:
    """By how much better the locators get if the i-th leaves for each of the pool: above 1 is better."""
    inverse = np.linalg.inv(inside[chosen])
    ratios = inside[pool] @ inverse
    if features is None:
        return np.abs(ratios.T)
    wanted = features.rows @ basis.T @ inverse  # per unit row; errors are along unit normals
    now = float((np.abs(wanted) / features.levers[chosen]).sum(axis=1).max())
    gains = np.zeros((len(chosen), len(pool)))
    for place in range(len(chosen)):
        ratio = ratios[:, place]
        usable = np.abs(ratio) > _LEAST_RATIO
        share = wanted[:, place, None] / np.where(usable, ratio, 1.0)
        changed = wanted[:, None, :] - share[:, :, None] * ratios[None]
        changed[:, :, place] = share
        levers = np.broadcast_to(features.levers[chosen], (len(pool), len(chosen))).copy()
        levers[:, place] = features.levers[pool]
        worst = (np.abs(changed) / levers).sum(axis=2).max(axis=0)
        gains[place] = np.where(usable, now / np.maximum(worst, np.finfo(float).tiny), 0.0)
    return gains


def apart(places: Points, chosen: Sequence[int] | Indices, pool: Indices, spacing: float) -> Mask:
    """Which of a pool are at least ``spacing`` from all chosen ones."""
    free = np.ones(len(pool), dtype=bool)
    for index in chosen if spacing > 0 else ():
        free &= np.linalg.norm(places[pool] - places[index], axis=1) >= spacing
    return free
