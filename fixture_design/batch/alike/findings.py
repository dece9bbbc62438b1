"""Findings with marks in the place of numbers, one set for each combination of answers."""

from __future__ import annotations

import numpy as np

from fixture_design.batch.alike.decide import NO, NONE, YES
from fixture_design.batch.alike.plan import QUESTIONS, GroupPlan, Plan
from fixture_design.batch.alike.text import Marks, answer_of, as_json
from fixture_design.layout import Finding, Motion, Singular, Weights

#: The value that is a question's margin.
MARGINS = {
    "deterministic": "located margin",
    "accessible": "minus s",
    "strongly_accessible": "minus s",
    "form_closure": "s",
    "force_closure": "s",
}


def brief_findings(answers: list[int]) -> dict[str, Finding]:
    """The answers alone."""
    said = zip(QUESTIONS, answers, strict=True)
    return {question: Finding(None if answer == NONE else answer_of(answer)) for question, answer in said}


def full_findings(plan: Plan, index: int, answers: list[int], rank: int, mark: Marks) -> dict[str, Finding]:
    """The answers about group ``index`` with marks for their evidence, as `analysis` would have it; see `evidence`."""
    group = plan.plans[index]
    if not len(group.contacts):
        return brief_findings(answers)
    located, accessible, strongly, closed, held = answers
    dimension = plan.dimension

    def one(name: str) -> float:
        return mark(f"{index} {name}", 1)[0]

    def several(name: str, count: int) -> np.ndarray:
        return np.array(mark(f"{index} {name}", count))

    def moves(answer: int, margin: str) -> Finding:
        residual = one("motion residual")
        return Finding(answer_of(answer), one(margin), Motion(several("motion", dimension), residual), residual)

    def balances(answer: int, margin: str, *, full_rank: bool) -> Finding:
        residual = one("weights residual")
        basis = ((mark.word(f"{index} basis"), 0),) if full_rank else ()
        weights = Weights(_weights(plan, group, f"{index} weights", mark), basis, (), residual)
        return Finding(answer_of(answer), one(margin), (weights,), residual)

    if located == YES:
        first = Finding(answer_of(YES), one("located margin"), Singular(dimension, None, ((),), 0.0), 0.0)
    else:
        residual = one("unnoticed residual")
        evidence = Singular(rank, several("unnoticed", dimension), ((),), residual)
        first = Finding(answer_of(NO), one("located margin"), evidence, residual)
    return {
        "deterministic": first,
        "accessible": moves(YES, "minus s") if accessible == YES else balances(NO, "minus s", full_rank=True),
        "strongly_accessible": moves(YES, "minus s") if strongly == YES else balances(NO, "minus s", full_rank=False),
        "form_closure": balances(YES, "s", full_rank=True) if closed == YES else moves(NO, "s"),
        "force_closure": balances(YES, "s", full_rank=True) if held == YES else moves(NO, "s"),
    }


def _weights(plan: Plan, group: GroupPlan, name: str, mark: Marks) -> dict[str, tuple[float, ...]]:
    """For each contact its rows' weights."""
    owners = group.owners[0]
    marks = mark(name, len(owners))
    names = [plan.layout.contacts[owner].name for owner in group.contacts]
    return {
        contact: tuple(marks[row] for row in np.flatnonzero(owners == owner))
        for contact, owner in zip(names, group.contacts, strict=True)
    }


def basis_texts(plan: Plan, group: GroupPlan) -> list[str]:
    """For each row of a group its place in a basis, as JSON: '["L1", 0]'."""
    owners = group.owners[0]
    first = np.searchsorted(owners, owners)
    names = [plan.layout.contacts[owner].name for owner in owners]
    return [f"[{as_json(name)}, {row - start}]" for row, (name, start) in enumerate(zip(names, first, strict=True))]
