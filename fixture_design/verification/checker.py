"""Confirms a verdict: every answer has the kind of evidence that proves it, and the evidence is a proof.

It starts again from points and normals, not from the arrays of the search, so that a mistake in those cannot hide, and
uses no solver. `proofs` has the arithmetic.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fixture_design.contacts import Contact, Scale
from fixture_design.layout import Answer, Finding, GroupVerdict, Layout, Motion, Singular, Verdict, Weights
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.given import given_faults
from fixture_design.verification.proofs import Case, Pyramids, coverage_fault, motion_fault, rank_fault, weights_fault
from fixture_design.verification.residuals import residual_fault
from fixture_design.verification.rules import SLIP_RULES, rule_fault
from fixture_design.verification.use_proofs import USE_PROOFS


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

#: Every group must have a finding for each of these.
CLAIMS = tuple(dict.fromkeys(claim for claim, _ in _PROOFS))

#: Claims that contacts with clearance have no part in.
_WITH_CLEARANCE_OPEN = ("accessible", "strongly_accessible")


def check(verdict: Verdict, layout: Layout | None = None) -> list[str]:
    """Everything that is wrong with a verdict; an empty list confirms it.

    Undecided answers claim nothing and need no proof.

    Args:
        layout: what the verdict is about: its weight, loads, preloads and features must be those of the evidence. The
            contacts are taken as the verdict has them.
    """
    contacts = {contact.name: contact for contact in verdict.contacts}
    problems = _repeated("the verdict", [contact.name for contact in verdict.contacts])
    report = Scale(verdict.reference, verdict.length)
    if not (np.isfinite(report.reference).all() and np.isfinite(report.length) and report.length > 0):
        return [*problems, f"the scale has reference {report.reference.tolist()} and length {report.length}"]
    if "all" not in verdict.groups:
        problems.append("the verdict has no group 'all'")
    for name, group in verdict.groups.items():
        faults = _member_faults(name, group, contacts)
        problems += faults or check_group(group, [contacts[member] for member in group.contacts], report)
        problems += [f"{name}: there is no finding for {claim}" for claim in CLAIMS if claim not in group.findings]
    return problems + _requirement_faults(verdict) + ([] if layout is None else given_faults(verdict, layout))


def _member_faults(name: str, group: GroupVerdict, contacts: Mapping[str, Contact]) -> list[str]:
    """Members are known contacts, each once: every contact in `all`, those of role locator in `locators`."""
    if group.name != name:
        return [f"{name}: the group is called {group.name!r}"]
    missing = [member for member in group.contacts if member not in contacts]
    if missing:
        return [f"{name}: the verdict has no contacts {', '.join(missing)}"]
    members = {
        "all": set(contacts),
        "locators": {contact.name for contact in contacts.values() if contact.role == "locator"},
    }.get(name, set(group.contacts))
    wrong = sorted(members ^ set(group.contacts))
    if wrong:
        return [f"{name}: the group has too many or too few contacts: {', '.join(wrong)}"]
    return _repeated(name, group.contacts)


def _repeated(place: str, names: Sequence[str]) -> list[str]:
    twice = [name for name, count in Counter(names).items() if count > 1]
    return [f"{place}: there are several contacts called {', '.join(twice)}"] if twice else []


def check_group(group: GroupVerdict, contacts: Sequence[Contact], report: Scale | None = None) -> list[str]:
    """Problems of one group's findings; empty groups have no answers to have.

    ``report``: the scale of stated residuals; without it they are not computed again.
    """
    if not contacts:
        answered = [(claim, finding.answer) for claim, finding in group.findings.items() if finding.answer]
        return [f"{group.name}: {claim} is {answer} of no contacts" for claim, answer in answered]
    case = Case(contacts, contacts[0].dimension)
    problems = []
    for claim, finding in group.findings.items():
        problem = _fault(claim, finding, case.opened if claim in _WITH_CLEARANCE_OPEN else case, report)
        if problem:
            problems.append(f"{group.name}: {claim} {finding.answer}: {problem}")
    return problems


def _fault(claim: str, finding: Finding, case: Case, report: Scale | None) -> str | None:
    if finding.answer is None:
        return "there are contacts, so there must be an answer"
    if finding.margin is not None and not np.isfinite(finding.margin):
        return f"the margin {finding.margin} is no finite number"
    if finding.answer is Answer.UNDECIDED:
        return None
    if claim in USE_PROOFS:
        return USE_PROOFS[claim](finding, case.contacts)
    proof = _PROOFS.get((claim, finding.answer))
    if proof is None:
        return "no such question is known"
    pyramids = Pyramids(finding.edges or 0, finding.tangents or {}) if proof.friction else None
    fault = _proof_fault(proof, claim, finding, case, pyramids) or _margin_fault(finding)
    if fault or report is None:
        return fault
    return residual_fault(finding, replace(case, given=report), pyramids)


def _proof_fault(proof: _Proof, claim: str, finding: Finding, case: Case, pyramids: Pyramids | None) -> str | None:
    evidence = finding.evidence
    rule = evidence.rule if isinstance(evidence, Motion | Singular) else None
    if rule is not None and isinstance(evidence, Motion | Singular):
        fault = rule_fault(rule, claim, finding.answer, evidence.motion, case.contacts)
        if fault:
            return fault
    if rule is not None and rule.name in SLIP_RULES and proof.kind in ("motion", "rank") and not proof.strict:
        return None
    if proof.kind == "motion" and isinstance(evidence, Motion):
        return motion_fault(evidence, case, strict=proof.strict, friction=proof.friction, nominal=rule is not None)
    if proof.kind == "rank" and isinstance(evidence, Singular):
        return rank_fault(evidence, case, full=proof.full, nominal=rule is not None)
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
        group = verdict.groups.get(requirement.group)
        if group is None:
            problems.append(f"{requirement.require} is required of {requirement.group!r}, and there is no such group")
            continue
        finding = group.findings.get(requirement.require)
        unanswered = Answer.UNDECIDED if group.contacts else None
        answer = unanswered if finding is None else finding.answer
        if requirement.answer is not answer:
            problems.append(f"{requirement.group}: {requirement.require} is {answer}, not {requirement.answer}")
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
