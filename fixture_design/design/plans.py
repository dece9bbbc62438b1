"""What is asked for, in which order it is tried, and among which candidates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from fixture_design.design.candidates import Candidates
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.errors import GeometryError
from fixture_design.layout import Requirement
from fixture_design.tolerances import KNOWN_WELL, NORMALS_KNOWN_TO, PLANE_KNOWN_TO, USUAL_FRICTION

Require = Mapping[str, tuple[Requirement, ...]]

#: Requirements of locators that design meets by determining the part, and by a straight way out.
LOCATING: tuple[Requirement, ...] = ("deterministic", "strongly_accessible", "accessible", "accurate")
LEAVING: tuple[Requirement, ...] = ("loadable",)


@dataclass(frozen=True)
class Plan:
    """What is asked for, and why, if it is not what was asked for first."""

    require: Require
    friction: float
    reason: str | None = None


def plans(task: Task, ways: Ways) -> Iterator[Plan]:
    """What the task requires; for a bare part closure without friction, then with friction, where it may spin.

    Candidates that were chosen, and leave motions free that others would stop, are not made up for by friction.
    """
    if task.require is not None:
        yield Plan(task.require, task.friction)
        return
    leaving: tuple[Requirement, ...] = tuple(word for word in LEAVING if word in ways.answers)
    without: Require = {"locators": ("deterministic", "strongly_accessible", *leaving), "all": ("form_closure",)}
    yield Plan(without, task.friction)
    if task.candidates.chosen_by_hand:
        return
    reason = (
        "without friction no layout among these candidates closes the part; with friction one does, and the locators "
        "let it move freely"
    )
    rubbing: Require = {"locators": ("strongly_accessible", *leaving), "all": ("force_closure",)}
    yield Plan(
        rubbing,
        task.friction or USUAL_FRICTION,
        f"{reason} (coefficient {task.friction or USUAL_FRICTION:g})",
    )


def unused_friction(task: Task) -> tuple[str, ...]:
    """A note where friction is given, and the default requirements do without it."""
    if task.require is not None or not task.friction:
        return ()
    return (
        f"friction {task.friction:g} makes no difference to the default requirements, which close the part without it; "
        "`require: {locators: [deterministic, loadable], all: [force_closure]}` makes use of it",
    )


def by_certainty(candidates: Candidates, *, round_too: bool = False) -> Iterator[Candidates]:
    """Plane facets, as a file's digits leave them; where that only just fails, those that need no digits; then round
    surfaces too, the less well known they are the later, as far as that adds any.

    A group that cannot notice all that the next one can is left out: the end faces of a shaft are exact, and alone they
    are no place for its locators.

    Args:
        round_too: whether round surfaces that are known well count from the first.
    """
    errors = candidates.errors
    groups: list[Candidates] = []
    flat_first = () if round_too else (candidates.plane & (errors <= PLANE_KNOWN_TO), errors == 0)
    for some in (*flat_first, *(errors <= known for known in NORMALS_KNOWN_TO)):
        group = candidates.chosen(some)
        if len(group) and all(len(group) != len(other) for other in groups):
            groups.append(group)
    if not groups:
        raise GeometryError("no candidate has a normal that is known well enough", expected="facets that are flat")
    known = int((errors <= KNOWN_WELL).sum())
    most = max((one.freedoms for one in groups if len(one) <= known), default=groups[0].freedoms)
    yield from (one for one in groups if one.freedoms >= most)
