"""The search for the best of the fewest: straight ways out, locators within one of them, clamps against these.

For each cell of directions (`straight`) the number of clamps has a lower bound: those that close with *all* locators
that the cell allows. Cells are searched in the order of their bounds, and left alone where they cannot be better than
what is there already; so the smallest bound of all cells proves the number of elements.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.accuracy_bounds import largest_volume, least_error
from fixture_design.design.anything import closing_elements
from fixture_design.design.clamping import closes, held_best, locators_for, margins
from fixture_design.design.closing import fewest_closing
from fixture_design.design.found import Found, Outcome
from fixture_design.design.hitting import fewest_stopping
from fixture_design.design.locating import exchanged, independent
from fixture_design.design.locating_several import inexactness_of, located_elements, redundancy
from fixture_design.design.moving import held_together, moved_while_closed
from fixture_design.design.pressing import least_bound, least_here, pressed_clamps, pressed_together
from fixture_design.design.problem import Problem
from fixture_design.design.regions import Region, regions_of
from fixture_design.design.removing import bound_both_ways
from fixture_design.design.task import Objective
from fixture_design.design.ways import Progress

#: Restarts in one region, and regions that are searched for better layouts of the same size.
RESTARTS, MOST_REGIONS = 24, 8
#: Restarts without anything better, after which a region is left where clamps push, or all move for the margin: each
#: one takes hundreds of linear programs, or of hulls. In a region that has not given anything better yet, fewer.
_PATIENCE, _FIRST_PATIENCE = 4, 2
#: What an element of the start costs next to a new one [-]: it is kept where that makes no difference to the number.
_KEPT_COST = 0.99


def search(problem: Problem, seed: int, progress: Progress = lambda words, part: None) -> Outcome:
    """The best layout that the search meets, with bounds of the number of clamps and of the accuracy."""
    if not (problem.locates or problem.leaves or problem.closes is None):
        return _whatever_closes(problem, seed)
    regions, complete = regions_of(problem, seed)
    complete = complete and not problem.vague
    best: Found | None = None
    for number, region in enumerate(regions):
        if problem.cancelled() or (best is not None and (region.bound > len(best.clamps) or number >= MOST_REGIONS)):
            break
        progress(f"way out {number + 1} of {len(regions)}", number / len(regions))
        best = _better_within(problem, region, np.random.default_rng([seed, number]), best)
    least = min((region.bound for region in regions), default=None)
    if best is None:
        return Outcome(best, least, complete)
    return _with_bounds(problem, best, regions, least, complete)


def search_region(problem: Problem, region: Region, seed: int, restarts: int = RESTARTS) -> Outcome:
    """The best layout of one region, with its bounds."""
    best = _better_within(problem, region, np.random.default_rng(seed), None, restarts)
    return (
        Outcome(None, region.bound, True) if best is None else _with_bounds(problem, best, [region], region.bound, True)
    )


def _with_bounds(
    problem: Problem, best: Found, regions: Sequence[Region], least: int | None, complete: bool
) -> Outcome:
    """With bounds over all regions that might do with as few clamps; none of accuracy where rows are redundant."""
    left = [region for region in regions if region.bound <= len(best.clamps)]
    preload, here = None, None
    if np.isfinite(best.preload) or not best.holds:  # what balances nothing is not compared with what does
        preload, here = _best_preload(problem, left), _best_preload_here(problem, best)
    redundant = redundancy(problem, best.locators) > 0
    return Outcome(best, least, complete, None if redundant else _best_accuracy(problem, left), preload, here)


def _whatever_closes(problem: Problem, seed: int) -> Outcome:
    """As few elements as close; the last one is the clamp."""
    chosen, least = closing_elements(problem, seed)
    least += len(problem.kept)
    if chosen is None:
        return Outcome(None, 0, not problem.vague, least_elements=least)
    was = np.isin(chosen, problem.spare)
    new = chosen[~was]
    clamps = np.concatenate([problem.kept[len(problem.locators) :], chosen[was], new[-1:]])
    locators = np.concatenate([problem.kept[: len(problem.locators)], new[:-1]])
    margin = float(margins(problem.closing_rows, np.concatenate([locators, clamps])[None])[0])
    found = Found(locators, clamps, None, accuracy(problem, locators), margin)
    return Outcome(found, 0, not problem.vague, least_elements=least)


def _better_within(
    problem: Problem, region: Region, rng: np.random.Generator, best: Found | None, restarts: int = RESTARTS
) -> Found | None:
    """The best of one region, or ``best`` if that is better."""
    slow = problem.pushing is not None or _before_accuracy(problem, "margin")
    in_vain, patience = 0, restarts if not slow else _FIRST_PATIENCE if best else _PATIENCE
    for restart in range(restarts):
        if problem.cancelled() or in_vain >= patience:
            break
        before = best
        first = _reacting(problem, region, rng) if restart == 0 else None
        for locators, clamps in _sets(problem, region, rng, best, first):
            if problem.slides and bound_both_ways(problem.candidates, locators):
                continue  # no motion leaves all of them
            found = _finished(problem, region, locators, clamps, best)
            if best is None or found.score(problem.objective) < best.score(problem.objective):
                best = found
        in_vain, patience = (in_vain + 1, patience) if best is before else (0, max(patience, _PATIENCE))
    return best


def _sets(
    problem: Problem, region: Region, rng: np.random.Generator, best: Found | None, locators: Indices | None
) -> Iterator[tuple[Indices, Indices]]:
    """Locators, by default after exchanges, with clamps for them, if these could be better than what is there; then,
    as long as there are more clamps than the bound says, clamps first and locators for them.
    """
    short = best is None or len(best.clamps) > region.bound
    locators = _located(problem, region, rng) if locators is None else locators
    if locators is None:
        return
    hoped = Found(locators, problem.new[: region.bound], region.out, accuracy(problem, locators), np.inf, 0.0)
    if best is None or hoped.score(problem.objective) < best.score(problem.objective):
        clamps = clamps_for(problem, locators)
        if clamps is not None:
            yield locators, clamps
            short = short and len(clamps) > region.bound
    if short and problem.closes == "without friction":
        yield from _turned_round(problem, region, rng)


def _reacting(problem: Problem, region: Region, rng: np.random.Generator) -> Indices | None:
    """Locators that the least preloads would press, where preloads count before accuracy; else None."""
    if problem.pushing is None or not _before_accuracy(problem, "preload"):
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


def _before_accuracy(problem: Problem, what: Objective) -> bool:
    order = problem.objective
    return what in order and ("accuracy" not in order or order.index(what) < order.index("accuracy"))


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

    def allowed(chosen: Indices) -> np.ndarray:
        return np.array([joins(np.delete(chosen, place)) for place in range(len(chosen))])

    spaced = problem.crowded
    rows = independent(problem.rows, pool, kept, rng, problem.candidates.freedoms, joins if spaced else None)
    if len(rows) < problem.candidates.freedoms:
        return None
    if not _before_accuracy(problem, "margin"):  # else they are moved with the clamps, to where all hold best
        rows = exchanged(problem.rows, pool, rows, kept, problem.features, allowed if spaced else None)
    return np.union1d(problem.owners(rows), np.array(problem.locators, dtype=np.int64))


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
    if problem.locators or problem.clamps or problem.limits.spacing > 0 or problem.each > 1:
        return
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
    clamps = region.clamps.chosen if region.clamps is not None else None
    usable = problem.passing(region.pool, region.out)
    locators = None if clamps is None or not len(usable) else locators_for(problem.rows, usable, clamps, rng)
    if locators is not None and clamps is not None and problem.together(np.concatenate([locators, clamps])):
        yield moved_while_closed(problem, usable, locators, clamps, none), clamps


def _finished(problem: Problem, region: Region, locators: Indices, clamps: Indices, best: Found | None) -> Found:
    """The set with its clamps where they hold best, and what it is worth.

    Args:
        best: what there is already: where the fewest elements come first, no clamps are added beyond its number.
    """
    margin = 0.0
    if problem.closes is not None and closes(problem.closing_rows, np.concatenate([locators, clamps])):
        locators, clamps, margin = _held(problem, region, locators, clamps)
    preload, holds = 0.0, True
    if problem.pushing is not None:
        most = len(best.clamps) if best and best.holds and problem.objective[:1] == ("fewest",) else None
        pressed = pressed_clamps(problem, problem.pushing, locators, clamps, most)
        if _before_accuracy(problem, "preload") and (pressed.holds or most is None):
            locators, pressed = pressed_together(
                problem, problem.pushing, problem.passing(region.pool, region.out), locators, pressed
            )
        clamps, margin, preload, holds = pressed.clamps, pressed.margin, pressed.total, pressed.holds
    return Found(_by_face(problem, locators), clamps, region.out, accuracy(problem, locators), margin, preload, holds)


def _held(problem: Problem, region: Region, locators: Indices, clamps: Indices) -> tuple[Indices, Indices, float]:
    """New clamps where they hold best, and locators too where that counts before accuracy; and the margin."""
    staying = np.array([*problem.kept, *problem.spare], dtype=np.int64)
    if _before_accuracy(problem, "margin") and not problem.slides:
        return held_together(problem, problem.passing(region.pool, region.out), locators, clamps, staying)
    new = clamps[~np.isin(clamps, staying)]
    others = np.concatenate([locators, clamps[np.isin(clamps, staying)]])
    places, spacing = problem.candidates.places, problem.limits.spacing
    moved, margin = held_best(problem.closing_rows, others, new, problem.new, places, spacing, problem.standing)
    return locators, np.concatenate([clamps[~np.isin(clamps, new)], moved]), margin


def _by_face(problem: Problem, locators: Indices) -> Indices:
    """Locators in the order of their numbering: the face with most of them first (3, 2, 1), then as they came."""
    features = [problem.candidates.features[index] for index in locators.tolist()]
    order = sorted(range(len(locators)), key=lambda k: (-features.count(features[k]), features[k], locators[k]))
    return locators[order]


def _best_accuracy(problem: Problem, regions: Sequence[Region]) -> float:
    """A bound over all regions that might do with so few clamps."""
    least = np.inf
    for region in regions:
        pool = np.concatenate([problem.rows_of(region.pool), problem.rows_of(problem.locators)])
        if problem.features is not None and problem.candidates.freedoms == problem.candidates.dimension:
            least = min(least, least_error(problem.rows, problem.features, pool))
        else:
            least = min(least, 1.0 / largest_volume(problem.rows[pool] @ problem.noticed.T))
    return float(least)


def _best_preload_here(problem: Problem, best: Found) -> float | None:
    """The same for clamps anywhere against the locators that were found."""
    return None if problem.pushing_bound is None else least_here(problem, problem.pushing_bound, best.locators)


def _best_preload(problem: Problem, regions: Sequence[Region]) -> float | None:
    """The same for preloads; None where nobody asks, or the search was stopped."""
    program = problem.pushing_bound
    if program is None or problem.cancelled():
        return None
    bounds = [least_bound(problem, program, region.pool)[0] for region in regions]
    return None if None in bounds else min(bound for bound in bounds if bound is not None)


def accuracy(problem: Problem, locators: Indices) -> float:
    """Of locators; small is good."""
    return inexactness_of(problem, locators)
