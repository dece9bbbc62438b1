"""What makes a piece of evidence a proof: products, sums and singular values, nothing else.

Each function starts again from points and normals and returns what is wrong, or None. Rows are
[n; (x - reference) X n / length] with |n| = 1; a normal that may be off by e moves n . v by up to e |v|, and that much
is held against every proof.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Point, Rows, Vector
from fixture_design.contacts import Contact, contact_edges, unit_normal
from fixture_design.layout import Motion, Singular, Weights
from fixture_design.tolerances import ROUND_OFF, WITNESS

#: A clause of a contact: (contact name, its place among the contact's clauses).
Place = tuple[str, int]


@dataclass(frozen=True, eq=False)
class Case:
    """Contacts, and the scale their rows are measured in."""

    contacts: Sequence[Contact]
    reference: Point
    length: float

    @property
    def opened(self) -> Case:
        """Without the contacts that have clearance; possibly none are left."""
        return replace(self, contacts=[contact for contact in self.contacts if not contact.clearance])

    @property
    def limit(self) -> float:
        """Numbers up to this are rounding: coordinates far from the origin have fewer digits."""
        if not self.contacts:
            return WITNESS
        farthest = max(float(np.linalg.norm(contact.point)) for contact in self.contacts)
        levers = [float(np.linalg.norm(contact.point - self.reference)) for contact in self.contacts]
        reach = min(self.length, max(levers) or self.length)
        return max(WITNESS, 100 * ROUND_OFF * (1 + farthest / reach))

    @property
    def alternatives(self) -> dict[Place, int]:
        """How many alternatives every clause has."""
        return {(c.name, i): len(clause) for c in self.contacts for i, clause in enumerate(c.clauses)}

    def rows(self, contact: Contact, normal: Point, friction: float = 0.0, edges: int = 0) -> Rows:
        """The rows of one normal: one, or one for each edge of its friction cone."""
        lever = contact.point - self.reference
        forces, spins = contact_edges(normal, friction, contact.torsion, edges)
        if len(lever) == 2:
            moments = (lever[0] * forces[:, 1] - lever[1] * forces[:, 0])[:, None]
        else:
            moments = np.cross(lever, forces)
        return np.hstack([forces, (moments + spins) / self.length])

    def error(self, contact: Contact, friction: float = 0.0) -> float:
        """How far a row may be off."""
        reach = np.hypot(1.0, np.linalg.norm(contact.point - self.reference) / self.length)
        spin = friction * contact.torsion / self.length
        return contact.provenance.normal_error * float(reach * np.hypot(1.0, friction) + spin)


def motion_fault(evidence: Motion, case: Case, *, strict: bool, friction: bool) -> str | None:
    """A motion that every contact admits; ``strict``: that leaves every contact; with friction: that none opposes."""
    motion = _unit_motion(evidence.motion, case)
    if motion is None:
        return "the motion is not a finite vector of the right length, or zero"
    worst = max(
        (
            min(_work(contact, normal, motion, friction) for normal in clause)
            for contact in case.contacts
            for clause in contact.clauses
        ),
        default=-1.0,
    )
    return None if worst <= (-case.limit if strict else case.limit) else f"the motion is not admissible: {worst:.1e}"


def weights_fault(evidence: Weights, case: Case, *, closes: bool, friction: bool, edges: int) -> str | None:
    """Weights of one branch that balance; ``closes``: that also span, so that the branch is {o}.

    Balance proves s >= -(r + w . e), r = |D^T w| for weights of sum 1 and row errors e. Closure is proved by
    s >= (sigma_min(diag(w) D) - r) / (1 + |w|) - max e, which must be positive (see `analysis.bounds`).
    """
    found = _weighted_rows(evidence, case, friction=friction, edges=edges)
    if isinstance(found, str):
        return found
    rows, weights, errors, labels = found
    residual = float(np.linalg.norm(weights @ rows))
    if not closes:
        total = residual + float(weights @ errors)
        return None if total <= case.limit else f"the weights do not balance: {total:.1e}"
    sizes = np.linalg.svd(weights[:, None] * rows, compute_uv=False)
    rank = rows.shape[1]
    smallest = sizes[rank - 1] if len(sizes) >= rank else 0.0
    margin = (smallest - residual) / (1 + float(np.linalg.norm(weights))) - float(errors.max())
    if margin <= 100 * ROUND_OFF * sizes[0]:
        return f"the weights do not balance and span: {margin:.1e}"
    basis = [labels.index(place) for place in evidence.basis if place in labels]
    if len(set(basis)) != rank or len(evidence.basis) != rank or not np.all(weights[basis] > 0):
        return "the basis is not one row of positive weight for every dimension"
    independent = np.linalg.svd(rows[basis], compute_uv=False)
    return None if independent[-1] > 100 * ROUND_OFF * independent[0] else "the basis rows are not independent"


def rank_fault(evidence: Singular, case: Case, *, full: bool) -> str | None:
    """``full``: choices of full rank that cover all branches; else a motion that some branch does not notice."""
    if not full:
        return _notice_fault(evidence, case)
    rank = case.contacts[0].dimension
    if evidence.rank != rank:
        return f"rank {evidence.rank} is not {rank}"
    for choice in evidence.choices:
        taken = _as_choice(choice, case)
        if isinstance(taken, str):
            return taken
        picked = [
            (c, c.clauses[i][a]) for c in case.contacts for i in range(len(c.clauses)) if (a := _pick(c, i, taken)) >= 0
        ]
        rows = np.vstack([case.rows(contact, normal) for contact, normal in picked]) if picked else np.zeros((0, rank))
        error = float(np.linalg.norm([case.error(contact) for contact, _ in picked]))
        if len(rows) < rank or np.linalg.svd(rows, compute_uv=False)[-1] <= case.limit + error:
            return "some choice has less than full rank"
    return coverage_fault(evidence.choices, case)


def coverage_fault(choices: Sequence[Sequence[tuple[str, int, int]]], case: Case) -> str | None:
    """Every branch must contain one of the choices; only clauses that some choice names matter."""
    taken = []
    for choice in choices:
        known = _as_choice(choice, case)
        if isinstance(known, str):
            return known
        taken.append(known)
    used = sorted({place for choice in taken for place in choice})
    return None if _covered(taken, used, case.alternatives, {}) else "some branch is not covered"


def _covered(
    choices: Sequence[Mapping[Place, int]],
    used: Sequence[Place],
    counts: Mapping[Place, int],
    taken: dict[Place, int],
) -> bool:
    fitting = [c for c in choices if all(taken.get(place, a) == a for place, a in c.items())]
    if any(all(place in taken for place in choice) for choice in fitting):
        return True
    if not fitting or not used:
        return False
    place, rest = used[0], used[1:]
    if not any(place in choice for choice in fitting):
        return _covered(fitting, rest, counts, taken)
    return all(_covered(fitting, rest, counts, {**taken, place: a}) for a in range(counts[place]))


def _as_choice(choice: Sequence[tuple[str, int, int]], case: Case) -> dict[Place, int] | str:
    """The alternative that a choice takes in each clause it names, or what is wrong with it."""
    taken: dict[Place, int] = {}
    counts = case.alternatives
    for name, clause, alternative in choice:
        if not 0 <= alternative < counts.get((name, clause), 0):
            return f"there is no alternative {alternative} of clause {clause} of {name!r}"
        if (name, clause) in taken:
            return f"clause {clause} of {name!r} is chosen twice"
        taken[name, clause] = alternative
    return taken


def _pick(contact: Contact, clause: int, taken: Mapping[Place, int]) -> int:
    """The alternative that is active in a clause: the only one, the one taken, or -1 for none."""
    return 0 if len(contact.clauses[clause]) == 1 else taken.get((contact.name, clause), -1)


def _weighted_rows(
    evidence: Weights, case: Case, *, friction: bool, edges: int
) -> tuple[Rows, np.ndarray, np.ndarray, list[tuple[str, int]]] | str:
    """Rows, weights of sum 1, row errors and labels of a branch; or what is wrong with the weights' form."""
    taken = _as_choice(evidence.choice, case)
    if isinstance(taken, str):
        return taken
    if not case.contacts or set(evidence.weights) != {contact.name for contact in case.contacts}:
        return "the weights name other contacts than the group has"
    rows, values, errors, labels = [], [], [], []
    for contact in case.contacts:
        mu = contact.friction if friction else 0.0
        given = np.array(evidence.weights[contact.name])
        expected = 0
        for index, clause in enumerate(contact.clauses):
            for alternative, normal in enumerate(clause):
                added = case.rows(contact, normal, mu, edges)
                part = given[expected : expected + len(added)]
                if part.any() and _pick(contact, index, taken) != alternative:
                    return f"{contact.name} has weight on an alternative that the branch does not take"
                rows.append(added)
                values.append(part)
                errors += [case.error(contact, mu)] * len(added)
                labels += [(contact.name, expected + k) for k in range(len(added))]
                expected += len(added)
        if len(given) != expected:
            return f"{contact.name} has {len(given)} weights, not {expected}"
    weights = np.concatenate(values)
    if not np.isfinite(weights).all() or weights.min() < 0 or not weights.sum() > 0:
        return "weights must be finite, nonnegative and not all zero"
    weights = weights / weights.sum()
    used = np.array(errors) * (weights > 0)
    return np.vstack(rows), weights, used, labels


