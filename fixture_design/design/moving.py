"""Locators moved: to where they are more exact without opening what the clamps close, or to where all hold best."""

from __future__ import annotations

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Indices, Mask
from fixture_design.design.candidates import flat
from fixture_design.design.clamping import margins, margins_with
from fixture_design.design.locating import MOST_EXCHANGES, exchanged
from fixture_design.design.locating_several import inexactness_of
from fixture_design.design.problem import Problem
from fixture_design.tolerances import BETTER, GOOD_MARGIN

#: Turns of moving all elements, at most, and candidates whose margin is looked at in each.
_MOST_TURNS, _LOOKED_AT = 20, 16


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

    def allowed(chosen: Indices, better: np.ndarray) -> np.ndarray:
        found = better.copy()
        for place in range(len(chosen)):
            rest = np.concatenate([np.delete(chosen, place), clamps])
            found[place, better[place]] = _fits(problem, pool[better[place]], rest, least)
        return found

    return exchanged(problem.rows, pool, locators, fixed, problem.features, allowed, most)


def held_together(
    problem: Problem, pool: Indices, locators: Indices, clamps: Indices, staying: Indices
) -> tuple[Indices, Indices, float]:
    """Locators and clamps of a closed set, moved one after the other to where the margin of closure is largest.

    Args:
        pool: where locators may be: they still determine the part.  staying: elements that do not move.

    Returns:
        locators, clamps, and the margin itself, no bound.
    """
    chosen, best = np.concatenate([locators, clamps]), 0.0
    for _ in range(_MOST_TURNS):
        before = best
        for place in np.flatnonzero(~np.isin(chosen, staying)).tolist():
            locating = place < len(locators)
            rest = np.delete(chosen, place)
            free = np.setdiff1d(pool if locating else problem.new, rest)
            free = np.append(free[problem.joins(free, rest)], chosen[place])
            for margin, candidate in _holding_best(problem, rest, free):
                moved = chosen.copy()
                moved[place] = candidate
                if margin > best * (1 + BETTER) and not (locating and _loose(problem, moved[: len(locators)])):
                    chosen, best = moved, margin
                    break
        if best <= before * (1 + BETTER):
            break
    return chosen[: len(locators)], chosen[len(locators) :], best


def _holding_best(problem: Problem, rest: Indices, free: Indices) -> list[tuple[float, int]]:
    """Margins with one more element, largest first, of those candidates whose bounds say most; ``free`` ends with the
    one that is there.
    """
    rows = problem.closing_rows
    bounds = margins_with(rows, rest, free)
    looked_at = np.union1d(np.argsort(-bounds, kind="stable")[:_LOOKED_AT], [len(free) - 1])
    found = []
    for choice in looked_at[bounds[looked_at] > 0]:
        facet = nearest_facet(flat(rows, np.append(rest, free[choice])))
        found.append((float(bounds[choice]) if facet is None else facet.distance, int(free[choice])))
    return sorted(found, reverse=True)


def _loose(problem: Problem, locators: Indices) -> bool:
    return problem.locates and not np.isfinite(inexactness_of(problem, locators))


def _fits(problem: Problem, pool: Indices, rest: Indices, least: float) -> Mask:
    """Which of the pool may join the rest, and close with it by more than ``least``."""
    joins = problem.joins(pool, rest)
    if problem.closes is None:
        return joins
    return joins & (margins_with(problem.closing_rows, rest, pool, least) > 0)
