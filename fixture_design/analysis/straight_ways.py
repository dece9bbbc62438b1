"""Straight ways out: the directions in which a part leaves its contacts without turning.

A translation t moves every point alike, so that a contact with outward normal n asks n . t <= 0 and nothing else, in
every clause for one of its alternatives. The directions form a union of cones in R^p, one a branch (2-9), of which only
the normals matter, not the points:

* some t has n . t < 0 throughout              it leaves all contacts at once
* some t has n . t <= 0, and 0 for some        it slides along these; certain only where they are known to rounding, or
                                               t is known to move their surface along itself
* weights w >= 0 balance normals of rank p     there is no direction at all

A normal that may be off by e moves n . t by up to e |t|. Where that could turn the answer it is left undecided.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, islice, product
from math import prod

import numpy as np

from fixture_design.analysis.branches import Leaf, UnionQuestions
from fixture_design.analysis.normal_errors import blur
from fixture_design.arrays import Point, Points, Rows, Weights
from fixture_design.cones import convert_rows
from fixture_design.cones.kernel import minimum_norm_point, singular_directions, tucker_partition
from fixture_design.contacts import Constraints, Contact, Scale, unit_normal
from fixture_design.errors import ConeError
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, SUM_ROUNDING, WITNESS, Tolerances

#: Cones of the union that are listed one by one; of larger unions only the one that lets the part out.
MAX_BRANCHES = 64


@dataclass(frozen=True, eq=False)
class WaysOfBranch:
    """The cone of directions of one branch, not {o}.

    Attributes:
        rows: the branch's unit normals, shape (m, p).
        spans, lines: generators, unit, shapes (k, p) and (l, p).
        best: unit; the least -n . t over the normals that can be left is largest.
        leaving: the least -n . best over all normals; 0 where it slides along some [-].
    """

    rows: Rows
    spans: Rows
    lines: Rows
    best: Point
    leaving: float


@dataclass(frozen=True, eq=False)
class DirectionCone:
    """The directions that some contacts, possibly none, leave open, and what is certain about them.

    Attributes:
        contacts: asked.  up: where ties go, unit, shape (p,).
        truth: whether there is one; None if that depends on what is not known.
        branches: the cones, that with the best direction first; not all of them if there are very many.
        weights: where there is none, weights on the unit normals that say so; one set for each branch that needs it.
        certain: a unit direction that was found with the errors of normals in view, if one was.
        reason: why it is undecided.
    """

    contacts: tuple[Contact, ...]
    up: Point
    tolerances: Tolerances
    truth: bool | None
    branches: tuple[WaysOfBranch, ...] = ()
    weights: tuple[Mapping[str, tuple[float, ...]], ...] = ()
    certain: Point | None = None
    reason: str | None = None

    @property
    def first(self) -> Point | None:
        """The best direction that is admitted; None if none was found."""
        bests = (_tidy(branch.best) for branch in self.branches)
        admitted = next((best for best in bests if self.admits(best)), None)
        return next(iter(self.candidates()), None) if admitted is None else admitted

    def admits(self, direction: Point) -> bool:
        """Whether every contact lets it pass, whatever its normals are within their errors."""
        return all(clause_value(c, i, direction) <= self.tolerances.zero for c, i in _clauses(self.contacts))

    def leaving(self, direction: Point) -> float:
        """The least -n . t over all clauses, of each the alternative that leaves most; 1 without contacts [-]."""
        return -max((_nominal(c, i, direction) for c, i in _clauses(self.contacts)), default=-1.0)

    def slides(self, direction: Point) -> tuple[str, ...]:
        """Contacts that it slides along."""
        return slid_along(self.contacts, direction, self.tolerances.near)

    def candidates(self, preferred: Sequence[Point] = ()) -> list[Point]:
        """Directions worth trying, all admitted, each once: the best ones, ``preferred``, up, the rays, mixtures."""
        found: list[Point] = []
        for direction in (
            *(branch.best for branch in self.branches),
            *([] if self.certain is None else [self.certain]),
            *preferred,
            self.up,
            *(ray for branch in self.branches for ray in _rays(branch)),
            *(mixed for branch in self.branches for mixed in _mixtures(branch, self.up)),
        ):
            length = float(np.linalg.norm(direction))
            if length <= WITNESS:
                continue
            unit = _tidy(np.asarray(direction, dtype=np.float64) / length)
            if self.admits(unit) and not any(np.linalg.norm(unit - other) <= COPLANAR_ANGLE for other in found):
                found.append(unit)
        return found

    @property
    def confining(self) -> Mapping[str, tuple[float, ...]] | None:
        """Weights that leave no direction but those of one line, where that is certain; else None.

        They balance exactly known normals of rank p - 1, so that n . t = 0 for all of these.
        """
        if len(self.branches) != 1 or any(len(clause) > 1 for c in self.contacts for clause in c.clauses):
            return None
        partition = tucker_partition(self.branches[0].rows, self.tolerances.tie)
        if len(partition.span) != len(self.up) - 1:
            return None
        return _by_contact(self.contacts, partition.weights)


def direction_cone(
    contacts: Sequence[Contact], up: Point | None = None, tolerances: Tolerances = DEFAULT, plane: int = 3
) -> DirectionCone:
    """The straight ways out of some contacts; without any, every direction is one.

    Args:
        up: where ties go, of any length; by default the last coordinate.  plane: coordinates, 2 or 3, without contacts.
    """
    size = len(contacts[0].point) if contacts else plane
    towards = np.eye(size)[-1] if up is None or not np.any(up) else np.asarray(up, dtype=np.float64)
    towards = unit_normal(towards)
    asked = tuple(contacts)
    if not asked:
        nothing = np.zeros((0, size))
        return DirectionCone(
            asked, towards, tolerances, True, (WaysOfBranch(nothing, nothing, np.eye(size), towards, 1.0),)
        )
    constraints = _constraints(asked)
    questions = UnionQuestions(constraints, tolerances)
    interior = questions.has_interior()
    closed = None if interior.truth else questions.closed()
    if closed is not None and closed.truth:
        return DirectionCone(
            asked, towards, tolerances, False, weights=tuple(_leaf_weights(asked, leaf) for leaf in closed.leaves)
        )
    motion = interior.motion if closed is None else closed.motion
    branches = _branches(constraints, motion, towards, tolerances)
    cone = DirectionCone(asked, towards, tolerances, True, branches, certain=motion)
    if cone.first is not None:
        return cone
    why = (
        closed or interior
    ).reason or "at best the part slides out along contacts whose normals are not known well enough"
    reason = "; ".join(text for text in (why, blur(asked, tolerances)) if text)
    return DirectionCone(asked, towards, tolerances, None, branches, reason=reason)


def clause_value(contact: Contact, clause: int, direction: Point) -> float:
    """The least n . t over a clause's alternatives, with what the normal's error may add.

    Along translations that are known to move the surface along itself nothing is added, however its normal is off.
    """
    first = sum(len(alternatives) for alternatives in contact.clauses[:clause])
    values = []
    for index, normal in enumerate(contact.clauses[clause], start=first):
        off, error = direction, contact.provenance.normal_error
        if error:
            off = direction - _along_surface(contact, index, direction)
            if np.linalg.norm(off) <= WITNESS:
                off = np.zeros_like(direction)
        values.append(float(unit_normal(normal) @ off) + error * float(np.linalg.norm(off)))
    return min(values)


def slid_along(contacts: Sequence[Contact], direction: Point, near: float) -> tuple[str, ...]:
    """Names of contacts of which some clause has no alternative that a unit direction leaves by more than ``near``."""
    sliding = [contact.name for contact, i in _clauses(contacts) if _nominal(contact, i, direction) >= -near]
    return tuple(dict.fromkeys(sliding))


def _along_surface(contact: Contact, index: int, direction: Point) -> Point:
    """The part of a direction that is known to move the surface of a normal along itself."""
    if len(contact.slips) != len(contact.normals) or contact.provenance.off_slip > COPLANAR_ANGLE:
        return np.zeros_like(direction)
    slips, size = contact.slips[index], len(direction)
    pure = slips[~slips[:, size:].any(axis=1), :size]
    lengths, axes = singular_directions(pure)
    axes = axes[: int(np.sum(lengths > SUM_ROUNDING))]
    return (axes @ direction) @ axes


def _clauses(contacts: Sequence[Contact]) -> list[tuple[Contact, int]]:
    return [(contact, index) for contact in contacts for index in range(len(contact.clauses))]


def _nominal(contact: Contact, clause: int, direction: Point) -> float:
    return min(float(unit_normal(normal) @ direction) for normal in contact.clauses[clause])


def _constraints(contacts: Sequence[Contact]) -> Constraints:
    """The unit normals as rows; their points have no say."""
    rows = np.array([unit_normal(normal) for contact in contacts for normal in contact.normals])
    errors = np.array([contact.provenance.normal_error for contact in contacts for _ in contact.normals])
    sizes = [len(clause) for contact in contacts for clause in contact.clauses]
    owners = [index for index, contact in enumerate(contacts) for _ in contact.clauses]
    clause = np.repeat(np.arange(len(sizes)), sizes)
    return Constraints(
        rows, errors, np.arange(len(rows)), clause, np.array(owners), Scale(np.zeros(rows.shape[1]), 1.0)
    )


def _branches(
    constraints: Constraints, motion: Point | None, up: Point, tolerances: Tolerances
) -> tuple[WaysOfBranch, ...]:
    """The cones of the union that are not {o}, best first; of a large union the one that has the motion."""
    alternatives = [constraints.alternatives_of(clause) for clause in range(len(constraints.contact))]
    if prod(len(some) for some in alternatives) <= MAX_BRANCHES:
        choices = list(islice(product(*alternatives), MAX_BRANCHES))
    elif motion is None:
        return ()
    else:
        choices = [tuple(int(some[np.argmin(constraints.rows[some] @ motion)]) for some in alternatives)]
    found = (_ways(constraints.rows[list(choice)], up, tolerances) for choice in choices)
    return tuple(sorted((ways for ways in found if ways is not None), key=lambda ways: -ways.leaving))


def _ways(rows: Rows, up: Point, tolerances: Tolerances) -> WaysOfBranch | None:
    """The cone of one branch; None if it is {o}."""
    try:
        cone = convert_rows(rows, np.zeros((0, rows.shape[1])), tolerances)
    except ConeError:
        return None
    partition = tucker_partition(rows, tolerances.tie)
    if partition.closes or not (len(cone.vectors) or len(cone.lines)):
        return None
    free = singular_directions(partition.span)[1][len(partition.span) :]
    rest = rows[~partition.balanced]
    best = _tidy(_farthest(rest, free, up))
    leaving = 0.0 if partition.balanced.any() else float(-(rows @ best).max())
    return WaysOfBranch(rows, cone.vectors, cone.lines, best, leaving)


def _farthest(rest: Rows, free: Points, up: Point) -> Point:
    """The unit t of a subspace whose least -n . t over the remaining normals is largest; without any, the most upward.

    It is opposite to the point nearest to the origin of the hull of the normals' parts in the subspace.
    """
    if len(rest):
        inside = -minimum_norm_point(rest @ free.T)[0]
    else:
        inside = free @ up
        if np.linalg.norm(inside) <= COPLANAR_ANGLE:
            inside = np.eye(len(free))[0]
    towards = inside @ free
    return towards / np.linalg.norm(towards)


def _rays(branch: WaysOfBranch) -> list[Point]:
    return [*branch.spans, *branch.lines, *(-branch.lines)]


def _mixtures(branch: WaysOfBranch, up: Point) -> list[Point]:
    """Between the best direction and others, and between two rays."""
    rays = _rays(branch)
    return [*(branch.best + other for other in (up, *rays)), *(one + other for one, other in combinations(rays, 2))]


def _tidy(unit: Point) -> Point:
    """Without components that are only rounding."""
    clean = np.where(np.abs(unit) < SUM_ROUNDING, 0.0, unit)
    return clean / np.linalg.norm(clean)


def _leaf_weights(contacts: Sequence[Contact], leaf: Leaf) -> Mapping[str, tuple[float, ...]]:
    return _by_contact(contacts, leaf.weights)


def _by_contact(contacts: Sequence[Contact], weights: Weights) -> Mapping[str, tuple[float, ...]]:
    """One weight a normal, by name."""
    remaining = iter(weights.tolist())
    return {contact.name: tuple(next(remaining) for _ in contact.normals) for contact in contacts}
