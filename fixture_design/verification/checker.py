"""Confirms any verdict's evidence, branch by branch, without a solver: products, sums and ranks, nothing else.

It starts again from points and normals, not from the arrays of the search, so that a mistake in those cannot hide:

* a motion is multiplied with every contact; with friction, with the circular cone;
* weights are multiplied with every contact's wrenches, must be nonnegative, balance, and where the claim is closure
  span everything; together they must cover every branch.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.arrays import Point, Rows, Vector
from fixture_design.contacts import Clause, Contact, friction_edges, unit_normal
from fixture_design.layout import Answer, Finding, GroupVerdict, Motion, Singular, Verdict, Weights
from fixture_design.tolerances import WITNESS

#: Claims whose 'yes' is proved by weights that span (or by a motion that breaks none), and whether friction counts.
_CLOSURES = {"form_closure": False, "accessible": False, "force_closure": True}


def check(verdict: Verdict) -> list[str]:
    """Everything that is wrong with a verdict's evidence; an empty list confirms it."""
    contacts = {contact.name: contact for contact in verdict.contacts}
    problems = []
    for group in verdict.groups.values():
        chosen = [contacts[name] for name in group.contacts]
        problems += check_group(group, chosen, verdict.reference, verdict.length)
    return problems


def check_group(group: GroupVerdict, contacts: Sequence[Contact], reference: Point, length: float) -> list[str]:
    """Problems of one group's findings; empty groups have none to have."""
    problems = []
    for claim, finding in group.findings.items():
        if finding.answer in (None, Answer.UNDECIDED):
            continue
        problem = _check_finding(claim, finding, contacts, reference, length)
        if problem:
            problems.append(f"{group.name}: {claim} {finding.answer}: {problem}")
    return problems


def _check_finding(
    claim: str, finding: Finding, contacts: Sequence[Contact], reference: Point, length: float
) -> str | None:
    evidence = finding.evidence
    if evidence is None:
        return "no evidence"
    if isinstance(evidence, Singular):
        return _check_rank(finding.answer, evidence, contacts, reference, length)
    if isinstance(evidence, Motion):
        strict = claim == "strongly_accessible"
        value = motion_value(evidence.motion, contacts, reference, length, friction=claim == "force_closure")
        if value > (-WITNESS if strict else WITNESS):
            return f"the motion is not admissible: {value:.1e}"
        return None
    edges = finding.edges or 0
    friction = _CLOSURES.get(claim, False)
    for weights in evidence:
        problem = _check_weights(weights, contacts, reference, length, friction, edges, spans=claim in _CLOSURES)
        if problem:
            return problem
    return None if covers_all([weights.choice for weights in evidence], contacts) else "some branch has no weights"


def motion_value(
    motion: Vector, contacts: Sequence[Contact], reference: Point, length: float, *, friction: bool
) -> float:
    """max over contacts and clauses of min over alternatives of n . v (+ mu |v_t|), the motion scaled to size one."""
    plane = len(reference)
    turning = motion[plane:]
    size = np.linalg.norm(np.concatenate([_velocity(motion, reference), turning * length]))
    worst = -np.inf
    for contact in contacts:
        v = _velocity(motion, contact.point) / size
        mu = contact.friction if friction else 0.0
        for clause in contact.clauses:
            worst = max(worst, min(_work(unit_normal(normal), v, mu) for normal in clause))
    return float(worst)


def _work(unit: Point, v: Point, mu: float) -> float:
    along = float(unit @ v)
    return along + mu * float(np.linalg.norm(v - along * unit))


def _velocity(motion: Vector, point: Point) -> Point:
    if len(point) == 2:
        return motion[:2] + motion[2] * np.array([-point[1], point[0]])
    return motion[:3] + np.cross(motion[3:], point)


