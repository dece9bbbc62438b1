"""What clamps push with: what asks for it, and the preloads of the layout that was found."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice, permutations

import numpy as np

from fixture_design.arrays import Vector, Weights
from fixture_design.design.candidates import Candidates
from fixture_design.design.drawing_up import empty_layout
from fixture_design.design.duties import Duties
from fixture_design.design.found import Found
from fixture_design.design.plans import Plan
from fixture_design.design.problem import Problem
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Answer, Element, Layout, LoadsHeld, Verdict

#: Requirements that are about forces.
_ABOUT_FORCES = {"holds_loads", "seated"}
#: Without limits a clamp may push with so many times what acts on the part [-].
_TIMES = 1e3
#: A clamp that is to press the part against its locators pushes with this at least, where nothing else asks for it [N].
_LEAST_PUSH = 1.0
#: More than the least, where the least is at the limit of what holds [-].
_MORE = (1e-3, 0.05, 0.3)
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
    limits = _limits(task, candidates, _TIMES * max(_size(weight + load) for load in [0 * weight, *loads]), asked)
    return Duties.of(weight, loads, candidates.scale, limits, seated="seated" in asked, required=bool(asked))


def _size(wrench: Vector) -> float:
    return float(np.linalg.norm(wrench))


def _limits(task: Task, candidates: Candidates, most: float, asked: set[str]) -> tuple[Weights, Weights]:
    """Least and largest push of every candidate: of the task, but for elements that have their own."""
    low, high = task.limits.preload or (_LEAST_PUSH if "seated" in asked else 0.0, max(most, _TIMES * _LEAST_PUSH))
    lows, highs = np.full(len(candidates), low), np.full(len(candidates), high)
    for index, element in enumerate(candidates.elements):
        own = None if element is None else _own_limits(element)
        if own is not None:
            lows[index], highs[index] = own
    return lows, highs


def _own_limits(element: Element) -> tuple[float, float] | None:
    """What an element of the start may push with: within its limits, or else with its preload."""
    if element.limits is not None:
        return element.limits
    return None if element.preload is None else (element.preload, element.preload)


def preloaded(ways: Ways, problem: Problem, found: Found, layout: Layout) -> tuple[Layout, Verdict]:
    """The layout with the least preloads that verify, where preloads are asked for, and its verdict; with the last ones
    tried where none do.
    """
    clamps = [element for element in layout.elements if element.role == "clamp"]
    if problem.pushing is None or not clamps:
        return layout, ways.verify(layout)
    tried: tuple[Layout, Verdict] | None = None
    for preloads in _preloads(ways, problem, found, layout, clamps):
        pushing = _with(layout, preloads)
        verdict = ways.verify(pushing)
        tried = (pushing, verdict)
        if verdict.satisfied in (Answer.YES, None):
            break
    assert tried is not None
    return tried


def _preloads(
    ways: Ways, problem: Problem, found: Found, layout: Layout, clamps: list[Element]
) -> Iterator[Mapping[str, float]]:
    """Preloads to try, in the order of closing: the least of the verdict's own program, then the search's, with more
    and more to spare.
    """
    assert problem.pushing is not None
    duties, names = problem.pushing.duties, [clamp.name for clamp in clamps]
    least = problem.pushing.least(found.locators, found.clamps).each
    limits = np.column_stack([duties.low[found.clamps], duties.high[found.clamps]])
    orders = _orders(problem, found, least)

    def pushes(values: Weights, order: tuple[int, ...]) -> dict[str, float]:
        return {names[k]: float(np.clip(values[k], *limits[k])) for k in order}

    if any("holds_loads" in words for words in layout.require.values()):
        some = {name: (float(low), float(high)) for name, (low, high) in zip(names, limits, strict=True)}
        verdict = ways.verify(_with(layout, pushes(least, orders[0]), some))
        held = verdict.groups["all"].findings.get("holds_loads")
        if held is not None and isinstance(held.use, LoadsHeld) and held.use.least_preloads is not None:
            enough = held.use.least_preloads
            yield from ({names[k]: enough.get(names[k], 0.0) for k in order} for order in orders)
    for more in (0.0, *_MORE):
        yield from (pushes(least * (1 + more), order) for order in orders)


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


def _orders(problem: Problem, found: Found, pushes: Weights) -> list[tuple[int, ...]]:
    """Orders in which the clamps may close, first those in which the locators are pressed most at every step."""
    assert problem.pushing is not None
    duties, same = problem.pushing.duties, tuple(range(len(found.clamps)))
    rows = problem.pushing.smooth[found.locators].reshape(-1, problem.candidates.dimension)
    if not duties.pressed.any() or rows.shape[0] != rows.shape[1]:
        return [same]
    weight = np.linalg.lstsq(rows.T, duties.wrenches[0], rcond=None)[0]
    against = np.array([
        np.linalg.lstsq(rows.T, problem.pushing.smooth[clamp].sum(axis=0) * push, rcond=None)[0]
        for clamp, push in zip(found.clamps.tolist(), pushes.tolist(), strict=True)
    ])  # fmt: skip

    def least_pressed(order: tuple[int, ...]) -> float:
        return float((weight - np.cumsum(against[list(order)], axis=0)).min())

    orders = sorted(islice(permutations(same), _MOST_ORDERS), key=least_pressed, reverse=True)
    return orders[:_ORDERS_TRIED]


def found_preload(problem: Problem, layout: Layout) -> float | None:
    """What a layout's clamps push with in all [N]; None where nobody asks."""
    if problem.duties is None:
        return None
    return sum((element.preload or 0.0) for element in layout.elements if element.role == "clamp")
