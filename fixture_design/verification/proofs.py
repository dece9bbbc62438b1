"""What makes a piece of evidence a proof: products, sums and singular values, nothing else.

Each function starts again from points and normals and returns what is wrong, or None. A proof holds in every scale; the
limits of rounding do not. So rows are taken about the contacts' own centroid, over their own spread, at length one,
however far from the origin or small beside the part the contacts are. A normal that may be off by e moves n . v by up
to e |v|, and that much is held against every proof, unless a rule (`rules`) says that normals do not matter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.arrays import Point, Points, Rows, Vector
from fixture_design.contacts import (
    Contact,
    Scale,
    contact_edges,
    cross,
    motion_scaled,
    scale_of,
    unit_normal,
    velocity,
)
from fixture_design.layout import Motion, Singular, Weights
from fixture_design.tolerances import DEFAULT, SUM_ROUNDING, WITNESS

#: A clause of a contact: (contact name, its place among the contact's clauses).
Place = tuple[str, int]


@dataclass(frozen=True, eq=False)
class Case:
    """Contacts (possibly none), the dimension of their space's motions, and the scale of their rows.

    Attributes:
        given: the scale; by default the contacts' own, in which proofs are judged.
    """

    contacts: Sequence[Contact]
    dimension: int
    given: Scale | None = None

    @property
    def opened(self) -> Case:
        """Without the contacts that have clearance; possibly none are left."""
        return replace(self, contacts=[contact for contact in self.contacts if not contact.clearance])

    @cached_property
    def scale(self) -> Scale:
        return self.given or scale_of(self.contacts)

    @cached_property
    def limit(self) -> float:
        """Numbers up to this are rounding: coordinates far from the origin have fewer digits."""
        if not self.contacts:
            return WITNESS
        farthest = max(float(np.linalg.norm(contact.point)) for contact in self.contacts)
        return max(WITNESS, SUM_ROUNDING * (1 + farthest / self.scale.length))

    @property
    def near(self) -> float:
        """Numbers beyond this are certainly not zero."""
        return DEFAULT.at_offset(self.scale.offset).near

    @cached_property
    def alternatives(self) -> dict[Place, int]:
        """How many alternatives every clause has."""
        return {(c.name, i): len(clause) for c in self.contacts for i, clause in enumerate(c.clauses)}

    def rows(self, contact: Contact, forces: Points, spins: np.ndarray | None = None) -> Rows:
        """Wrenches of forces at a contact, of any length, with moments at its point, shape (k, 1) or (k, 3), added."""
        lever = contact.point - self.scale.reference
        moments = cross(np.broadcast_to(lever, forces.shape), forces) + (0.0 if spins is None else spins)
        return np.hstack([forces, moments / self.scale.length])

    def error(self, contact: Contact, friction: float = 0.0) -> float:
        """How far a row of unit normal component may be off."""
        reach = np.hypot(1.0, np.linalg.norm(contact.point - self.scale.reference) / self.scale.length)
        spin = friction * contact.torsion / self.scale.length
        return contact.provenance.normal_error * float(reach * np.hypot(1.0, friction) + spin)


@dataclass(frozen=True, eq=False)
class Pyramids:
    """Friction cones as the evidence has them.

    Attributes:
        edges: of each cone in space.
        tangents: for each contact with friction in space, the first tangent of each normal's edges.
    """

    edges: int
    tangents: Mapping[str, Sequence[Point]]

    def forces(self, contact: Contact) -> list[tuple[Points, Rows | None]] | str:
        """The edges of each normal of a contact, forces and moments, or what is wrong with its tangents.

        Any unit tangent will do: every edge n + mu t is in the friction cone.
        """
        if contact.friction == 0 or len(contact.point) == 2:
            return [contact_edges(normal, contact.friction, contact.torsion) for normal in contact.normals]
        given = self.tangents.get(contact.name, ())
        if len(given) != len(contact.normals) or self.edges < 1:
            return f"{contact.name} has {len(given)} tangents and {self.edges} edges for {len(contact.normals)} normals"
        pairs = list(zip(contact.normals, given, strict=True))
        if not all(np.shape(t) == np.shape(n) and _is_tangent(t, n) for n, t in pairs):
            return f"{contact.name} has a tangent that is not a unit vector across its normal"
        mu, torsion = contact.friction, contact.torsion
        return [contact_edges(normal, mu, torsion, self.edges, first=tangent) for normal, tangent in pairs]


def unit_forces(contact: Contact, pyramids: Pyramids | None) -> list[tuple[Points, Rows | None]] | str:
    """Forces and moments of each normal's rows, of unit normal component; without pyramids the normals themselves.

    Or what is wrong with the pyramids' tangents.
    """
    if pyramids is not None:
        return pyramids.forces(contact)
    return [(unit_normal(normal)[None, :], None) for normal in contact.normals]


def _is_tangent(tangent: Point, normal: Point) -> bool:
    """Whether it is a unit vector across the normal; one with NaN is not."""
    off = [abs(float(np.linalg.norm(tangent)) - 1), abs(float(unit_normal(normal) @ tangent))]
    return bool(np.max(off) <= WITNESS)


def motion_fault(evidence: Motion, case: Case, *, strict: bool, friction: bool, nominal: bool = False) -> str | None:
    """A motion that every contact admits; ``strict``: that leaves every contact; with friction: that none opposes.

    ``nominal``: with the normals as they are given, since a rule vouches for all others.
    """
    motion = _unit_motion(evidence.motion, case)
    if motion is None:
        return "the motion is not a finite vector of the right length, or zero"
    worst = max(
        (
            min(_work(contact, normal, motion, case, friction, nominal) for normal in clause)
            for contact in case.contacts
            for clause in contact.clauses
        ),
        default=-1.0,
    )
    # points between two linked ends are only kept out if one alternative holds at both
    for first, second in _linked_pairs(case):
        works = [
            max(_work(end, normal, motion, case, friction, nominal) for end in (first, second))
            for normal in first.clauses[0]
        ]
        worst = max(worst, min(works))
    return None if worst <= (-case.limit if strict else case.limit) else f"the motion is not admissible: {worst:.1e}"


def _linked_pairs(case: Case) -> list[tuple[Contact, Contact]]:
    """The two ends of every segment along which convex edges touch, each pair once."""
    by_name = {contact.name: contact for contact in case.contacts}
    pairs = [(contact, by_name[contact.linked]) for contact in case.contacts if contact.linked in by_name]
    return [pair for pair in pairs if pair[0].name < pair[1].name]


def weights_fault(evidence: Weights, case: Case, *, closes: bool, pyramids: Pyramids | None) -> str | None:
    """Weights of one branch that balance; ``closes``: that also span, so that the branch is {o}.

    Balance proves s >= -(r + w . e), r = |D^T w| for weights of sum 1 and row errors e. Closure is proved by
    s >= (sigma_min(diag(w) D) - r) / (1 + |w|) - max e, which must be positive (see `analysis.bounds`), and then there
    is no interior either. That bound alone would have room for an r that is clearly not zero: such weights do not
    balance, as they claim to, and belong to other normals or edges.
    """
    found = _weighted_rows(evidence, case, pyramids)
    if isinstance(found, str):
        return found
    rows, weights, errors, labels = found
    residual = float(np.linalg.norm(weights @ rows))
    if not residual <= case.near:
        return f"the weights do not balance: {residual:.1e}"
    if not closes and residual + float(weights @ errors) <= case.limit:
        return None
    sizes = np.linalg.svd(weights[:, None] * rows, compute_uv=False)
    rank = rows.shape[1]
    smallest = sizes[rank - 1] if len(sizes) >= rank else 0.0
    margin = (smallest - residual) / (1 + float(np.linalg.norm(weights))) - float(errors.max())
    if margin <= SUM_ROUNDING * sizes[0]:
        return f"the weights do not balance and span: {margin:.1e}"
    if not closes:
        return None  # closed, and so without interior, however far the normals are off
    basis = [labels.index(place) for place in evidence.basis if place in labels]
    if len(set(basis)) != rank or len(evidence.basis) != rank or not np.all(weights[basis] > 0):
        return "the basis is not one row of positive weight for every dimension"
    independent = np.linalg.svd(rows[basis], compute_uv=False)
    return None if independent[-1] > SUM_ROUNDING * independent[0] else "the basis rows are not independent"


def rank_fault(evidence: Singular, case: Case, *, full: bool, nominal: bool = False) -> str | None:
    """``full``: choices of full rank that cover all branches; else a motion that some branch does not notice.

    ``nominal``: as in `motion_fault`.
    """
    if not full:
        return _notice_fault(evidence, case, nominal)
    rank = case.dimension
    if evidence.rank != rank:
        return f"rank {evidence.rank} is not {rank}"
    for choice in evidence.choices:
        taken = _as_choice(choice, case)
        if isinstance(taken, str):
            return taken
        picked = [
            (c, c.clauses[i][a]) for c in case.contacts for i in range(len(c.clauses)) if (a := _pick(c, i, taken)) >= 0
        ]
        rows = np.vstack([np.zeros((0, rank)), *(case.rows(c, unit_normal(normal)[None, :]) for c, normal in picked)])
        lengths = np.linalg.norm(rows, axis=1, keepdims=True)
        rows = rows / lengths
        error = float(np.linalg.norm([case.error(c) for c, _ in picked] / lengths[:, 0]))
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
    evidence: Weights, case: Case, pyramids: Pyramids | None
) -> tuple[Rows, np.ndarray, np.ndarray, list[tuple[str, int]]] | str:
    """Unit rows, weights of sum 1, row errors and labels of a branch; or what is wrong with the weights' form."""
    taken = _as_choice(evidence.choice, case)
    if isinstance(taken, str):
        return taken
    if not case.contacts or set(evidence.weights) != {contact.name for contact in case.contacts}:
        return "the weights name other contacts than the group has"
    rows, values, errors, labels = [], [], [], []
    for contact in case.contacts:
        mu = contact.friction if pyramids else 0.0
        forces = unit_forces(contact, pyramids)
        if isinstance(forces, str):
            return forces
        remaining = iter(forces)
        given = np.array(evidence.weights[contact.name])
        expected = 0
        for index, clause in enumerate(contact.clauses):
            for alternative in range(len(clause)):
                added = case.rows(contact, *next(remaining))
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
    matrix = np.vstack(rows)
    lengths = np.linalg.norm(matrix, axis=1)
    weights = weights * lengths / (weights @ lengths)
    used = np.array(errors) / lengths * (weights > 0)
    return matrix / lengths[:, None], weights, used, labels


