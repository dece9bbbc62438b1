"""Rules that make an answer certain whatever the normals are, confirmed by counting, or by what surfaces slip along.

Each rule has a function that says what is wrong with it, for one claim; `analysis.counting` and `analysis.slipping` say
why the rules hold. A new rule is a new name in `RuleName` and a function here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, motion_scaled, scale_of, unit_normal, velocity
from fixture_design.layout import Answer, Counted, Rule, RuleName
from fixture_design.tolerances import COPLANAR_ANGLE, ROUND_OFF, SLIP_ERRORS, WITNESS

#: Claims that mean "not closed", and how they are answered then.
_NOT_CLOSED = {("form_closure", Answer.NO), ("accessible", Answer.YES), ("force_closure", Answer.NO)}


def rule_fault(
    rule: Rule, claim: str, answer: Answer | None, motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    """What is wrong with a rule as the reason of a claim's answer; None if nothing is.

    ``motion``: the evidence's. A common slip is checked here altogether, the motion of other rules by its products.
    """
    check = _RULES.get(rule.name)
    if check is None:
        return f"no rule is called {rule.name!r}"
    if not contacts:
        return "no rule holds of no contacts"
    if claim == "force_closure" and any(contact.friction > 0 for contact in contacts):
        return "counting normals says nothing of contacts with friction"
    return check(rule, (claim, answer), motion, contacts)


def _few_rows(
    rule: Rule, claimed: tuple[str, Answer | None], motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    dimension = contacts[0].dimension
    if claimed == ("deterministic", Answer.NO):
        most = dimension - 1
    elif claimed in _NOT_CLOSED:
        most = dimension
    else:
        return "few rows do not tell that"
    return _count_fault(rule, most, contacts, _rows_at_most)


def _few_normals(
    rule: Rule, claimed: tuple[str, Answer | None], motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    if claimed not in _NOT_CLOSED:
        return "few normals do not tell that"
    return _count_fault(rule, len(contacts[0].point), contacts, lambda block: len(block[0].clauses))


def _common_slip(
    rule: Rule, claimed: tuple[str, Answer | None], motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    """The motion is among each surface's own, within the error; and these are tangent to the surface where touched."""
    if claimed not in {*_NOT_CLOSED, ("deterministic", Answer.NO)}:
        return "a common slip does not tell that"
    if motion is None or motion.shape != (6,) or not (np.isfinite(motion).all() and motion.any()):
        return "there is no motion to slip"
    scale = scale_of(contacts)
    unit = motion_scaled(motion, scale.reference, scale.length)
    unit = unit / np.linalg.norm(unit)
    for contact in contacts:
        error = contact.provenance.off_slip
        lever = float(np.linalg.norm(contact.point - scale.reference)) / scale.length
        limit = SLIP_ERRORS * error * float(np.hypot(1.0, lever)) + WITNESS * (1 + scale.offset)
        if error > COPLANAR_ANGLE or len(contact.slips) != len(contact.normals):
            return f"it is not known how {contact.name}'s surfaces slip"
        for normal, slips in zip(contact.normals, contact.slips, strict=True):
            scaled = np.array([motion_scaled(slip, scale.reference, scale.length) for slip in slips])
            moves = np.array([velocity(slip, contact.point) for slip in slips])
            sizes = np.linalg.norm(scaled, axis=1)
            if not len(slips) or not np.isfinite(sizes).all() or not sizes.all():
                return f"{contact.name} has a surface without motions of its own"
            if (np.abs(moves @ unit_normal(normal)) > limit * sizes).any():
                return f"{contact.name}'s surface is said to move along itself, and does not"
            weights = np.linalg.lstsq(scaled.T, unit, rcond=None)[0]
            if np.linalg.norm(scaled.T @ weights - unit) > limit:
                return f"the motion does not move {contact.name}'s surface along itself"
    return None


_RULES: dict[RuleName, Callable[[Rule, tuple[str, Answer | None], Vector | None, Sequence[Contact]], str | None]] = {
    "few rows": _few_rows,
    "few normals": _few_normals,
    "common slip": _common_slip,
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
