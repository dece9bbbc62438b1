"""Rules that make an answer certain whatever the normals are, confirmed by counting.

Each rule has a function that says what is wrong with it, for one claim; `analysis.counting` says why the rules hold. A
new rule is a new name in `RuleName` and a function here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Answer, Counted, Rule, RuleName
from fixture_design.tolerances import ROUND_OFF, WITNESS

#: Claims that mean "not closed", and how they are answered then.
_NOT_CLOSED = {("form_closure", Answer.NO), ("accessible", Answer.YES), ("force_closure", Answer.NO)}


def rule_fault(rule: Rule, claim: str, answer: Answer | None, contacts: Sequence[Contact]) -> str | None:
    """What is wrong with a rule as the reason of a claim's answer; None if nothing is."""
    check = _RULES.get(rule.name)
    if check is None:
        return f"no rule is called {rule.name!r}"
    if claim == "force_closure" and any(contact.friction > 0 for contact in contacts):
        return "counting normals says nothing of contacts with friction"
    return check(rule, (claim, answer), contacts)


def _few_rows(rule: Rule, claimed: tuple[str, Answer | None], contacts: Sequence[Contact]) -> str | None:
    dimension = contacts[0].dimension
    if claimed == ("deterministic", Answer.NO):
        most = dimension - 1
    elif claimed in _NOT_CLOSED:
        most = dimension
    else:
        return "few rows do not tell that"
    return _count_fault(rule, most, contacts, _rows_at_most)


def _few_normals(rule: Rule, claimed: tuple[str, Answer | None], contacts: Sequence[Contact]) -> str | None:
    if claimed not in _NOT_CLOSED:
        return "few normals do not tell that"
    return _count_fault(rule, len(contacts[0].point), contacts, lambda block: len(block[0].clauses))


_RULES: dict[RuleName, Callable[[Rule, tuple[str, Answer | None], Sequence[Contact]], str | None]] = {
    "few rows": _few_rows,
    "few normals": _few_normals,
}


def _count_fault(
    rule: Rule, most: int, contacts: Sequence[Contact], least: Callable[[Sequence[Contact]], int]
) -> str | None:
    """Every contact is counted once, contacts counted together share a facet, no count is too low, and the sum fits."""
    named = [name for block in rule.counted for name in block.contacts]
    if sorted(named) != sorted(contact.name for contact in contacts):
        return "the rule does not count each contact once"
    by_name = {contact.name: contact for contact in contacts}
    for counted in rule.counted:
        fault = _block_fault(counted, [by_name[name] for name in counted.contacts], least)
        if fault:
            return fault
    total = sum(block.count for block in rule.counted)
    return None if total <= most else f"the rule counts {total}, more than {most}"


def _block_fault(counted: Counted, block: Sequence[Contact], least: Callable[[Sequence[Contact]], int]) -> str | None:
    if not block:
        return "the rule counts no contacts together"
    first = block[0]
    for other in block[1:]:
        plane = all(c.provenance.kind == "exact" and len(c.normals) == 1 for c in (first, other))
        turned = float(np.linalg.norm(unit_normal(first.normals[0]) - unit_normal(other.normals[0])))
        if not plane or first.feature is None or first.feature != other.feature or turned > WITNESS:
            return f"{first.name} and {other.name} are not on one plane facet"
    needed = least(block)
    return None if counted.count >= needed else f"{', '.join(counted.contacts)} count {needed}, not {counted.count}"


def _rows_at_most(block: Sequence[Contact]) -> int:
    """Dimension of the rows: one a clause of a single contact; of a facet, 1 + that of the points' affine hull."""
    if len(block) == 1:
        return len(block[0].clauses)
    points = np.array([contact.point for contact in block])
    sizes = np.linalg.svd(points - points[0], compute_uv=False)
    limit = WITNESS * float(sizes[0]) + 100 * ROUND_OFF * float(np.abs(points).max())
    return 1 + min(int(np.sum(sizes > limit)), points.shape[1] - 1)
