"""What clamps push with: what asks for it, and the preloads of the layout that was found."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, permutations

import numpy as np

from fixture_design.arrays import Indices, Mask, Weights
from fixture_design.design.candidates import Candidates
from fixture_design.design.drawing_up import empty_layout
from fixture_design.design.duties import Duties
from fixture_design.design.found import Found
from fixture_design.design.plans import Plan
from fixture_design.design.problem import Problem
from fixture_design.design.rubbing import rubs, seated
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Answer, Element, Layout, LoadsHeld, Verdict
from fixture_design.tolerances import LEAST_PUSH, MORE_PUSH, RESERVE

#: Requirements that are about forces.
_ABOUT_FORCES = {"holds_loads", "seated"}
#: The verdict's own program looks for preloads up to so many times what the search found and what acts on the part [-],
#: where there are no limits.
_GENEROUS = 10.0
#: Orders in which clamps may close that are looked at.
_MOST_ORDERS = 720
#: Orders that are verified one after the other.
_ORDERS_TRIED = 6


def duties_of(task: Task, plan: Plan, ways: Ways, candidates: Candidates) -> Duties | None:
    """What acts on the part, where requirements or the objective ask what clamps push with.

    Raises:
        UnsupportedError: the weight is asked for and not known.
    """
    asked = {word for words in plan.require.values() for word in words} & _ABOUT_FORCES
    if not asked and "preload" not in task.objective:
        return None
    wrenches = ways.wrenches(empty_layout(task, plan.require, plan.friction))
    if isinstance(wrenches, str):
        raise UnsupportedError(wrenches, source=task.source, expected="`mass` of the part, or no gravity")
    weight, loads = wrenches
    return Duties.of(
        weight, loads, candidates.scale, _limits(task, candidates, asked), _pushing(task, candidates),
        seated="seated" in asked, required=bool(asked),
    )  # fmt: skip


def _pushing(task: Task, candidates: Candidates) -> Mask:
    """Which candidates push with a preload: new ones, and elements of role clamp.

    Supports, fingers and bodies react, and so do contacts given as clamps: nobody says what they push with.
    """
    clamps = {e.name for e in task.start.elements if e.role == "clamp"} if task.start is not None else set()
    return np.array([element is None or element.name in clamps for element in candidates.elements], dtype=bool)


def _limits(task: Task, candidates: Candidates, asked: set[str]) -> tuple[Weights, Weights, Weights]:
    """Least and largest push of every candidate, of the task but for elements that have their own; and the least that
    these limits ask for.
    """
    low, high = task.limits.preload or (0.0, np.inf)
    lows, highs = np.full(len(candidates), low), np.full(len(candidates), high)
    limited = np.full(len(candidates), task.limits.preload is not None)
    for index, element in enumerate(candidates.elements):
        own = None if element is None else _own_limits(element)
        if own is not None:
            lows[index], highs[index], limited[index] = *own, True
    return np.where(limited | ("seated" not in asked), lows, LEAST_PUSH), highs, lows


def _own_limits(element: Element) -> tuple[float, float] | None:
    """What an element of the start may push with: within its limits, or else, and if it is fixed, with its preload."""
    if element.limits is not None and not (element.fixed and element.preload is not None):
        return element.limits
    return None if element.preload is None else (element.preload, element.preload)


def preloaded(
    ways: Ways, problem: Problem, found: Found, layout: Layout, names: Mapping[int, str]
) -> tuple[Layout, Verdict]:
    """The layout with the least preloads that verify, where preloads are asked for, and its verdict; with the last ones
    tried where none do.

    Args:
        names: of the layout's elements, by candidate.
    """
    if problem.duties is None or not problem.duties.pushes[found.clamps].any():
        return layout, ways.verify(layout)
    tried: tuple[Layout, Verdict] | None = None
    for preloads in _preloads(ways, problem, found, layout, names):
        pushing = _with(layout, preloads)
        verdict = ways.verify(pushing)
        tried = (pushing, verdict)
        if verdict.satisfied in (Answer.YES, None):
            break
    assert tried is not None
    return tried


def _preloads(
    ways: Ways, problem: Problem, found: Found, layout: Layout, by_candidate: Mapping[int, str]
) -> Iterator[Mapping[str, float]]:
    """Preloads to try, in the order of closing: those that hold the loads with a reserve, the least of the verdict's
    own program, and the search's with more and more to spare.
    """
    assert problem.pushing is not None
    duties = problem.pushing.duties
    pushing = duties.pushes[found.clamps]
    clamps = found.clamps[pushing]
    names = [by_candidate[index] for index in clamps.tolist()]
    least = problem.pushing.least(found.locators, found.clamps).each[pushing]
    limits = np.column_stack([duties.low[clamps], duties.high[clamps]])
    orders = _orders(problem, found.locators, clamps, least)

    def pushes(values: Weights, order: tuple[int, ...]) -> dict[str, float]:
        # 0.0 is added since -0.0 is none
        return {names[k]: float(np.clip(values[k], *limits[k])) + 0.0 for k in order}

    if rubs(problem):
        yield from _anyhow(problem, found, names)
    if any("holds_loads" in words for words in layout.require.values()):
        roomy = replace(problem.pushing, duties=duties.with_reserve(RESERVE)).least(found.locators, found.clamps)
        if np.isfinite(roomy.total):
            yield from (pushes(roomy.each[pushing], order) for order in orders)
        most = _GENEROUS * max(float(least.sum() + np.abs(duties.wrenches).max()), LEAST_PUSH)
        high = np.where(np.isfinite(limits[:, 1]), limits[:, 1], np.maximum(most, limits[:, 0]))
        some = {name: (float(low), float(top)) for name, low, top in zip(names, limits[:, 0], high, strict=True)}
        verdict = ways.verify(_with(layout, pushes(least, orders[0]), some))
        held = verdict.groups["all"].findings.get("holds_loads")
        if held is not None and isinstance(held.use, LoadsHeld) and held.use.least_preloads is not None:
            enough = np.array([held.use.least_preloads.get(name, 0.0) for name in names])
            yield from (pushes(enough, order) for order in orders)
    for more in (0.0, *MORE_PUSH):
        yield from (pushes(least * (1 + more), order) for order in orders)


def _anyhow(problem: Problem, found: Found, names: Sequence[str]) -> Iterator[dict[str, float]]:
    """Preloads that press every locator however friction rubs: with a reserve of what has to be held, or without."""
    assert problem.pushing is not None
    duties = problem.pushing.duties
    for program in (replace(problem.pushing, duties=duties.with_reserve(RESERVE)), problem.pushing):
        sits = seated(problem, found.locators, found.clamps, program)
        if sits is not None:
            clamps = found.clamps[duties.pushes[found.clamps]]
            for more in (0.0, *MORE_PUSH[:-2]):
                pushes = np.clip(sits.pushes * (1 + more), duties.low[clamps], duties.high[clamps])
                yield {names[k]: float(pushes[k]) + 0.0 for k in sits.order}


def _with(
    layout: Layout, preloads: Mapping[str, float], limits: Mapping[str, tuple[float, float]] | None = None
) -> Layout:
    """The layout whose clamps push with these preloads and close in this order."""
    known = {element.name: element for element in layout.elements}
    pushing = [
        replace(known[name], preload=force, limits=known[name].limits if limits is None else limits[name])
        for name, force in preloads.items()
    ]
    others = [element for element in layout.elements if element.name not in preloads]
    return replace(layout, elements=(*others, *pushing))


def _orders(problem: Problem, locators: Indices, clamps: Indices, pushes: Weights) -> list[tuple[int, ...]]:
    """Orders in which the clamps may close, first those in which the locators are pressed most at every step."""
    assert problem.pushing is not None
    duties, same = problem.pushing.duties, tuple(range(len(clamps)))
    rows = problem.pushing.smooth[locators].reshape(-1, problem.candidates.dimension)
    if not duties.pressed.any() or rows.shape[0] != rows.shape[1]:
        return [same]
    weight = np.linalg.lstsq(rows.T, duties.wrenches[0], rcond=None)[0]
    against = np.array([
        np.linalg.lstsq(rows.T, problem.pushing.smooth[clamp].sum(axis=0) * push, rcond=None)[0]
        for clamp, push in zip(clamps.tolist(), pushes.tolist(), strict=True)
    ])  # fmt: skip

    def least_pressed(order: tuple[int, ...]) -> float:
        return float((weight - np.cumsum(against[list(order)], axis=0)).min())

    orders = sorted(islice(permutations(same), _MOST_ORDERS), key=least_pressed, reverse=True)
    return orders[:_ORDERS_TRIED]


def found_preload(problem: Problem, layout: Layout) -> float | None:
    """What a layout's clamps push with in all [N]; None where nobody asks."""
    if problem.duties is None:
        return None
    return sum(((element.preload or 0.0) for element in layout.elements if element.role == "clamp"), start=0.0)
