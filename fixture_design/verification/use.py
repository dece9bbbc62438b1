"""What the fixture does to the part: the questions that are asked of a group only where its requirements ask them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from fixture_design.analysis import accurate
from fixture_design.arrays import Vector
from fixture_design.layout import Answer, Finding, Group, GroupVerdict, Layout
from fixture_design.tolerances import Tolerances
from fixture_design.verification.accuracy_proofs import accuracy_fault
from fixture_design.verification.force_questions import holds_loads, seated
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.loading import loadable
from fixture_design.verification.weight import weight_of

UseQuestion = Callable[[Layout, Group, FoundContacts, Tolerances], Finding]


def _accurate(layout: Layout, group: Group, found: FoundContacts, tolerances: Tolerances) -> Finding:
    def weight(of: Layout) -> Vector | None:
        known = weight_of(of, found.geometry)
        return None if isinstance(known, str) else known.wrench

    finding = accurate(layout, group, found.report.reference, tolerances, weight)
    # errors of normals and alternatives together may blur a displacement that is found; what does not check is not said
    if finding.answer is not Answer.UNDECIDED and (fault := accuracy_fault(finding, group.contacts)):
        return replace(finding, answer=Answer.UNDECIDED, reason=f"the errors found are not confirmed: {fault}")
    return finding


#: In the order they are reported.
USE_QUESTIONS: dict[str, UseQuestion] = {
    "loadable": loadable,
    "accurate": _accurate,
    "seated": seated,
    "holds_loads": holds_loads,
}


def with_use(
    verdict: GroupVerdict, layout: Layout, group: Group, found: FoundContacts, tolerances: Tolerances
) -> GroupVerdict:
    """The verdict of a group with those findings that its requirements ask for; of an empty group, no answer."""
    findings = dict(verdict.findings)
    for name, question in USE_QUESTIONS.items():
        if name in group.require:
            findings[name] = question(layout, group, found, tolerances) if group.contacts else Finding(None)
    return replace(verdict, findings=findings)