def _notice_fault(evidence: Singular, case: Case, nominal: bool) -> str | None:
    motion = None if evidence.motion is None else _unit_motion(evidence.motion, case)
    if motion is None:
        return "there is no finite motion"
    if not 0 <= evidence.rank < case.dimension:
        return f"the rank {evidence.rank} is not between 0 and {case.dimension - 1}"
    if len(evidence.choices) != 1:
        return f"one branch has the motion, not {len(evidence.choices)}"
    taken = _as_choice(evidence.choices[0], case)
    if isinstance(taken, str):
        return taken
    worst = max(
        min(max(_work(c, n, motion, case, False, nominal) for n in (normal, -normal)) for normal in clause)
        for c in case.contacts
        for clause in c.clauses
    )
    return None if worst <= case.limit else f"the motion is noticed: {worst:.1e}"


def _unit_motion(motion: Vector, case: Case) -> Vector | None:
    """The motion [dx; dtheta] at size one in the case's scale; None if it is no motion."""
    if motion.shape != (case.dimension,) or not np.isfinite(motion).all():
        return None
    if not case.contacts:
        return motion if motion.any() else None
    size = float(np.linalg.norm(_scaled(motion, case)))
    return motion / size if size > 0 else None


def _scaled(motion: Vector, case: Case) -> Vector:
    return motion_scaled(motion, case.scale.reference, case.scale.length)


def _work(contact: Contact, normal: Point, motion: Vector, case: Case, friction: bool, nominal: bool) -> float:
    """n . v + mu |[v_t; c w_n]| over the length of the normal's row, and what the normal's error may add to it."""
    v = velocity(motion, contact.point)
    mu = contact.friction if friction else 0.0
    unit = unit_normal(normal)
    along = float(unit @ v)
    slip = float(np.linalg.norm(v - along * unit))
    unsure = float(np.linalg.norm(v) * np.hypot(1.0, mu))
    if contact.torsion:
        slip = float(np.hypot(slip, contact.torsion * (unit @ motion[3:])))
        unsure += mu * contact.torsion * float(np.linalg.norm(motion[3:]))
    error = 0.0 if nominal else contact.provenance.normal_error
    return (along + mu * slip + error * unsure) / float(np.linalg.norm(case.rows(contact, unit[None, :])))
