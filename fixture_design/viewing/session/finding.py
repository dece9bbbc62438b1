"""What a session says of what was found for it: an element more, or the fewest changes."""

from __future__ import annotations

from fixture_design.contacts import Scale
from fixture_design.design import DesignResult
from fixture_design.design.next_element import NextElement
from fixture_design.layout import Answer
from fixture_design.viewing.motion_words import motion_in_words


def addition_in_words(best: NextElement, report: Scale) -> str:
    """ "L3 on facet 4: unnoticed before it: ..."; why an element stands where it was put."""
    if best.motion is None:
        return f"{best.name} on {best.feature}: the margin is largest there"
    return f"{best.name} on {best.feature}: {best.why} before it: " + motion_in_words(
        best.motion, report.reference, report.length
    )


def changes_in_words(found: DesignResult) -> str:
    """ "2 changes: K1 added, L3 moved"; what is in doubt about them."""
    count = len(found.steps)
    names = ", ".join(f"{step.element} {step.action}" for step in found.steps)
    doubt = f"; {found.reason}" if found.reason else ""
    return f"{count} {'change' if count == 1 else 'changes'}: {names}{doubt}"


def no_changes_in_words(found: DesignResult) -> str:
    held = "all that is required holds already" if found.satisfied is Answer.YES else None
    return found.reason or held or "no changes were found"
