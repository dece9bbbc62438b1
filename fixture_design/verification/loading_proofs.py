"""Confirms `loadable`: products of directions and normals, and weights that balance, nothing else.

What is in the way of a part is geometry, which a checker has not got: it takes the obstacles as they are told, and
confirms that a direction which is called clear leaves the contacts, and that directions which are called all there are,
are all that the contacts leave.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Answer, Finding, StraightWays
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, SUM_ROUNDING, WITNESS
from fixture_design.verification.proofs import Case, coverage_fault

Set = Mapping[str, tuple[float, ...]]


def loadable_fault(finding: Finding, contacts: Sequence[Contact]) -> str | None:
    """What is wrong with a finding of `loadable` about the contacts of its group; None if nothing is."""
    ways = finding.use
    if not isinstance(ways, StraightWays):
        return "it needs straight ways as evidence"
    asked = [c for c in contacts if c.role in ("locator", "finger") and not c.clearance]
    names = tuple(c.name for c in asked)
    if ways.contacts != names or ways.open != tuple(c.name for c in contacts if c.name not in names):
        return "it is not the closed contacts that were asked, or not the others that are called open"
    if ways.length is not None and not (np.isfinite(ways.length) and ways.length >= 0):
        return f"the way is {ways.length} m long"
    size = len(contacts[0].point)
    fault = _generators_fault(ways, asked, size)
    if fault is not None:
        return fault
    if finding.answer is Answer.YES:
        return _way_fault(ways, asked, size) or _residual_fault(finding, _worst(asked, ways.direction))
    return _none_fault(finding, ways, asked, size)


def _way_fault(ways: StraightWays, asked: Sequence[Contact], size: int) -> str | None:
    """A direction that all asked contacts admit, whatever their normals are within their errors."""
    direction = ways.direction
    if direction is None or not _is_unit(direction, size):
        return "the direction is not a finite vector of the right length, and of length one"
    if ways.obstacle is not None:
        return f"{ways.obstacle.name} is in the way"
    worst = _worst(asked, direction)
    return _told_fault(ways, asked, direction) if worst <= WITNESS else f"the direction is not admitted: {worst:.1e}"


def _told_fault(ways: StraightWays, asked: Sequence[Contact], direction: Point) -> str | None:
    """What is told of a direction: how far it leaves the contacts, and along which it slides."""
    values = {c.name: max(_least(clause, direction) for clause in c.clauses) for c in asked}
    leaving = max(0.0, -max(values.values(), default=-1.0))
    if not abs(ways.leaving - leaving) <= WITNESS:
        return f"it leaves the contacts by {leaving:.1e}, not by {ways.leaving:.1e}"
    sliding = tuple(name for name, value in values.items() if value >= -DEFAULT.near)
    return None if ways.slides == sliding else f"it slides along {', '.join(sliding) or 'nothing'}"


def _none_fault(finding: Finding, ways: StraightWays, asked: Sequence[Contact], size: int) -> str | None:
    """No direction at all; or those of one line, and something in the way of each that the contacts admit."""
    sets = ways.branches or (() if ways.weights is None else (ways.weights,))
    if ways.weights is not None and ways.branches:
        return "it has weights for one branch and for several"
    if not sets or not asked:
        return "it needs weights on the normals of the contacts"
    rank = size if ways.direction is None else size - 1
    faults = (_weights_fault(weights, asked, rank) for weights in sets)
    fault = next((fault for fault in faults if fault), None)
    if fault is None:
        fault = _coverage_fault(sets, asked, size)
    if fault is None and ways.direction is not None:
        fault = _line_fault(ways, asked, ways.direction)
    return fault or _residual_fault(finding, max(_imbalance(weights, asked) for weights in sets))


def _line_fault(ways: StraightWays, asked: Sequence[Contact], direction: Point) -> str | None:
    """The balanced normals are square to the direction; both its ends are blocked, or kept shut by a contact."""
    if not _is_unit(direction, len(asked[0].point)):
        return "the direction is not a finite vector of the right length, and of length one"
    assert ways.weights is not None, "a line has one branch"
    values, rows, _ = _weighted(ways.weights, asked)
    off = float(np.abs(rows[values > 0] @ direction).max())
    if off > DEFAULT.zero:
        return f"the normals that balance are not square to the direction: {off:.1e}"
    blocked = [obstacle.direction for obstacle in ways.tried if obstacle.direction is not None]
    for end in (direction, -direction):
        tried = any(_is_unit(b, len(end)) and np.linalg.norm(b - end) <= COPLANAR_ANGLE for b in blocked)
        if not tried and not any(_shuts(contact, end) for contact in asked):
            return f"nothing is known to be in the way along {np.round(end, 3).tolist()}"
    if ways.obstacle is None or ways.obstacle.name not in ways.against:
        return "it does not say what is in the way, or not of what it was checked against"
    return None


def _shuts(contact: Contact, direction: Point) -> bool:
    """Whether a contact forbids a direction whatever its normals are within their errors."""
    error = contact.provenance.normal_error
    return any(_least(clause, direction) - error > DEFAULT.near for clause in contact.clauses)


def _weights_fault(weights: Set, asked: Sequence[Contact], rank: int) -> str | None:
    """Weights w >= 0 that balance normals of this rank, for all that these may be: see `proofs.weights_fault`."""
    if set(weights) != {contact.name for contact in asked}:
        return "the weights name other contacts than were asked"
    if any(len(weights[contact.name]) != len(contact.normals) for contact in asked):
        return "there is not one weight a normal"
    values, rows, errors = _weighted(weights, asked)
    if not np.isfinite(values).all() or values.min() < 0 or not values.sum() > 0:
        return "weights must be finite, nonnegative and not all zero"
    values = values / values.sum()
    residual = float(np.linalg.norm(values @ rows))
    if not residual <= DEFAULT.near:
        return f"the weights do not balance: {residual:.1e}"
    error = float((errors * (values > 0)).max())
    if rank < rows.shape[1] and error > DEFAULT.zero:
        return "normals that are not known exactly leave more than one line"
    sizes = np.linalg.svd(values[:, None] * rows, compute_uv=False)
    smallest = float(sizes[rank - 1]) if len(sizes) >= rank else 0.0
    margin = (smallest - residual) / (1 + float(np.linalg.norm(values))) - error
    return None if margin > SUM_ROUNDING * sizes[0] else f"the weights do not balance and span: {margin:.1e}"


def _coverage_fault(sets: Sequence[Set], asked: Sequence[Contact], size: int) -> str | None:
    """Every branch has all the alternatives that some set of weights is on."""
    choices = []
    for weights in sets:
        choice = []
        for contact in asked:
            first = 0
            for index, clause in enumerate(contact.clauses):
                used = [k for k in range(len(clause)) if weights[contact.name][first + k] > 0]
                first += len(clause)
                if len(used) > 1:
                    return f"{contact.name} has weight on several alternatives of one clause"
                if used and len(clause) > 1:
                    choice.append((contact.name, index, used[0]))
        choices.append(choice)
    return coverage_fault(choices, Case(asked, 3 if size == 2 else 6))


def _generators_fault(ways: StraightWays, asked: Sequence[Contact], size: int) -> str | None:
    """Spans and lines, both ways, are directions that the normals as given admit."""
    for rows, both in ((ways.spans, False), (ways.lines, True)):
        if rows.ndim != 2 or rows.shape[1] != size or not np.isfinite(rows).all():
            return "the generators of the cone are not finite rows of the right length"
        for row in (*rows, *(-rows if both else ())):
            value = max((_least(clause, row) for c in asked for clause in c.clauses), default=-1.0)
            if value > DEFAULT.near * float(np.linalg.norm(row)):
                return f"a generator of the cone is not admitted: {value:.1e}"
    return None


def _residual_fault(finding: Finding, found: float) -> str | None:
    if finding.residual is None or not abs(finding.residual - found) <= WITNESS:
        return f"the residual is {found:.1e}, not {finding.residual}"
    return None


def _is_unit(direction: Point, size: int) -> bool:
    return direction.shape == (size,) and bool(abs(float(np.linalg.norm(direction)) - 1) <= WITNESS)


def _least(clause: Sequence[Point], direction: Point) -> float:
    """n . t of the alternative that lets it pass best."""
    return min(float(unit_normal(normal) @ direction) for normal in clause)


def _worst(asked: Sequence[Contact], direction: Point | None) -> float:
    """The largest n . t over all clauses, of each the best alternative, with what the errors of normals may add."""
    assert direction is not None
    worst = -1.0 if not asked else -np.inf
    for contact in asked:
        remaining = iter(range(len(contact.normals)))
        for clause in contact.clauses:
            worst = max(worst, min(_value(contact, next(remaining), normal, direction) for normal in clause))
    return worst


def _value(contact: Contact, index: int, normal: Point, direction: Point) -> float:
    """n . t and what n's error may add; that is nothing along translations of the surface along itself."""
    error = contact.provenance.normal_error
    if not error:
        return float(unit_normal(normal) @ direction)
    off = direction - _along(contact, index, normal, direction)
    size = float(np.linalg.norm(off))
    return 0.0 if size <= WITNESS else float(unit_normal(normal) @ off) + error * size


