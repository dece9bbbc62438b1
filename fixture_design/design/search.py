"""The search for the best of the fewest: straight ways out, locators within one of them, clamps against these.

For each cell of directions (`straight`) the number of clamps has a lower bound: those that close with *all* locators
that the cell allows. Cells are searched in the order of their bounds, and left alone where they cannot be better than
what is there already; so the smallest bound of all cells proves the number of elements.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.accuracy_bounds import largest_volume, least_error
from fixture_design.design.anything import closing_elements
from fixture_design.design.clamping import closes, held_best, margins
from fixture_design.design.found import Found, Outcome
from fixture_design.design.locating_several import inexactness_of, redundancy
from fixture_design.design.moving import held_together
from fixture_design.design.pressing import least_bound, least_here, pressed_clamps, pressed_together
from fixture_design.design.problem import Problem
from fixture_design.design.regions import Region, regions_of
from fixture_design.design.removing import bound_both_ways
from fixture_design.design.rubbing import rubs, seated
from fixture_design.design.sets import before_accuracy, reacting, sets_of
from fixture_design.design.square import square_sets
from fixture_design.design.ways import Progress

#: Restarts in one region, and regions that are searched for better layouts of the same size.
RESTARTS, MOST_REGIONS = 24, 8
#: Restarts without anything better, after which a region is left where clamps push: each one places them anew, by
#: hundreds of linear programs. In a region that has not given anything better yet, fewer.
_PATIENCE, _FIRST_PATIENCE = 4, 2


def search(problem: Problem, seed: int, progress: Progress = lambda words, part: None) -> Outcome:
    """The best layout that the search meets, with bounds of the number of clamps and of the accuracy."""
    if not (problem.locates or problem.leaves or problem.closes is None):
        return _whatever_closes(problem, seed)
    regions, complete = regions_of(problem, seed)
    complete = complete and not problem.vague
    best = _best_square(problem, regions, seed, progress) if rubs(problem) else None
    hopeless = 0
    for number, region in enumerate(regions):
        if problem.cancelled() or (best is not None and (_too_many(region, best) or number >= MOST_REGIONS)):
            break
        progress(f"way out {number + 1} of {len(regions)}", number / len(regions))
        if (best is None or not best.holds) and _never_holds(problem, region):
            hopeless += 1
            continue
        best = _better_within(problem, region, np.random.default_rng([seed, number]), best)
    least = min((region.bound for region in regions), default=None)
    if best is None:
        none = np.inf if regions and hopeless == len(regions) else None
        return Outcome(best, least, complete, best_preload=none)
    return _with_bounds(problem, best, regions, least, complete)


def _never_holds(problem: Problem, region: Region) -> bool:
    """Whether no locators of a region, with clamps anywhere, can hold what they have to within the limits of these."""
    if problem.pushing_bound is None or not problem.pushing_bound.duties.required:
        return False
    return least_bound(problem, problem.pushing_bound, region.pool)[0] == np.inf


def _too_many(region: Region, best: Found) -> bool:
    """Whether a region has no layout with as few clamps as there is."""
    return best.seats and region.bound > len(best.clamps)


def _best_square(problem: Problem, regions: Sequence[Region], seed: int, progress: Progress) -> Found | None:
    """The best set with clamps square against the faces that the part is to sit on; None where none seats it."""
    best: Found | None = None
    for number, region in enumerate(regions[:MOST_REGIONS]):
        progress(f"square against the faces of way out {number + 1}", 0.0)
        for locators, clamps in square_sets(problem, region, np.random.default_rng([seed, number])):
            if problem.cancelled():
                return best
            if best is not None and len(clamps) > len(best.clamps):
                continue
            found = _as_they_are(problem, region, locators, clamps)
            if found is not None and (best is None or found.score(problem.objective) < best.score(problem.objective)):
                best = found
    return best


def _as_they_are(problem: Problem, region: Region, locators: Indices, clamps: Indices) -> Found | None:
    """A set that is not moved any more; None where it does not seat the part."""
    pushes = seated(problem, locators, clamps)
    if pushes is None:
        return None
    margin = 0.0
    if problem.closes is not None:
        margin = float(margins(problem.closing_rows, np.concatenate([locators, clamps])[None])[0])
    total = float(pushes.pushes.sum())
    return Found(_by_face(problem, locators), clamps, region.out, inexactness_of(problem, locators), margin, total)


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
    """As few elements as close; the last ones are the clamps: one, or as many as are too many to be locators."""
    chosen, least = closing_elements(problem, seed)
    least += len(problem.kept)
    if chosen is None:
        return Outcome(None, 0, not problem.vague, least_elements=least)
    was = np.isin(chosen, problem.spare)
    new = chosen[~was]
    most = problem.limits.locators
    clamped = 1 if most is None else max(1, len(new) + len(problem.locators) - most)
    clamps = np.concatenate([problem.kept[len(problem.locators) :], chosen[was], new[len(new) - clamped :]])
    locators = np.concatenate([problem.kept[: len(problem.locators)], new[: len(new) - clamped]])
    margin = float(margins(problem.closing_rows, np.concatenate([locators, clamps])[None])[0])
    found = Found(locators, clamps, None, inexactness_of(problem, locators), margin)
    return Outcome(found, 0, not problem.vague, least_elements=least)


def _better_within(
    problem: Problem, region: Region, rng: np.random.Generator, best: Found | None, restarts: int = RESTARTS
) -> Found | None:
    """The best of one region, or ``best`` if that is better."""
    in_vain, patience = 0, restarts if problem.pushing is None else _FIRST_PATIENCE if best else _PATIENCE
    for restart in range(restarts):
        if problem.cancelled() or in_vain >= patience:
            break
        before = best
        first = reacting(problem, region, rng) if restart == 0 else None
        for locators, clamps in sets_of(problem, region, rng, best, first):
            if problem.slides and bound_both_ways(problem.candidates, locators):
                continue  # no motion leaves all of them
            found = _finished(problem, region, locators, clamps, best)
            if best is None or found.score(problem.objective) < best.score(problem.objective):
                best = found
        in_vain, patience = (in_vain + 1, patience) if best is before else (0, max(patience, _PATIENCE))
    return best


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
        most = len(best.clamps) if best and best.holds and best.seats and problem.objective[:1] == ("fewest",) else None
        pressed = pressed_clamps(problem, problem.pushing, locators, clamps, most)
        if before_accuracy(problem, "preload") and (pressed.holds or most is None):
            locators, pressed = pressed_together(
                problem, problem.pushing, problem.passing(region.pool, region.out), locators, pressed
            )
        clamps, margin, preload, holds = pressed.clamps, pressed.margin, pressed.total, pressed.holds
    error = inexactness_of(problem, locators)
    found = Found(_by_face(problem, locators), clamps, region.out, error, margin, preload, holds)
    if not (holds and rubs(problem)) or (best and found.score(problem.objective) >= best.score(problem.objective)):
        return found
    return replace(found, seats=seated(problem, locators, clamps) is not None)


def _held(problem: Problem, region: Region, locators: Indices, clamps: Indices) -> tuple[Indices, Indices, float]:
    """New clamps where they hold best, and locators too where that counts before accuracy; and the margin."""
    staying = np.array([*problem.kept, *problem.spare], dtype=np.int64)
    if before_accuracy(problem, "margin") and not problem.slides:
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
