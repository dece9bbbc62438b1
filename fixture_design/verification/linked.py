"""Convex edges that touch along parallel convex edges: bracketed from inside and outside.

Along such a segment the part stays out if at every point one of the two faces is not entered, and which one may differ
from point to point. That is no AND of ORs of the end points. Two sets of motions enclose the true one:

    outer   at each end any alternative               the contacts as they stand
    inner   the same alternative at both ends         then also at every point between, by linearity

What closes the outer set closes the true one, and a motion of the inner set belongs to it. Where neither settles a
question, it is undecided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product

from fixture_design.analysis import Restraint
from fixture_design.arrays import Point
from fixture_design.contacts import Contact, Scale
from fixture_design.contacts.polyhedral import matching
from fixture_design.layout import Answer, Finding, Singular
from fixture_design.tolerances import COPLANAR_ANGLE, Tolerances

Question = Callable[[Restraint], Finding]
Findings = Mapping[str, Finding]

#: Choices of one alternative a segment that are looked at; with more, what the outer set leaves open stays undecided.
MAX_CHOICES = 64

#: Questions where fewer motions make a yes: the outer set proves it, and a choice of the inner set disproves it.
_CLOSING = ("deterministic", "form_closure", "force_closure")

_WHY = "convex edges touch along parallel convex edges: {} if every point of these may take another face, else {}"


def bracketed(
    outer: Findings,
    contacts: Sequence[Contact],
    report: Scale,
    tolerances: Tolerances,
    questions: Mapping[str, Question],
) -> dict[str, Finding]:
    """Findings about contacts of which some are linked: those of the outer set where these stand for the true set.

    Args:
        outer: the findings about the contacts as they stand.
        contacts: the group's, in order.  report, tolerances, questions: as for ``outer``.
    """
    open_ones = {name: questions[name] for name, finding in outer.items() if not _stands(name, finding.answer)}
    if not open_ones:
        return dict(outer)
    choices = _choices(contacts)
    inner: dict[str, list[Finding]] = {name: [] for name in open_ones}
    for choice in choices:
        restraint = Restraint.of([_chosen(contact, choice) for contact in contacts], report, tolerances)
        for name, question in open_ones.items():
            inner[name].append(_with_choice(question(restraint), choice))
    return dict(outer) | {name: _settled(name, outer[name], found) for name, found in inner.items()}


def _stands(name: str, answer: Answer | None) -> bool:
    """Whether an answer about the outer set holds for every smaller set."""
    return answer is (Answer.YES if name in _CLOSING else Answer.NO)


def _settled(name: str, outer: Finding, inner: Sequence[Finding]) -> Finding:
    """The inner set's finding if it answers; else undecided."""
    wanted = Answer.NO if name in _CLOSING else Answer.YES
    for finding in inner:
        if finding.answer is wanted:
            return finding
    if outer.answer is Answer.UNDECIDED:
        return outer
    return replace(outer, answer=Answer.UNDECIDED, evidence=None, residual=None, reason=_why(name))


def _why(name: str) -> str:
    return _WHY.format(*(("no", "yes") if name in _CLOSING else ("yes", "no")))


def _choices(contacts: Sequence[Contact]) -> list[dict[str, int]]:
    """For each linked contact the alternative taken, the same at both ends of a segment; none if there are too many."""
    by_name = {contact.name: contact for contact in contacts}
    segments: list[list[dict[str, int]]] = []
    count = 1
    for contact in contacts:
        other = by_name.get(contact.linked or "")
        if other is None or other.name in {name for segment in segments for name in segment[0]}:
            continue
        (mine,), (theirs,) = contact.clauses, other.clauses
        segments.append(
            [
                {contact.name: index, other.name: next(k for k, n in enumerate(theirs) if _same(n, normal))}
                for index, normal in enumerate(mine)
            ]
        )
        count *= len(mine)
        if count > MAX_CHOICES:
            return []
    return [{name: index for part in parts for name, index in part.items()} for parts in product(*segments)]


def _same(first: Point, second: Point) -> bool:
    return matching((first,), (second,), COPLANAR_ANGLE)


def _chosen(contact: Contact, choice: Mapping[str, int]) -> Contact:
    if contact.name not in choice:
        return contact
    return replace(contact, clauses=((contact.clauses[0][choice[contact.name]],),))


def _with_choice(finding: Finding, choice: Mapping[str, int]) -> Finding:
    """Evidence in terms of the contacts as they stand: a rank is that of the alternatives taken."""
    if not isinstance(finding.evidence, Singular) or finding.evidence.motion is None:
        return finding
    taken = tuple((name, 0, index) for name, index in choice.items())
    choices = tuple((*of_branch, *taken) for of_branch in finding.evidence.choices or ((),))
    return replace(finding, evidence=replace(finding.evidence, choices=choices))
