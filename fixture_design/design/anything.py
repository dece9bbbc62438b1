"""Elements that close, where nothing is asked of the locators: as few as there can be, whatever their roles."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.adding import added
from fixture_design.design.candidates import Several
from fixture_design.design.clamping import closes, held_best
from fixture_design.design.closing import fewest_closing
from fixture_design.design.hitting import Hitting, fewest_stopping
from fixture_design.design.problem import Problem

#: Cuts after which the fewest are not known, and few are taken.
_MOST_CUTS = 150


def closing_elements(problem: Problem, seed: int) -> tuple[Indices | None, int]:
    """New elements that close together with those that stay, and a lower bound of how many there must be.

    Without friction d + 1 rows are the fewest there can be, and most often found at once; else hitting sets are asked,
    and if these take too long, elements are added one after the other and those that are not needed leave.
    """
    rng, dimension = np.random.default_rng(seed), problem.candidates.dimension
    rows = problem.closing_rows
    if problem.closes == "without friction" and problem.each == 1 and not len(problem.kept):
        chosen = fewest_closing(problem.rows[problem.new], rng, cancelled=problem.cancelled)
        if chosen is not None and len(chosen) == dimension + 1 and problem.limits.spacing == 0:
            best = held_best(rows, (), problem.new[chosen], problem.new, standing=problem.standing)[0]
            if problem.together(best):
                return best, dimension + 1
    pool = problem.clampable
    pool = pool[problem.joins(pool, problem.kept)]
    found = _fewest(problem, rows, pool)
    bound = found.bound
    if problem.closes == "with friction":  # what does not close with pyramids in the cones may close with the cones
        bound = _fewest(problem, problem.bounding_rows, pool).bound
    if found.chosen is not None or found.complete:
        return found.chosen, bound
    return _few(problem, pool), bound


def _fewest(problem: Problem, rows: Several, pool: Indices) -> Hitting:
    return fewest_stopping(
        rows, problem.kept, pool, places=problem.candidates.places, spacing=problem.limits.spacing,
        standing=problem.standing, most_cuts=_MOST_CUTS, tolerances=problem.candidates.tolerances,
        cancelled=problem.cancelled,
    )  # fmt: skip


def _few(problem: Problem, pool: Indices) -> Indices | None:
    """Added one after the other, without those that the others do without."""
    chosen = [index for index, _ in added(problem.closing_rows, problem.kept, pool)]
    if not closes(problem.closing_rows, [*problem.kept, *chosen]):
        return None
    for index in list(chosen):
        others = [other for other in chosen if other != index]
        if closes(problem.closing_rows, [*problem.kept, *others]):
            chosen = others
    few = np.array(chosen, dtype=np.int64)
    return few if problem.together(few) else None
