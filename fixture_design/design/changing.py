"""The fewest changes of a layout over all its ways out, at their best places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.contacts import Role
from fixture_design.design.changes import Options, fewest_changes
from fixture_design.design.clamping import closes, held_best
from fixture_design.design.locating import exchanged
from fixture_design.design.moving import moved_while_closed
from fixture_design.design.pressing import pressed_clamps
from fixture_design.design.problem import Problem
from fixture_design.design.regions import ways_out
from fixture_design.design.search import search
from fixture_design.design.start import begun
from fixture_design.design.task import Task
from fixture_design.design.ways import Progress, Ways
from fixture_design.tolerances import COPLANAR_ANGLE


def _of_role(problem: Problem, role: Role) -> Indices:
    elements = enumerate(problem.candidates.elements)
    return np.array([index for index, e in elements if e is not None and e.role == role], np.int64)


@dataclass(frozen=True, eq=False)
class Fewest:
    """The fewest changes there are in some ways out.

    Attributes:
        found: how many; inf without any.  bound: no layout takes fewer, if ``complete``.
        locators, clamps: of the layout they lead to.  pool: where its locators may be.
    """

    found: float
    bound: int
    complete: bool
    locators: Indices
    clamps: Indices
    pool: Indices


def fewest_over_ways(task: Task, ways: Ways, problem: Problem, seed: int, progress: Progress) -> Fewest:
    """The fewest changes. What a design from this start gives has only to be matched."""
    designed = _as_designed(task, ways, problem, seed, progress, slides=False)
    if problem.opens and designed.found > 1 and not problem.cancelled():
        sliding = _as_designed(task, ways, problem, seed, progress, slides=True)
        designed = sliding if sliding.found < designed.found else designed
    return _among_ways(problem, seed, progress, designed)


def _as_designed(task: Task, ways: Ways, problem: Problem, seed: int, progress: Progress, *, slides: bool) -> Fewest:
    """What the search for the best layout makes of this start, with all clamps that it had."""
    none = np.zeros(0, dtype=np.int64)
    new = problem.candidates.chosen(problem.new)
    start = begun(task, new, ways, keep_all=True, leaves=not slides, opens=True)
    as_begun = replace(
        problem,
        locators=start.locators,
        clamps=start.others,
        spare=start.spare,
        leaves=True,
        opens=True,
        slides=slides,
    )
    found = None if start.conflict or problem.never_stopped is not None else search(as_begun, seed, progress).found
    if found is None:
        return Fewest(np.inf, 0, True, none, none, none)
    locators, clamps = _of_role(problem, "locator"), _of_role(problem, "clamp")
    after = np.setdiff1d(np.union1d(found.clamps, clamps), np.array(problem.clamps, dtype=np.int64))
    moves = _changes(locators, found.locators) + _changes(clamps, after)
    pool = problem.new
    if found.out is not None:
        pool = pool[(problem.candidates.normals[pool, 0] @ found.out) < -COPLANAR_ANGLE]
    return Fewest(float(moves), 0, True, found.locators, after, pool)


def _changes(before: Indices, after: Indices) -> int:
    """Of one role: one that leaves and one that comes are one change."""
    return max(len(np.setdiff1d(before, after)), len(np.setdiff1d(after, before)))


def _among_ways(problem: Problem, seed: int, progress: Progress, best: Fewest) -> Fewest:
    """The fewest changes in any way out, or ``best`` if there are no fewer; the bound is of all these ways.

    The part may slide out along its locators; that some motion leaves all of them is asked for itself.
    """
    locators, clamps = _of_role(problem, "locator"), _of_role(problem, "clamp")
    fixed = np.array([i for i, e in enumerate(problem.candidates.elements) if e is not None and e.fixed], np.int64)
    ways, complete = ways_out(replace(problem, opens=False), seed)
    bound, complete = np.inf, complete and not problem.vague
    # where many locators have to leave there are many changes
    for number, (_, allowed) in enumerate(sorted(ways, key=lambda way: int((~way[1][locators]).sum()))):
        leaving = int((~allowed[locators]).sum())
        if not allowed[np.intersect1d(fixed, locators)].all():
            continue
        if leaving >= best.found:
            bound = min(bound, leaving)
            break
        progress(f"way out {number + 1} of {len(ways)}", number / len(ways))
        pool = problem.new[allowed[problem.new]]
        options = Options.of(problem, locators[allowed[locators]], clamps, fixed, pool)
        found = fewest_changes(problem, options, leaving, best.found, problem.cancelled)
        sure = found
        if problem.closes == "with friction":  # the true cones close with no more than the larger ones
            sure = fewest_changes(replace(problem, generous=True), options, leaving, best.found, problem.cancelled)
        bound, complete = min(bound, sure.bound), complete and sure.complete
        if found.locators is not None and found.clamps is not None:
            best = Fewest(float(found.bound), 0, True, found.locators, found.clamps, pool)
    least = int(min(bound, best.found)) if np.isfinite(min(bound, best.found)) else 0
    return replace(best, bound=least, complete=complete and not problem.cancelled())


def best_places(problem: Problem, locators: Indices, clamps: Indices, pool: Indices) -> tuple[Indices, Indices]:
    """What comes, moved to where it is best: locators as exact as they can be, clamps with the largest margin."""
    staying = locators[~np.isin(locators, problem.new)]
    if problem.each == 1 and len(locators) == problem.candidates.freedoms and problem.locates:
        moved = exchanged(problem.rows, pool, locators, staying, problem.features)
        everything = np.concatenate([moved, clamps])
        if problem.together(everything) and (problem.closes is None or closes(problem.closing_rows, everything)):
            locators = moved
    coming = clamps[np.isin(clamps, problem.new)]
    others = np.concatenate([locators, np.setdiff1d(clamps, coming), np.array(problem.clamps, dtype=np.int64)])
    if problem.closes is not None and len(coming):
        free = np.setdiff1d(problem.new, others)
        coming, _ = held_best(
            problem.closing_rows, others, coming, free, problem.candidates.places, standing=problem.standing
        )
    old = np.setdiff1d(clamps, problem.new)
    if problem.pushing is not None and len(coming):
        pressed = pressed_clamps(
            replace(problem, spare=tuple(old.tolist())), problem.pushing, locators, np.concatenate([old, coming])
        )
        if np.isfinite(pressed.total) and len(pressed.clamps) == len(clamps):
            coming = np.setdiff1d(pressed.clamps, old)
    return locators, np.concatenate([old, coming])


def more_exact(problem: Problem, locators: Indices, clamps: Indices, pool: Indices) -> Iterator[Indices]:
    """The locators after one exchange that makes them more exact, after two, and so on, as far as there are such."""
    if problem.each > 1 or len(locators) != problem.candidates.freedoms or problem.features is None:
        return
    elements = {int(index): problem.candidates.elements[index] for index in locators}
    fixed = np.array([i for i, element in elements.items() if element is not None and element.fixed], np.int64)
    others = np.concatenate([clamps, np.array(problem.clamps, dtype=np.int64)])
    before = locators
    for most in range(1, len(locators) - len(fixed) + 1):
        moved = moved_while_closed(problem, pool, locators, others, fixed, most)
        if np.array_equal(moved, before):
            return
        yield moved
        before = moved
