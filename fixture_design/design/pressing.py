"""Clamps placed so that they push as little as they can: column generation, then the best few of what it finds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations, islice

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.clamping import margins
from fixture_design.design.problem import Problem
from fixture_design.design.pushing import Program, Pushes
from fixture_design.tolerances import BETTER, DEFAULT, GOOD_MARGIN, LEAST_FRICTION

#: Rounds of column generation, and candidates that join in each.
_MOST_ROUNDS, _AT_ONCE = 40, 4
#: Sets of clamps that are compared, and swaps that are tried one after the other without gain.
_MOST_SETS, _MOST_SWAPS = 60, 12
#: Locators outside that are tried in an exchange.
_MOST_HELPFUL = 32
#: Clamps more than the fewest that close that are tried where these cannot hold the loads.
_MOST_MORE = 3


def least_of_all(problem: Problem, program: Program, locators: Indices, clamps: Indices) -> tuple[Indices, Pushes]:
    """Clamps that together push as little as any of the candidates could with these locators, and their pushes.

    Some of them push with nothing. All of them push with what the duties say at least: `least_here` is the bound.
    """
    chosen = np.array(clamps, dtype=np.int64)
    pool = np.setdiff1d(problem.clampable, locators)
    for _ in range(_MOST_ROUNDS):
        pushes = program.least(locators, chosen)
        best = _worth_it(program.worth(pushes.duals, pool), pool, pushes.price, chosen)
        if not len(best):
            return chosen, pushes
        chosen = np.concatenate([chosen, best])
    return chosen, program.least(locators, chosen)


def least_bound(problem: Problem, program: Program, pool: Indices) -> tuple[float | None, Indices]:
    """No locators of ``pool``, with clamps anywhere, need less preload in all [N], None where that is not known; and
    the locators that would react then, most first.
    """
    return _bounded(problem, program, np.array(problem.locators, dtype=np.int64), pool, problem.clampable)


def least_here(problem: Problem, program: Program, locators: Indices) -> float | None:
    """With these locators no clamps, of any number and anywhere, need less preload in all [N], None where that is not
    known.
    """
    clampable = np.setdiff1d(problem.clampable, locators)
    return _bounded(problem, program, locators, clampable[:0], clampable)[0]


def _bounded(
    problem: Problem, program: Program, locators: Indices, pool: Indices, clampable: Indices
) -> tuple[float | None, Indices]:
    """The least that any of these locators and clamps need, with those that stay; and the locators that react, most
    first. Only clamps that stay have to push, and no locator has to be pressed.
    """
    clamps = np.array(problem.clamps, dtype=np.int64)
    low = np.where(np.isin(np.arange(len(problem.candidates)), clamps), program.duties.floor, 0.0)
    program = replace(program, duties=replace(program.duties, low=low, pressed=program.duties.pressed & False))
    pool = np.setdiff1d(pool, locators)
    for _ in range(_MOST_ROUNDS):
        pushes = program.least(locators, clamps)
        more = _worth_it(program.use(pushes.duals, pool), pool, 0.0, locators)
        some = _worth_it(program.worth(pushes.duals, clampable), clampable, pushes.price, clamps)
        if not len(more) and not len(some):
            if np.isinf(pushes.total) and (pushes.barely or _rubs_too_little(problem)):
                break
            reacting = np.argsort(-pushes.reactions)[: int((pushes.reactions > 0).sum())]
            return pushes.total, locators[reacting]
        locators, clamps = np.concatenate([locators, more]), np.concatenate([clamps, some])
    return None, locators


def _rubs_too_little(problem: Problem) -> bool:
    """Whether some friction is there and too small for what is said about all pushes."""
    friction = problem.candidates.friction
    return bool(((friction > 0) & (friction < LEAST_FRICTION)).any())


def _worth_it(values: np.ndarray, pool: Indices, least: float, there: Indices) -> Indices:
    """The few best of a pool that are worth more than the least, and not there yet."""
    values, pool = values[~np.isin(pool, there)], pool[~np.isin(pool, there)]
    best = np.argsort(-values)[:_AT_ONCE]
    return pool[best[values[best] > least + DEFAULT.near]]


@dataclass(frozen=True, eq=False)
class Pressed:
    """Clamps, a lower bound of the margin of closure with them, and what they push with in all [N]."""

    clamps: Indices
    margin: float
    total: float
    holds: bool


def pressed_clamps(
    problem: Problem, program: Program, locators: Indices, clamps: Indices, most: int | None = None
) -> Pressed:
    """The clamps moved to where they push least, and more of them where they cannot hold what has to be held.

    They stay where they are if the margin of closure is to come first and they hold the loads.

    Args:
        most: clamps that there may be; None for some more, within the limits.
    """
    total = program.least(locators, clamps).total
    order = problem.objective
    margin_first = "margin" in order and ("preload" not in order or order.index("margin") < order.index("preload"))
    if not (margin_first and np.isfinite(total)):
        clamps, total = _least_of_as_many(problem, program, locators, clamps)
    limit = problem.limits.clamps
    allowed = len(clamps) + _MOST_MORE if limit is None else limit + problem.supporting
    most = allowed if most is None else min(most, allowed)
    while program.duties.required and not np.isfinite(total) and len(clamps) < most:
        found, pushes = least_of_all(problem, program, locators, clamps)
        more = [i for i in found[np.argsort(-pushes.each)].tolist() if _joins(problem, locators, clamps, i)]
        if not more:
            break
        clamps, total = _least_of_as_many(problem, program, locators, np.append(clamps, more[0]))
    holds = bool(np.isfinite(total)) or not program.duties.required
    return Pressed(clamps, _margin(problem, locators, clamps), total, holds)


def _joins(problem: Problem, locators: Indices, clamps: Indices, candidate: int) -> bool:
    others = np.concatenate([locators, clamps])
    return candidate not in others and bool(problem.joins(np.array([candidate]), others)[0])


def _margin(problem: Problem, locators: Indices, clamps: Indices) -> float:
    if problem.closes is None:
        return 0.0
    return float(margins(problem.closing_rows, np.concatenate([locators, clamps])[None])[0])


def _least_of_as_many(problem: Problem, program: Program, locators: Indices, clamps: Indices) -> tuple[Indices, float]:
    """As many clamps in the places where they push least and still close well, and what they push with in all [N]."""
    staying = clamps[np.isin(clamps, [*problem.clamps, *problem.spare])]
    moving = np.setdiff1d(clamps, staying)
    least_margin = min(_margin(problem, locators, clamps), GOOD_MARGIN) * (1 - BETTER)

    def fits(some: Indices) -> bool:
        for place in range(len(some)):
            others = np.concatenate([locators, staying, np.delete(some, place)]).astype(np.int64)
            if not problem.joins(some[[place]], others)[0]:
                return False
        return problem.closes is None or _margin(problem, locators, np.concatenate([staying, some])) >= least_margin

    best, total = np.array(clamps, dtype=np.int64), program.least(locators, clamps).total
    found, pushes = least_of_all(problem, program, locators, clamps)
    if not np.isfinite(pushes.total):
        return best, total
    useful = np.union1d(np.setdiff1d(found[pushes.each > 0], staying), moving)
    for some in islice(combinations(useful.tolist(), len(moving)), _MOST_SETS):
        if fits(np.array(some, dtype=np.int64)):
            least = program.total(locators, np.concatenate([staying, some]).astype(np.int64))
            if least < total * (1 - BETTER):
                best, total = np.concatenate([staying, some]).astype(np.int64), least
        if total <= pushes.total * (1 + BETTER):
            return best, total
    return _swapped(problem, program, locators, staying, best, total, fits)


def _swapped(
    problem: Problem,
    program: Program,
    locators: Indices,
    staying: Indices,
    best: Indices,
    total: float,
    fits: Callable[[Indices], bool],
) -> tuple[Indices, float]:
    """After swaps of one clamp for another one that the dual values recommend."""
    failures = 0
    while failures < _MOST_SWAPS and np.isfinite(total):
        before = total
        duals = program.least(locators, best).duals
        outside = np.setdiff1d(problem.clampable, np.concatenate([locators, best]))
        order = outside[np.argsort(-program.worth(duals, outside))[:_AT_ONCE]]
        for new in order.tolist():
            for old in np.setdiff1d(best, staying).tolist():
                failures += 1
                moved = np.append(best[best != old], new)
                if not fits(np.setdiff1d(moved, staying)):
                    continue
                least = program.total(locators, moved)
                if least < total * (1 - BETTER):
                    best, total, failures = moved, least, 0
                    break
            if total < before:
                break
        if total >= before:
            break
    return best, total


def pressed_together(
    problem: Problem, program: Program, pool: Indices, locators: Indices, pressed: Pressed
) -> tuple[Indices, Pressed]:
    """Locators exchanged too, one after the other, as long as the clamps can push less for it.

    A locator can only help if the dual values say that its reactions would (`Program.use`).
    """
    for _ in range(_MOST_ROUNDS):
        better = _exchanged_once(problem, program, pool, locators, pressed)
        if better is None or problem.cancelled():
            break
        locators = better
        pressed = pressed_clamps(problem, program, locators, pressed.clamps)
    return locators, pressed


def _exchanged_once(
    problem: Problem, program: Program, pool: Indices, locators: Indices, pressed: Pressed
) -> Indices | None:
    """The first exchange found that makes the clamps push less; None where there is none."""
    pushes = program.least(locators, pressed.clamps)
    outside = np.setdiff1d(pool, np.concatenate([locators, pressed.clamps]))
    use = program.use(pushes.duals, outside)
    helpful = outside[np.argsort(-use)][: min(_MOST_HELPFUL, int((use > DEFAULT.near).sum()))]
    movable = [place for place in range(len(locators)) if locators[place] not in problem.locators]
    least_margin = min(pressed.margin, GOOD_MARGIN) * (1 - BETTER)
    for new in helpful.tolist():
        for place in movable:
            moved = locators.copy()
            moved[place] = new
            others = np.concatenate([np.delete(locators, place), pressed.clamps])
            if not problem.joins(np.array([new]), others)[0] or not _locates(problem, moved):
                continue
            if problem.closes is not None and _margin(problem, moved, pressed.clamps) < least_margin:
                continue
            if _less(program, moved, pressed.clamps, pushes):
                return moved
    return None


def _less(program: Program, locators: Indices, clamps: Indices, than: Pushes) -> bool:
    if np.isfinite(than.total):
        return program.total(locators, clamps) < than.total * (1 - BETTER)
    return program.least(locators, clamps).less_than(than, BETTER)


def _locates(problem: Problem, locators: Indices) -> bool:
    """Whether they notice all that the candidates together can."""
    values = np.linalg.svd(problem.rows[problem.rows_of(locators)], compute_uv=False)
    freedoms = problem.candidates.freedoms
    return len(values) >= freedoms and bool(values[freedoms - 1] > problem.candidates.tolerances.near * values[0])