def _along(contact: Contact, index: int, normal: Point, direction: Point) -> Point:
    """The part of a direction that is known to move a surface along itself; nothing where that crosses its normal."""
    size = len(direction)
    if len(contact.slips) != len(contact.normals) or contact.provenance.off_slip > COPLANAR_ANGLE:
        return np.zeros(size)
    slips = contact.slips[index]
    pure = np.array([slip[:size] for slip in slips if not slip[size:].any()]).reshape(-1, size)
    across = np.abs(pure @ unit_normal(normal)) > np.linalg.norm(pure, axis=1) * (contact.provenance.off_slip + WITNESS)
    if not len(pure) or across.any():
        return np.zeros(size)
    return pure.T @ np.linalg.lstsq(pure.T, direction, rcond=None)[0]


def _weighted(weights: Set, asked: Sequence[Contact]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Weights, unit normals and their errors, one a normal."""
    values = np.array([weight for contact in asked for weight in weights[contact.name]], dtype=np.float64)
    rows = np.array([unit_normal(normal) for contact in asked for normal in contact.normals])
    errors = np.array([contact.provenance.normal_error for contact in asked for _ in contact.normals])
    return values, rows, errors


def _imbalance(weights: Set, asked: Sequence[Contact]) -> float:
    values, rows, _ = _weighted(weights, asked)
    return float(np.linalg.norm(values @ rows) / values.sum())