def _notice_fault(evidence: Singular, case: Case) -> str | None:
    motion = None if evidence.motion is None else _unit_motion(evidence.motion, case)
    if motion is None:
        return "there is no finite motion"
    worst = max(
        min(float(np.abs(case.rows(c, normal) @ _scaled(motion, case))[0]) + case.error(c) for normal in clause)
        for c in case.contacts
        for clause in c.clauses
    )
    return None if worst <= case.limit else f"the motion is noticed: {worst:.1e}"


def _unit_motion(motion: Vector, case: Case) -> Vector | None:
    """The motion [dx; dtheta] at size one in the case's scale; None if it is no motion."""
    if motion.shape != (3 if len(case.reference) == 2 else 6,) or not np.isfinite(motion).all():
        return None
    size = float(np.linalg.norm(_scaled(motion, case)))
    return motion / size if size > 0 else None


def _scaled(motion: Vector, case: Case) -> Vector:
    return np.concatenate([_velocity(motion, case.reference), motion[len(case.reference) :] * case.length])


def _work(contact: Contact, normal: Point, motion: Vector, friction: bool) -> float:
    """n . v + mu |[v_t; c w_n]|, and what the normal's error may add to it."""
    v = _velocity(motion, contact.point)
    mu = contact.friction if friction else 0.0
    unit = unit_normal(normal)
    along = float(unit @ v)
    slip = float(np.linalg.norm(v - along * unit))
    unsure = float(np.linalg.norm(v) * np.hypot(1.0, mu))
    if contact.torsion:
        slip = float(np.hypot(slip, contact.torsion * (unit @ motion[3:])))
        unsure += mu * contact.torsion * float(np.linalg.norm(motion[3:]))
    return along + mu * slip + contact.provenance.normal_error * unsure


def _velocity(motion: Vector, point: Point) -> Point:
    if len(point) == 2:
        return motion[:2] + motion[2] * np.array([-point[1], point[0]])
    return motion[:3] + np.cross(motion[3:], point)
