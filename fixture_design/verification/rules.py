"""Rules that make an answer certain whatever the normals are, confirmed by counting, or by what surfaces slip along.

Each rule has a function that says what is wrong with it, for one claim; `analysis.counting` and `analysis.slipping` say
why the rules hold. A new rule is a new name in `RuleName` and a function here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, Scale, motion_scaled, scale_of, unit_normal, velocity
from fixture_design.layout import Answer, Counted, Rule, RuleName
from fixture_design.tolerances import COPLANAR_ANGLE, SUM_ROUNDING, WITNESS

#: Rules that confirm their motion themselves.
SLIP_RULES = ("common slip", "slip or leave")
#: Claims that mean "not closed", and how they are answered then.
_NOT_CLOSED = {("form_closure", Answer.NO), ("accessible", Answer.YES), ("force_closure", Answer.NO)}


def rule_fault(
    rule: Rule, claim: str, answer: Answer | None, motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    """What is wrong with a rule as the reason of a claim's answer; None if nothing is.

    ``motion``: the evidence's. Slips are checked here altogether, the motion of other rules by its products.
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
    unit = _unit(motion, scale_of(contacts))
    if unit is None:
        return "there is no motion to slip"
    return next(filter(None, (_slip_fault(contact, unit, scale_of(contacts)) for contact in contacts)), None)


def _slip_or_leave(
    rule: Rule, claimed: tuple[str, Answer | None], motion: Vector | None, contacts: Sequence[Contact]
) -> str | None:
    """The motion slips along the surfaces of some contacts, and leaves all others by more than errors could undo."""
    if claimed not in _NOT_CLOSED:
        return "slipping and leaving do not tell that"
    scale = scale_of(contacts)
    unit = _unit(motion, scale)
    if unit is None or motion is None:
        return "there is no motion to slip"
    size = float(np.linalg.norm(motion_scaled(motion, scale.reference, scale.length)))
    faults = [_slip_fault(contact, unit, scale) for contact in contacts]
    slipped = [contact for contact, fault in zip(contacts, faults, strict=True) if fault is None]
    undone = max((_slip_limit(contact, scale) for contact in slipped), default=0.0)
    for contact, fault in zip(contacts, faults, strict=True):
        moves = velocity(motion, contact.point) / size
        closing = max(float(unit_normal(normal) @ moves) for normal in contact.normals)
        reach = float(np.hypot(1.0, np.linalg.norm(contact.point - scale.reference) / scale.length))
        error = contact.provenance.normal_error * float(np.linalg.norm(moves))
        if fault is not None and closing + error + undone * reach > 0:
            return f"the motion does not leave {contact.name}, and {fault}"
    return None


def _unit(motion: Vector | None, scale: Scale) -> Vector | None:
    """A spatial motion at size one in the contacts' scale; None if it is none."""
    if motion is None or motion.shape != (6,) or not (np.isfinite(motion).all() and motion.any()):
        return None
    unit = motion_scaled(motion, scale.reference, scale.length)
    return unit / np.linalg.norm(unit)


def _slip_limit(contact: Contact, scale: Scale) -> float:
    """How far a contact's normal error may move its surface's own motions, and rounding [-]."""
    lever = float(np.linalg.norm(contact.point - scale.reference)) / scale.length
    return contact.provenance.off_slip * float(np.hypot(1.0, lever)) + WITNESS * (1 + scale.offset)


def _slip_fault(contact: Contact, unit: Vector, scale: Scale) -> str | None:
    """Why a motion is not known to move all surfaces of a contact along themselves; None if it is."""
    limit = _slip_limit(contact, scale)
    if contact.provenance.off_slip > COPLANAR_ANGLE or len(contact.slips) != len(contact.normals):
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
    "slip or leave": _slip_or_leave,
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
    limit = WITNESS * float(sizes[0]) + SUM_ROUNDING * float(np.abs(points).max())
    return 1 + min(int(np.sum(sizes > limit)), points.shape[1] - 1)
