"""Locators moved to where they are more exact, without opening what the clamps close."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Mask
from fixture_design.design.clamping import margins
from fixture_design.design.locating import MOST_EXCHANGES, exchanged
from fixture_design.design.problem import Problem
from fixture_design.tolerances import GOOD_MARGIN


def moved_while_closed(
    problem: Problem,
    pool: Indices,
    locators: Indices,
    clamps: Indices,
    fixed: Indices,
    most: int = MOST_EXCHANGES,
) -> Indices:
    """Locators after the best exchanges that leave the set as closed as it is, or as is good enough.

    Args:
        pool: where they may be.  fixed: those that stay.
        most: exchanges.
    """
    least = 0.0
    if problem.closes is not None:
        now = float(margins(problem.closing_rows, np.concatenate([locators, clamps])[None])[0])
        least = min(now, max(GOOD_MARGIN, 2 * problem.candidates.tolerances.near))

    def allowed(chosen: Indices) -> np.ndarray:
        return np.array([_fits(problem, pool, np.concatenate([np.delete(chosen, place), clamps]), least)
                         for place in range(len(chosen))])  # fmt: skip

    return exchanged(problem.rows, pool, locators, fixed, problem.features, allowed, most)


def _fits(problem: Problem, pool: Indices, rest: Indices, least: float) -> Mask:
    """Which of the pool may join the rest, and close with it by more than ``least``."""
    joins = problem.joins(pool, rest)
    if problem.closes is None:
        return joins
    sets = np.column_stack([np.broadcast_to(rest, (len(pool), len(rest))), pool])
    return joins & (margins(problem.closing_rows, sets) > least)
