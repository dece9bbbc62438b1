"""A changed layout: what stays, what moves under its old name, what comes and leaves; and a step for each change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.contacts import Role
from fixture_design.design.candidates import flat
from fixture_design.design.drawing_up import fresh_names, new_element
from fixture_design.design.hitting import free_motion
from fixture_design.design.problem import Problem
from fixture_design.design.removing import balance_of
from fixture_design.design.staged import named_by_stages
from fixture_design.design.steps import Step, in_world, stopped, unnoticed
from fixture_design.layout import Element, Layout, PointTip, SoftTip, SphereTip

#: Tips that can be anywhere; where another one leaves a new element's comes.
_ANYWHERE = (PointTip, SphereTip, SoftTip)


def index_of(problem: Problem, element: Element, clamps: Indices) -> int:
    """The candidate that a clamp of the changed layout is."""
    for index in clamps.tolist():
        known = problem.candidates.elements[index]
        if (known is not None and known.name == element.name) or (
            known is None and np.array_equal(problem.candidates.places[index], element.at)
        ):
            return int(index)
    raise AssertionError(element.name)


def changed(asked: Layout, problem: Problem, locators: Indices, clamps: Indices) -> tuple[Layout, list[Step]]:
    """The layout with what stays, what moved under its old name, what came; and a step for each change."""
    known = problem.candidates.elements
    after = {known[i].name for i in [*locators.tolist(), *clamps.tolist(), *problem.clamps] if known[i] is not None}  # type: ignore[union-attr]
    steps: list[Step] = []
    elements = {e.name: e for e in asked.elements}
    names = {index: element.name for index, element in enumerate(known) if element is not None}
    taken = {*elements, *(named.name for named in (*asked.bodies, *asked.contacts))}
    roles: tuple[tuple[Role, str, Indices], ...] = (("locator", "L", locators), ("clamp", "K", clamps))
    for role, letter, chosen in roles:
        leaving = [e for e in asked.elements if e.role == role and e.name not in after]
        coming = [int(i) for i in chosen if known[int(i)] is None]
        pairs = _nearest_pairs(problem, leaving, coming, named_by_stages(asked))
        fresh = fresh_names(letter, taken)
        for index in coming:
            old = pairs.get(index)
            element = _placed(problem, index, old, role, next(fresh) if old is None else old.name)
            elements[element.name], names[index] = element, element.name
            steps.append(_step(problem, "added" if old is None else "moved", element.name, index, locators, clamps))
        for element in leaving:
            if element not in pairs.values():
                del elements[element.name]
                steps.append(_left(problem, element, locators, names))
    return replace(asked, elements=tuple(elements.values())), steps


def _nearest_pairs(
    problem: Problem, leaving: Sequence[Element], coming: Sequence[int], first: frozenset[str]
) -> dict[int, Element]:
    """Which of those that come takes the place of which that leaves: first of some names, then short ways."""
    away = sorted(
        (element.name not in first, float(np.linalg.norm(problem.candidates.places[index] - element.at)), number, index)
        for number, element in enumerate(leaving)
        for index in coming
    )
    pairs: dict[int, Element] = {}
    for _, _, number, index in away:
        if index not in pairs and leaving[number] not in pairs.values():
            pairs[index] = leaving[number]
    return pairs


def _placed(problem: Problem, index: int, old: Element | None, role: Role, name: str) -> Element:
    """The element that a candidate becomes; one that moves keeps its tip if that can be anywhere."""
    new = new_element(problem.candidates, index, role, name)
    if old is None:
        return new
    return replace(old, at=new.at, tip=old.tip if isinstance(old.tip, _ANYWHERE) else new.tip, axis=new.axis)


def _step(
    problem: Problem, action: Literal["added", "moved"], name: str, index: int, locators: Indices, clamps: Indices
) -> Step:
    """What the others leave free, that this one stops; or do not notice, that it notices."""
    others = [int(i) for i in (*locators, *clamps, *problem.clamps) if int(i) != index]
    motion = stopped(problem, others, index) if problem.closes is not None else None
    why: Literal["free", "unnoticed"] = "free"
    if motion is None:
        why, motion = "unnoticed", unnoticed(problem, [int(i) for i in locators if int(i) != index], index)
    world = None if motion is None else in_world(motion, problem.candidates.scale)
    return Step(action, name, why, world)


def _left(problem: Problem, element: Element, locators: Indices, names: dict[int, str]) -> Step:
    """What a locator did among those that are there now: it bound them, or let no way out straight; or nothing."""
    known = problem.candidates.elements
    index = next(i for i, other in enumerate(known) if other is not None and other.name == element.name)
    with_it = np.append(locators, index)
    if element.role == "locator" and problem.opens:
        _, owner, balanced = balance_of(problem.candidates.rows, with_it)
        bound = with_it[np.unique(owner[balanced])].tolist()
        if index in bound:
            return Step("removed", element.name, "bound", circuit=tuple(names[one] for one in bound))
    if element.role == "locator" and problem.leaves and free_motion(flat(problem.candidates.normals, with_it)) is None:
        return Step("removed", element.name, "in the way")
    return Step("removed", element.name, "spare")


def raised(before: Layout, after: Layout) -> Iterator[Step]:
    """A step for each clamp that stays where it was and has another preload; one that comes or moves brings its own."""
    old = {element.name: element for element in before.elements}
    for element in after.elements:
        was = old.get(element.name)
        if was is None or element.role != "clamp" or not np.array_equal(was.at, element.at):
            continue
        if element.preload != was.preload:
            yield Step("preloaded", element.name, "loads", preload=element.preload)
