"""Stages as a repair sees them: what is asked of locators and of all contacts, and where that is more than was asked.

A repair looks for locators and clamps, each as a whole. A stage may ask something of some of them only, by name. What
it asks of named locators is asked of these, and the other locators stay as they are and help to close (`aside`); of
several stages the sum is asked. Elements that a stage names may move but not leave, or the stage would name nobody.
What is found is verified with all its stages; that nothing else does has no proof then (`unlike_asked`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fixture_design.contacts import ROLES
from fixture_design.design.plans import LEAVING, LOCATING
from fixture_design.layout import Layout, Requirement, Stage, element_name


def words(layout: Layout) -> tuple[set[Requirement], set[Requirement]]:
    """What is required of locators alone, and of groups with other contacts."""
    of_locators, of_others = set(layout.require.get("locators", ())), set(layout.require.get("all", ()))
    for stage in layout.stages:
        (of_locators if _of_locators(layout, stage) else of_others).update(stage.require)
    return of_locators, of_others


def named_by_stages(layout: Layout) -> frozenset[str]:
    """Elements that some stage names."""
    return frozenset(element_name(active) for stage in layout.stages for active in stage.active if active not in ROLES)


def aside(layout: Layout) -> frozenset[str]:
    """Locators of which no group asks what locators do: the part need not be located by them, nor leave them."""
    asking = {"locators": layout.require.get("locators", ()), "all": layout.require.get("all", ())}
    if any(_asks_to_locate(require) for require in asking.values()):
        return frozenset()
    active = [name for stage in layout.stages if _asks_to_locate(stage.require) for name in stage.active]
    if not active or "locator" in active:
        return frozenset()
    meant = {element_name(name) for name in active}
    return frozenset(element.name for element in layout.elements if element.role == "locator") - meant


def as_seen(layout: Layout, left_aside: frozenset[str], staying: frozenset[str]) -> Layout:
    """The layout to start from: locators left aside are supports there, and what has to stay is fixed."""
    elements = (
        replace(
            element,
            role="support" if element.name in left_aside else element.role,
            fixed=element.fixed or element.name in staying,
        )
        for element in layout.elements
    )
    return replace(layout, elements=tuple(elements))


def unlike_asked(layout: Layout) -> str | None:
    """Where what is looked for is not quite what is asked, in words; None where it is."""
    return "; ".join(_unlike_asked(layout)) or None


def _unlike_asked(layout: Layout) -> Iterator[str]:
    roles = {"locator", "clamp", *(one.role for one in (*layout.elements, *layout.bodies, *layout.contacts))}
    for stage in layout.stages:
        active = set(stage.active)
        if active != {"locator"} and not roles <= active:
            yield f"stage {stage.name} is one of some contacts only ({', '.join(stage.active)})"
    of_locators, _ = words(layout)
    if of_locators & set(LOCATING) and not of_locators & {"deterministic", "accurate"}:
        yield "locators that determine the part were looked for, which is more than is asked"


def _of_locators(layout: Layout, stage: Stage) -> bool:
    """Whether a stage is one of locators alone."""
    everything = (*layout.elements, *layout.bodies, *layout.contacts)
    names = {"locator", *(element_name(one.name) for one in everything if one.role == "locator")}
    return {element_name(active) for active in stage.active} <= names


def _asks_to_locate(require: tuple[Requirement, ...]) -> bool:
    return bool(set(require) & {*LOCATING, *LEAVING})
