"""Sets of elements to look at in one region: locators first and clamps for them, or the other way round."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.clamping import held_best, locators_for, margins_with
from fixture_design.design.closing import fewest_closing
from fixture_design.design.found import Found
from fixture_design.design.hitting import fewest_stopping
from fixture_design.design.locating import exchanged, independent
from fixture_design.design.locating_several import inexactness_of, located_elements
from fixture_design.design.moving import moved_while_closed
from fixture_design.design.pressing import least_bound
from fixture_design.design.problem import Problem
from fixture_design.design.regions import Region
from fixture_design.design.task import Objective

#: What an element of the start costs next to a new one [-]: it is kept where that makes no difference to the number.
_KEPT_COST = 0.99


def sets_of(
    problem: Problem, region: Region, rng: np.random.Generator, best: Found | None, locators: Indices | None
) -> Iterator[tuple[Indices, Indices]]:
    """Locators, by default after exchanges, with clamps for them, if these could be better than what is there; then,
    as long as there are more clamps than the bound says, clamps first and locators for them.
    """
    short = best is None or len(best.clamps) > region.bound
    locators = _located(problem, region, rng) if locators is None else locators
    if locators is None:
        return
    hoped = Found(locators, problem.new[: region.bound], region.out, inexactness_of(problem, locators), np.inf, 0.0)
    if best is None or hoped.score(problem.objective) < best.score(problem.objective):
        clamps = clamps_for(problem, locators)
        if clamps is not None:
            yield locators, clamps
            short = short and len(clamps) > region.bound
    if problem.closes != "without friction" or not _free_to_turn_round(problem):
        return
    if short:
        yield from _turned_round(problem, region, rng)
    elif best is not None and region.out is not None:
        yield from _against(problem, region, _one_elsewhere(problem, best, rng), rng)


def _free_to_turn_round(problem: Problem) -> bool:
    """Whether locators are found for clamps: where no element stays, in any spacing, with one row each."""
    return not (problem.locators or problem.clamps or problem.limits.spacing > 0 or problem.each > 1)


def _located(problem: Problem, region: Region, rng: np.random.Generator) -> Indices | None:
    """Locators of a region after exchanges, the kept ones among them; None where there are not enough."""
    if problem.several:
        return located_elements(problem, problem.passing(region.pool, region.out), rng)
    kept = problem.rows_of(problem.locators)
    kept = independent(problem.rows, kept, (), rng, problem.candidates.freedoms) if len(kept) else kept
    usable = problem.passing(region.pool, region.out)
    pool = usable * problem.each

    def joins(chosen: object) -> np.ndarray:
        owners = np.concatenate([problem.kept, np.asarray(chosen, dtype=np.int64) // problem.each])
        return problem.joins(usable, owners)

    def allowed(chosen: Indices, better: np.ndarray) -> np.ndarray:
        return better & np.array([joins(np.delete(chosen, place)) for place in range(len(chosen))])

    spaced = problem.crowded
    rows = independent(problem.rows, pool, kept, rng, problem.candidates.freedoms, joins if spaced else None)
    if len(rows) < problem.candidates.freedoms:
        return None
    if not before_accuracy(problem, "margin"):  # else they are moved with the clamps, to where all hold best
        rows = exchanged(problem.rows, pool, rows, kept, problem.features, allowed if spaced else None)
    return np.union1d(problem.owners(rows), np.array(problem.locators, dtype=np.int64))


def reacting(problem: Problem, region: Region, rng: np.random.Generator) -> Indices | None:
    """Locators that the least preloads would press, where preloads count before accuracy; else None."""
    if problem.pushing is None or not before_accuracy(problem, "preload"):
        return None
    _, reacting = least_bound(problem, problem.pushing, region.pool)
    kept = problem.rows_of(problem.locators)
    freedoms = problem.candidates.freedoms
    rows = independent(problem.rows, problem.rows_of(reacting), kept, rng, freedoms)
    rows = independent(problem.rows, problem.rows_of(region.pool), rows, rng, freedoms)
    new = np.setdiff1d(problem.owners(rows), problem.kept)
    if len(rows) < freedoms or not problem.together(new) or not problem.joins(new, problem.kept).all():
        return None
    return np.union1d(problem.owners(rows), np.array(problem.locators, dtype=np.int64))


def before_accuracy(problem: Problem, what: Objective) -> bool:
    order = problem.objective
    return what in order and ("accuracy" not in order or order.index(what) < order.index("accuracy"))


def clamps_for(problem: Problem, locators: Indices) -> Indices | None:
    """The fewest clamps that close with these locators, the kept ones first; None where there are none."""
    if problem.closes is None:
        return np.array(problem.clamps, dtype=np.int64)
    base = np.concatenate([locators, np.array(problem.clamps, dtype=np.int64)])
    pool = np.setdiff1d(problem.clampable, base)
    pool = pool[problem.joins(pool, base)]
    costs = np.where(np.isin(pool, problem.spare), _KEPT_COST, 1.0)
    found = fewest_stopping(
        problem.closing_rows, base, pool, costs=costs, places=problem.candidates.places,
        spacing=problem.limits.spacing, standing=problem.standing, tolerances=problem.candidates.tolerances,
        cancelled=problem.cancelled,
    )  # fmt: skip
    if found.chosen is None:
        return None
    return np.concatenate([np.array(problem.clamps, dtype=np.int64), found.chosen])


def _turned_round(problem: Problem, region: Region, rng: np.random.Generator) -> Iterator[tuple[Indices, Indices]]:
    """Fewer clamps first, then locators for them: those of the bound, or of a smallest set that closes."""
    none = problem.new[:0]
    if region.out is None:
        chosen = fewest_closing(problem.rows, rng, tries=3, cancelled=problem.cancelled)
        if chosen is not None and len(chosen) == problem.candidates.freedoms + 1:
            chosen, _ = held_best(problem.closing_rows, (), chosen, problem.new, standing=problem.standing)
            if not problem.together(chosen):
                return
            clamp = int(rng.integers(len(chosen)))
            yield (
                moved_while_closed(problem, region.pool, np.delete(chosen, clamp), chosen[[clamp]], none),
                chosen[[clamp]],
            )
        return
    if region.clamps is not None and region.clamps.chosen is not None:
        yield from _against(problem, region, region.clamps.chosen, rng)


def _one_elsewhere(problem: Problem, best: Found, rng: np.random.Generator) -> Indices:
    """The clamps of a layout, with one of them at any place, by chance, where all still close."""
    if not len(best.clamps):
        return best.clamps
    clamps = rng.permutation(best.clamps)
    rest = np.concatenate([best.locators, clamps[1:]])
    free = problem.clampable[problem.joins(problem.clampable, rest)]
    free = free[margins_with(problem.closing_rows, rest, free) > 0]
    return np.append(clamps[1:], rng.choice(free)) if len(free) else clamps


def _against(
    problem: Problem, region: Region, clamps: Indices, rng: np.random.Generator
) -> Iterator[tuple[Indices, Indices]]:
    """Locators for some clamps, from a random start."""
    usable = problem.passing(region.pool, region.out)
    locators = None if not len(usable) else locators_for(problem.rows, usable, clamps, rng)
    if locators is not None and problem.together(np.concatenate([locators, clamps])):
        yield moved_while_closed(problem, usable, locators, clamps, problem.new[:0]), clamps
