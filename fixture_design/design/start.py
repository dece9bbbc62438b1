"""What a start layout brings: elements that stay, elements that may leave, and which of them have to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fixture_design.contacts import Contact
from fixture_design.design.candidates import Candidates
from fixture_design.design.removing import Cleared, cleared
from fixture_design.design.steps import Step
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.layout import Element, Layout, element_name


@dataclass(frozen=True, eq=False)
class Start:
    """The elements of a start layout among the candidates.

    Attributes:
        candidates: with the start's elements at the end.
        locators, others: indices of those that stay; ``others`` have another role.
        spare: indices of clamps that may leave.
        steps: what left.  conflict: elements that must stay and cannot together.
    """

    candidates: Candidates
    locators: tuple[int, ...] = ()
    others: tuple[int, ...] = ()
    spare: tuple[int, ...] = ()
    steps: tuple[Step, ...] = ()
    conflict: tuple[str, ...] = ()

    def name(self, index: int) -> str:
        element = self.candidates.elements[index]
        return str(index) if element is None else element.name


def begun(task: Task, candidates: Candidates, ways: Ways, keep_all: bool, *, leaves: bool, opens: bool) -> Start:
    """The start of a task, cleared of locators that bind.

    Args:
        keep_all: whether to keep what does no harm, or only what is ``fixed``.
        leaves: whether the part must come out of the locators in a straight line.  opens: whether some motion must
            leave all of them at once.
    """
    found = elements_of(task.start, ways) if task.start is not None else []
    everything = candidates.with_elements(found)
    first = len(candidates)
    numbers = {first + k: element for k, (element, _) in enumerate(found)}
    fixed = [index for index, element in numbers.items() if element.fixed]
    locators = [i for i, e in numbers.items() if e.role == "locator" and (keep_all or e.fixed)]
    start = Start(everything)
    out = task.limits.way_out
    kept: Cleared = cleared(everything, locators, fixed, start.name, leaves=leaves, opens=opens, out=out)
    let_go = [i for i, e in numbers.items() if e.role == "locator" and i not in locators]
    steps = (*(Step("removed", start.name(index), "spare") for index in let_go), *kept.steps)
    others = [i for i, e in numbers.items() if e.role != "locator" and (e.fixed or e.role != "clamp")]
    spare = [i for i, e in numbers.items() if e.role == "clamp" and not e.fixed]
    return Start(everything, kept.locators, tuple(others), tuple(spare), steps, kept.conflict)


def elements_of(layout: Layout, ways: Ways) -> list[tuple[Element, Sequence[Contact]]]:
    """Every element of a layout with its contacts; bodies and contacts given outright as elements that stay."""
    if not (layout.elements or layout.bodies or layout.contacts):
        return []
    contacts: dict[str, list[Contact]] = {}
    for contact in ways.contacts(layout):
        contacts.setdefault(element_name(contact.name), []).append(contact)
    known = {element.name: element for element in layout.elements}
    return [
        (known.get(name) or Element(name, own[0].role, own[0].point, fixed=True), own) for name, own in contacts.items()
    ]
