"""Confirms a verdict: every answer has the kind of evidence that proves it, and the evidence is a proof.

It starts again from points and normals, not from the arrays of the search, so that a mistake in those cannot hide, and
uses no solver. `proofs` has the arithmetic.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fixture_design.contacts import Contact
from fixture_design.layout import Answer, Finding, GroupVerdict, Motion, Singular, Verdict, Weights
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.proofs import Case, Pyramids, coverage_fault, motion_fault, rank_fault, weights_fault
from fixture_design.verification.rules import rule_fault


@dataclass(frozen=True)
class _Proof:
    """What proves an answer: a kind of evidence and how it is read."""

    kind: Literal["motion", "weights", "rank"]
    strict: bool = False
    closes: bool = False
    friction: bool = False
    full: bool = False


_PROOFS = {
    ("deterministic", Answer.YES): _Proof("rank", full=True),
    ("deterministic", Answer.NO): _Proof("rank"),
    ("accessible", Answer.YES): _Proof("motion"),
    ("accessible", Answer.NO): _Proof("weights", closes=True),
    ("strongly_accessible", Answer.YES): _Proof("motion", strict=True),
    ("strongly_accessible", Answer.NO): _Proof("weights"),
    ("form_closure", Answer.YES): _Proof("weights", closes=True),
    ("form_closure", Answer.NO): _Proof("motion"),
    ("force_closure", Answer.YES): _Proof("weights", closes=True, friction=True),
    ("force_closure", Answer.NO): _Proof("motion", friction=True),
}

#: Claims that contacts with clearance have no part in.
_WITH_CLEARANCE_OPEN = ("accessible", "strongly_accessible")


def check(verdict: Verdict) -> list[str]:
    """Everything that is wrong with a verdict; an empty list confirms it.

    Undecided answers claim nothing and need no proof.
    """
    contacts = {contact.name: contact for contact in verdict.contacts}
    problems = []
    for group in verdict.groups.values():
        missing = [name for name in group.contacts if name not in contacts]
        if missing:
            problems.append(f"{group.name}: the verdict has no contacts {', '.join(missing)}")
            continue
        chosen = [contacts[name] for name in group.contacts]
        problems += check_group(group, chosen)
    return problems + _requirement_faults(verdict)


def check_group(group: GroupVerdict, contacts: Sequence[Contact]) -> list[str]:
    """Problems of one group's findings; empty groups have none to have."""
    if not contacts:
        return [f"{group.name}: {c} is {f.answer} of no contacts" for c, f in group.findings.items() if f.answer]
    case = Case(contacts)
    problems = []
    for claim, finding in group.findings.items():
        problem = _fault(claim, finding, case.opened if claim in _WITH_CLEARANCE_OPEN else case)
        if problem:
            problems.append(f"{group.name}: {claim} {finding.answer}: {problem}")
    return problems


def _fault(claim: str, finding: Finding, case: Case) -> str | None:
    if finding.answer is None:
        return "there are contacts, so there must be an answer"
    if finding.answer is Answer.UNDECIDED:
        return None
    proof = _PROOFS.get((claim, finding.answer))
    if proof is None:
        return "no such question is known"
    return _proof_fault(proof, claim, finding, case) or _margin_fault(finding)


def _proof_fault(proof: _Proof, claim: str, finding: Finding, case: Case) -> str | None:
    evidence, pyramids = finding.evidence, None
    rule = evidence.rule if isinstance(evidence, Motion | Singular) else None
    if rule is not None and isinstance(evidence, Motion | Singular):
        fault = rule_fault(rule, claim, finding.answer, evidence.motion, case.contacts)
        if fault:
            return fault
    if rule is not None and rule.name == "common slip" and proof.kind in ("motion", "rank") and not proof.strict:
        return None
    if proof.kind == "motion" and isinstance(evidence, Motion):
        return motion_fault(evidence, case, strict=proof.strict, friction=proof.friction, nominal=rule is not None)
    if proof.kind == "rank" and isinstance(evidence, Singular):
        return rank_fault(evidence, case, full=proof.full, nominal=rule is not None)
    if proof.friction:
        pyramids = Pyramids(finding.edges or 0, finding.tangents or {})
    if proof.kind == "weights" and isinstance(evidence, tuple) and all(isinstance(w, Weights) for w in evidence):
        for weights in evidence:
            fault = weights_fault(weights, case, closes=proof.closes, pyramids=pyramids)
            if fault:
                return fault
        return coverage_fault([weights.choice for weights in evidence], case)
    return f"it needs a {proof.kind} as evidence"


def _margin_fault(finding: Finding) -> str | None:
    """A margin on the wrong side of a tie contradicts its answer."""
    if finding.margin is None:
        return None
    wrong = finding.margin < -DEFAULT.near if finding.answer is Answer.YES else finding.margin > DEFAULT.near
    return f"the margin {finding.margin:.1e} contradicts it" if wrong else None


def _requirement_faults(verdict: Verdict) -> list[str]:
    """Requirements must say what their group's finding says, and be summed up right."""
    problems = []
    for requirement in verdict.requirements:
        finding = verdict.groups[requirement.group].findings.get(requirement.require)
        if finding is not None and finding.answer is not requirement.answer:
            problems.append(f"{requirement.group}: {requirement.require} is {finding.answer}, not {requirement.answer}")
    answers = [requirement.answer for requirement in verdict.requirements]
    if verdict.satisfied is not sum_up(answers):
        problems.append(f"satisfied is {verdict.satisfied}, which the requirements do not say")
    return problems


def sum_up(answers: Sequence[Answer | None]) -> Answer | None:
    """Whether requirements hold together: no if one does not (or has no contacts), then undecided, then yes."""
    if not answers:
        return None
    if any(answer in (Answer.NO, None) for answer in answers):
        return Answer.NO
    return Answer.UNDECIDED if Answer.UNDECIDED in answers else Answer.YES
