"""From chosen candidates to a layout: elements with names, the part, and what is required of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from fixture_design.arrays import Indices, read_only
from fixture_design.contacts import Role
from fixture_design.design.candidates import Candidates
from fixture_design.design.task import Task
from fixture_design.layout import Element, Layout, Requirement


def named(candidates: Candidates, locators: Indices, clamps: Indices, taken: Sequence[str]) -> dict[int, str]:
    """Names of elements by candidate: their own, or L1, L2, ... and K1, K2, ... where these are not taken."""
    names: dict[int, str] = {}
    for letter, chosen in (("L", locators), ("K", clamps)):
        fresh = fresh_names(letter, {*taken, *(e.name for e in candidates.elements if e is not None)})
        for index in chosen.tolist():
            element = candidates.elements[index]
            names[index] = next(fresh) if element is None else element.name
    return names


def fresh_names(letter: str, taken: set[str]) -> Iterator[str]:
    """L1, L2, ... without those that are taken."""
    number = 0
    while True:
        number += 1
        if f"{letter}{number}" not in taken:
            yield f"{letter}{number}"


def layout_of(
    task: Task,
    candidates: Candidates,
    locators: Indices,
    clamps: Indices,
    names: Mapping[int, str],
    require: Mapping[str, tuple[Requirement, ...]],
    friction: float,
) -> Layout:
    """The layout with the elements chosen, locators first; bodies and contacts of the start as they were."""
    roles: tuple[tuple[Role, Indices], ...] = (("locator", locators), ("clamp", clamps))
    elements = [
        new_element(candidates, index, role, names[index], task.candidates.tolerance)
        for role, chosen in roles
        for index in chosen.tolist()
    ]
    start = task.start
    given = {named.name for named in (*start.bodies, *start.contacts)} if start else set()
    return replace(
        empty_layout(task, require, friction),
        elements=tuple(element for element in elements if element.name not in given),
        bodies=start.bodies if start else (),
        contacts=start.contacts if start else (),
    )


def empty_layout(task: Task, require: Mapping[str, tuple[Requirement, ...]], friction: float) -> Layout:
    """The layout of a task without anything that touches the part."""
    return Layout(
        name=task.name,
        space=task.space,
        part=task.part,
        gravity=task.gravity,
        friction=friction,
        surface_gap=task.surface_gap,
        key_features=task.key_features,
        loads=task.loads,
        require=require,
        source=task.source,
    )


def new_element(candidates: Candidates, index: int, role: Role, name: str, tolerance: float | None = None) -> Element:
    """The element that a candidate is, or becomes; a new locator is placed to within ``tolerance`` [m]."""
    known = candidates.elements[index]
    if known is not None:
        return known
    make = candidates.makes[index]
    assert make is not None  # what is no element yet is made
    placed = tolerance if role == "locator" else None
    return Element(name, role, read_only(candidates.places[index]), make.tip, make.axis, placed)