def _check_weights(
    weights: Weights,
    contacts: Sequence[Contact],
    reference: Point,
    length: float,
    friction: bool,
    edges: int,
    *,
    spans: bool,
) -> str | None:
    chosen = {(name, clause): alternative for name, clause, alternative in weights.choice}
    rows, values, labels = [], [], []
    for contact in contacts:
        mu = contact.friction if friction else 0.0
        given = list(weights.weights[contact.name])
        place = 0
        for index, clause in enumerate(contact.clauses):
            for alternative, normal in enumerate(clause):
                edge_rows = _rows(contact, normal, mu, edges, reference, length)
                part = np.array(given[place : place + len(edge_rows)])
                if len(part) != len(edge_rows):
                    return f"{contact.name} has {len(given)} weights, which is too few"
                if _taken(clause, chosen.get((contact.name, index))) != alternative and part.any():
                    return f"{contact.name} has weight on an alternative that the branch does not take"
                rows.append(edge_rows)
                values.append(part)
                labels += [(contact.name, place + k) for k in range(len(edge_rows))]
                place += len(edge_rows)
    matrix, w = np.vstack(rows), np.concatenate(values)
    if w.min() < 0 or not w.sum() > 0:
        return "weights must be nonnegative and not all zero"
    residual = np.linalg.norm(w @ matrix) / w.sum()
    if residual > WITNESS:
        return f"the weights do not balance: {residual:.1e}"
    if spans:
        basis = [labels.index(place) for place in weights.basis]
        if len(basis) != matrix.shape[1] or not np.all(w[basis] > 0):
            return "the basis is not one row of positive weight for every dimension"
        heavy = w[basis, None] / w.sum() * matrix[basis]
        if np.linalg.svd(heavy, compute_uv=False)[-1] <= residual:
            return "the basis rows are not independent"
    return None


def _taken(clause: Clause, choice: int | None) -> int | None:
    """The alternative that a branch takes; a clause with one normal needs no choice, an open one takes none."""
    return 0 if len(clause) == 1 else choice


def _rows(contact: Contact, normal: Point, mu: float, edges: int, reference: Point, length: float) -> Rows:
    lever = contact.point - reference
    forces = friction_edges(normal, mu, edges)
    if len(lever) == 2:
        moments = (lever[0] * forces[:, 1] - lever[1] * forces[:, 0])[:, None]
    else:
        moments = np.cross(lever, forces)
    return np.hstack([forces, moments / length])


def covers_all(choices: Sequence[Sequence[tuple[str, int, int]]], contacts: Sequence[Contact]) -> bool:
    """Whether every branch contains one of the choices.

    Only clauses that some choice names matter; their combinations are gone through one by one.
    """
    counts = {
        (contact.name, index): len(clause) for contact in contacts for index, clause in enumerate(contact.clauses)
    }
    taken = [{(name, clause): alternative for name, clause, alternative in choice} for choice in choices]
    used = sorted({place for choice in taken for place in choice})
    return _covered(taken, used, counts, {})


def _covered(
    choices: Sequence[Mapping[tuple[str, int], int]],
    used: Sequence[tuple[str, int]],
    counts: Mapping[tuple[str, int], int],
    taken: dict[tuple[str, int], int],
) -> bool:
    fitting = [c for c in choices if all(taken.get(place, a) == a for place, a in c.items())]
    if any(all(place in taken for place in choice) for choice in fitting):
        return True
    if not fitting or not used:
        return False
    place, rest = used[0], used[1:]
    return all(_covered(fitting, rest, counts, {**taken, place: a}) for a in range(counts[place]))


def _check_rank(
    answer: Answer | None, evidence: Singular, contacts: Sequence[Contact], reference: Point, length: float
) -> str | None:
    """'No' needs a motion that some branch does not notice; 'yes' choices of full rank that cover all branches."""
    rows = {
        (contact.name, index, alternative): _rows(contact, normal, 0.0, 0, reference, length)
        for contact in contacts
        for index, clause in enumerate(contact.clauses)
        for alternative, normal in enumerate(clause)
    }
    if answer is Answer.NO:
        return _check_unnoticed(evidence, rows, reference, length)
    if evidence.rank != contacts[0].dimension:
        return f"rank {evidence.rank} is not {contacts[0].dimension}"
    always = [
        rows[contact.name, index, 0]
        for contact in contacts
        for index, clause in enumerate(contact.clauses)
        if len(clause) == 1
    ]
    for choice in evidence.choices:
        matrix = np.vstack([*always, *(rows[taken] for taken in choice)])
        if np.linalg.matrix_rank(matrix, tol=WITNESS) < evidence.rank:
            return "some choice has less than full rank"
    return None if covers_all(evidence.choices, contacts) else "some branch has no choice of full rank"


def _check_unnoticed(
    evidence: Singular, rows: Mapping[tuple[str, int, int], Rows], reference: Point, length: float
) -> str | None:
    """The motion must be orthogonal to some alternative of every clause."""
    if evidence.motion is None:
        return "no motion"
    plane = len(reference)
    scaled = np.concatenate([_velocity(evidence.motion, reference), evidence.motion[plane:] * length])
    scaled = scaled / np.linalg.norm(scaled)
    noticed: dict[tuple[str, int], float] = {}
    for (name, index, _), row in rows.items():
        noticed[name, index] = min(noticed.get((name, index), np.inf), float(np.abs(row @ scaled).max()))
    worst = max(noticed.values())
    return None if worst <= WITNESS else f"the motion is noticed: {worst:.1e}"
