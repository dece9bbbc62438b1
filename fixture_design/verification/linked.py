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
from itertools import islice, product
from math import prod

from fixture_design.analysis import Restraint
from fixture_design.arrays import Point
from fixture_design.contacts import Contact, Scale, matching
from fixture_design.layout import Answer, Finding, Singular
from fixture_design.tolerances import COPLANAR_ANGLE, Tolerances

Question = Callable[[Restraint], Finding]
Findings = Mapping[str, Finding]

#: Choices of one alternative a segment that are looked at; with more, what the outer set leaves open stays undecided.
MAX_CHOICES = 64

#: Questions where fewer motions make a yes: the outer set proves it, and a choice of the inner set disproves it.
_CLOSING = ("deterministic", "form_closure", "force_closure")

_WHY = "convex edges touch along parallel convex edges: {} if every point of these may take another face, else {}"


_DIFFER = "the two ends of a segment along which convex edges touch have different alternatives"

_MANY = f"convex edges touch along parallel convex edges: more than {MAX_CHOICES} choices, and the first settle nothing"


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
    segments = _segments(contacts)
    if segments is None:
        return _left_open(outer, list(open_ones))
    choices = _choices(segments)
    inner: dict[str, list[Finding]] = {name: [] for name in open_ones}
    for choice in choices:
        restraint = Restraint.of([_chosen(contact, choice) for contact in contacts], report, tolerances)
        for name, question in open_ones.items():
            inner[name].append(_with_choice(question(restraint), choice))
    many = prod(len(segment) for segment in segments) > MAX_CHOICES
    return dict(outer) | {name: _settled(name, outer[name], found, many) for name, found in inner.items()}


def _left_open(outer: Findings, names: Sequence[str]) -> dict[str, Finding]:
    """Undecided is what the outer set does not settle."""
    return dict(outer) | {
        name: replace(outer[name], answer=Answer.UNDECIDED, evidence=None, residual=None, reason=_DIFFER)
        for name in names
    }


def _stands(name: str, answer: Answer | None) -> bool:
    """Whether an answer about the outer set holds for every smaller set."""
    return answer is (Answer.YES if name in _CLOSING else Answer.NO)


def _settled(name: str, outer: Finding, inner: Sequence[Finding], many: bool) -> Finding:
    """The inner set's finding if it answers; else undecided."""
    wanted = Answer.NO if name in _CLOSING else Answer.YES
    for finding in inner:
        if finding.answer is wanted:
            return finding
    if outer.answer is Answer.UNDECIDED:
        return outer
    return replace(outer, answer=Answer.UNDECIDED, evidence=None, residual=None, reason=_MANY if many else _why(name))


def _why(name: str) -> str:
    return _WHY.format(*(("no", "yes") if name in _CLOSING else ("yes", "no")))


def _segments(contacts: Sequence[Contact]) -> list[list[dict[str, int]]] | None:
    """For each segment the choices of the same alternative at both ends; None if its ends have not the same ones."""
    by_name = {contact.name: contact for contact in contacts}
    segments: list[list[dict[str, int]]] = []
    for contact in contacts:
        other = by_name.get(contact.linked or "")
        if other is None or any(other.name in segment[0] for segment in segments):
            continue
        if len(contact.clauses) != 1 or len(other.clauses) != 1:
            return None
        (mine,), (theirs,) = contact.clauses, other.clauses
        if not matching(mine, theirs, COPLANAR_ANGLE):
            return None
        segments.append(
            [
                {contact.name: index, other.name: next(k for k, n in enumerate(theirs) if _same(n, normal))}
                for index, normal in enumerate(mine)
            ]
        )
    return segments


def _choices(segments: Sequence[list[dict[str, int]]]) -> list[dict[str, int]]:
    """For each linked contact the alternative taken; the first ones, if there are too many."""
    first = islice(product(*segments), MAX_CHOICES)
    return [{name: index for part in parts for name, index in part.items()} for parts in first]


def _same(first: Point, second: Point) -> bool:
    return matching((first,), (second,), COPLANAR_ANGLE)


def _chosen(contact: Contact, choice: Mapping[str, int]) -> Contact:
    if contact.name not in choice:
        return contact
    # no rule may count both ends as one facet: what a checker sees has alternatives
    return replace(contact, clauses=((contact.clauses[0][choice[contact.name]],),), feature=None)


def _with_choice(finding: Finding, choice: Mapping[str, int]) -> Finding:
    """Evidence in terms of the contacts as they stand: a rank is that of the alternatives taken."""
    if not isinstance(finding.evidence, Singular) or finding.evidence.motion is None:
        return finding
    taken = tuple((name, 0, index) for name, index in choice.items())
    choices = tuple((*of_branch, *taken) for of_branch in finding.evidence.choices or ((),))
    return replace(finding, evidence=replace(finding.evidence, choices=choices))
