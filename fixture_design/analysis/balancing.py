"""Whether contacts can balance a wrench: forces that do, a motion that says no, or why it is open.

Two sets of forces enclose what contacts will do. *Outer*: all that their cones have. *Inner*: without the friction of
contacts that can push against each other with nothing from outside (a self-stress: fingers on both sides, a pin in its
hole), since friction that needs a squeeze is there only if something squeezes. A balance of inner forces is a yes, a
motion that the outer ones do not resist is a no; in between the part is held only if somebody squeezes it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.analysis.balances import metric, repaired_forces, repaired_motion
from fixture_design.analysis.contact_forces import Choice, ContactForces, contact_forces, force_branches
from fixture_design.analysis.loads import largest_factors, nearest_forces, squeezed_cones
from fixture_design.analysis.normal_errors import blur
from fixture_design.arrays import Vector, Weights
from fixture_design.contacts import Contact, motion_about_origin, scale_of, unit_normal, velocity
from fixture_design.layout import Balance, Unbalanced, element_name
from fixture_design.tolerances import MOST_FORCE_BRANCHES, WITNESS, ZERO_ROW, Tolerances


@dataclass(frozen=True, eq=False)
class ForceBranch:
    """One branch of alternatives: its inner and its outer forces, and who can squeeze whom.

    Attributes:
        squeezed: elements with friction that push against each other with nothing from outside.
        unsure: whose normals may be off, in words; None where all are exact.
    """

    choice: Choice
    inner: ContactForces
    outer: ContactForces
    squeezed: tuple[str, ...]
    unsure: str | None

    @property
    def alike(self) -> bool:
        """Whether the inner forces are the outer ones."""
        return self.inner is self.outer

    @cached_property
    def pushed_with(self) -> float:
        """The largest force that something pushes with [N]."""
        heads = np.nan_to_num(self.inner.cones.heads)
        return float(np.abs(np.concatenate([heads, self.inner.given])).max(initial=0.0)) * self.inner.unit

    def unit_for(self, *wrenches: Vector) -> float:
        """The unit of forces in which wrenches and preloads are of size 1 at most [N]."""
        sizes = [float(np.abs(self.inner.in_units_of(1.0).applied(w)).max(initial=0.0)) for w in wrenches]
        return max(self.pushed_with, *sizes) or 1.0


@dataclass(frozen=True, eq=False)
class Hint:
    """What may settle it without a solver: inner forces x [N], or a motion of the outer ones."""

    x: Weights | None = None
    motion: Weights | None = None


@dataclass(frozen=True, eq=False)
class Settled:
    """Balances for all branches, or a motion for one of them that it has none, or a reason."""

    balances: tuple[Balance, ...] = ()
    against: Unbalanced | None = None
    reason: str | None = None


def branches_of(
    contacts: Sequence[Contact], preloads: Mapping[str, float], tolerances: Tolerances
) -> tuple[list[ForceBranch], bool]:
    """The branches of some contacts, and whether these are all (`MOST_FORCE_BRANCHES`).

    Args:
        preloads: of elements that push with a given force [N].
    """
    choices, complete = force_branches(contacts, MOST_FORCE_BRANCHES)
    return [_branch(contacts, preloads, choice, tolerances) for choice in choices], complete


def _branch(
    contacts: Sequence[Contact], preloads: Mapping[str, float], choice: Choice, tolerances: Tolerances
) -> ForceBranch:
    taken = {(name, clause): alternative for name, clause, alternative in choice}
    scale = scale_of(contacts)
    forces = contact_forces(contacts, preloads, taken, scale=scale)
    passive = [o for o, head in zip(forces.owners, forces.cones.heads, strict=True) if np.isnan(head)]
    names: list[str] = []
    if any(contacts[index].friction for index, _ in passive):
        pushing = [contacts[passive[i][0]].name for i in squeezed_cones(forces.cones.passive)]
        names = list(dict.fromkeys(pushing))
    rough = {c.name for c in contacts if c.friction}
    inner = (
        contact_forces(contacts, preloads, taken, smooth=frozenset(names), scale=scale) if rough & {*names} else forces
    )
    unsure = blur(contacts, tolerances)
    outer = forces if unsure is None else contact_forces(contacts, preloads, taken, widened=True, scale=scale)
    elements = tuple(dict.fromkeys(map(element_name, names)))
    return ForceBranch(choice, inner, outer, elements if rough & {*names} else (), unsure)


def settle(
    branches: Sequence[ForceBranch],
    complete: bool,
    wrench: Vector,
    tolerances: Tolerances,
    hints: Sequence[Hint] | None = None,
) -> Settled:
    """Whether the contacts balance a wrench [N, N m] about W's origin, with their preloads, in every branch.

    The part may move along any branch, so that F = A* is what all branches can do (2-17, Table 3).

    Args:
        hints: for each branch what is tried first.
    """
    balances: list[Balance] = []
    reason = None if complete else f"more than {MOST_FORCE_BRANCHES} choices of the faces that push"
    for branch, hint in zip(branches, hints or [Hint()] * len(branches), strict=True):
        proof = _hinted(branch, hint, wrench, tolerances)
        proof, why = (proof, None) if proof is not None else _settle(branch, wrench, tolerances)
        if isinstance(proof, Balance):
            balances.append(replace(proof, choice=branch.choice))
        elif proof is None:
            reason = reason or why
        elif edges_along_edges(branch.inner.contacts):
            reason = reason or "convex edges touch along parallel convex edges, whose points may take different faces"
        else:
            return Settled(against=proof)
    return Settled(reason=reason) if reason is not None else Settled(tuple(balances))


def edges_along_edges(contacts: Sequence[Contact]) -> bool:
    """Whether contacts stand for segments along which every point has alternatives of its own: branches are too few."""
    return any(c.linked is not None and any(len(clause) > 1 for clause in c.clauses) for c in contacts)


def _hinted(branch: ForceBranch, hint: Hint, wrench: Vector, tolerances: Tolerances) -> Balance | Unbalanced | None:
    """The hint, if it is a proof."""
    unit = branch.unit_for(wrench)
    if hint.x is not None:
        inner = branch.inner.in_units_of(unit)
        x, left = repaired_forces(inner.cones, inner.applied(wrench) + inner.given, hint.x / unit)
        if left <= WITNESS and (branch.unsure is None or _absorbs(inner, x)):
            return Balance(wrench, inner.forces(x), left)
    if hint.motion is not None and np.any(hint.motion):
        return unbalanced(branch, branch.outer.in_units_of(unit), hint.motion, wrench, tolerances)
    return None


def _settle(
    branch: ForceBranch, wrench: Vector, tolerances: Tolerances
) -> tuple[Balance | Unbalanced | None, str | None]:
    unit = branch.unit_for(wrench)
    inner = branch.inner.in_units_of(unit)
    target = inner.applied(wrench) + inner.given
    nearest = nearest_forces(inner.cones, target)
    x, left = repaired_forces(inner.cones, target, nearest.x)
    if left <= WITNESS:
        if branch.unsure is None or _absorbs(inner, x):
            return Balance(wrench, inner.forces(x), left), None
        return None, branch.unsure
    outer = branch.outer.in_units_of(unit)
    motion = nearest.dual if branch.alike else nearest_forces(outer.cones, target).dual
    against = unbalanced(branch, outer, motion, wrench, tolerances)
    if against is None:
        sharper = _sharpened(outer, outer.applied(wrench) + outer.given, motion)
        against = None if sharper is None else unbalanced(branch, outer, sharper, wrench, tolerances)
    return against, None if against else _open(branch)


def _sharpened(outer: ContactForces, target: Weights, motion: Weights) -> Weights | None:
    """A motion that says how much of what is left is needed: where that is little, its direction is not well known."""
    size = float(np.linalg.norm(motion))
    if size <= WITNESS:
        return None
    found = largest_factors(outer.cones, target, (motion / size)[None])
    return found.motions[0] if np.any(found.motions[0]) else None


def _open(branch: ForceBranch) -> str:
    if branch.squeezed:
        *others, last = branch.squeezed
        return f"only by squeezing between {', '.join(others)} and {last}, which nothing applies"
    return branch.unsure or "at the limit of what the contacts can hold"


def unbalanced(
    branch: ForceBranch, outer: ContactForces, motion: Weights, wrench: Vector, tolerances: Tolerances
) -> Unbalanced | None:
    """The motion as a proof that the wrench is not balanced, if it is one by more than a tie."""
    target = outer.applied(wrench) + outer.given
    repaired = repaired_motion(outer.cones, motion)
    if repaired is None:
        return None
    d = outer.contacts[0].dimension
    length = float(np.linalg.norm(repaired[:d]))
    if length <= ZERO_ROW:
        return None
    world = motion_about_origin(repaired[:d] / length, outer.scale.reference, outer.scale.length)
    excess = gained(outer, repaired[:d] / length, target[:d])
    near = tolerances.at_offset(outer.scale.offset).near
    if excess <= near * max(1.0, float(np.linalg.norm(target))):
        return None
    return Unbalanced(wrench, world, float(excess * outer.unit), branch.choice)


def gained(forces: ContactForces, motion: Vector, wrench: Vector, spared: str | None = None) -> float:
    """wrench . q - R(q) for all that the normals may be; -inf where a contact without preload resists the motion.

    Args:
        motion, wrench: about the scale's reference, in its length.  spared: an element that may resist as it likes.
    """
    length, plane, d = forces.scale.length, len(forces.scale.reference), len(motion)
    about = np.concatenate([motion[:plane], motion[plane:] / length])
    allowed = WITNESS * float(np.linalg.norm(motion))
    taken: dict[str, float] = {}
    for (index, normal), head, start in zip(forces.owners, forces.cones.heads, forces.cones.starts, strict=True):
        contact = forces.contacts[index]
        name = element_name(contact.name)
        value = most_resistance(replace(contact, point=contact.point - forces.scale.reference), normal, about)
        shares = forces.cones.maps[d : len(forces.given), start]
        if np.isnan(head) and not shares.any():
            if value > allowed and name != spared:
                return -np.inf
            continue
        push = -float(forces.given[d:] @ shares) if np.isnan(head) else float(head)
        taken[name] = max(taken.get(name, -np.inf), push * value)
    return float(wrench @ motion) - sum(taken.values())


def most_resistance(contact: Contact, normal: int, motion: Vector) -> float:
    """n . v + mu |[v_t; c w_n]|, and what an error e of the normal adds: e (hypot(1, mu) |v| + mu c |w|)."""
    unit, v = unit_normal(contact.normals[normal]), velocity(motion, contact.point)
    along = float(unit @ v)
    slip = float(np.linalg.norm(v - along * unit))
    if contact.torsion:
        slip = float(np.hypot(slip, contact.torsion * (unit @ motion[3:])))
    turning = contact.friction * contact.torsion * float(np.linalg.norm(motion[len(v) :]))
    error = float(np.hypot(1.0, contact.friction) * np.linalg.norm(v)) + turning
    return along + contact.friction * slip + contact.provenance.normal_error * error


def _absorbs(forces: ContactForces, x: Weights) -> bool:
    """Whether balancing forces have room for whatever the errors of normals change about them.

    Forces N with friction mu move by at most 2 e N hypot(1, mu) each (and their moments by mu c e N); the correction
    stays inside the cones if it is shorter than 1 in the barrier's metric, with (maps P maps^T / 2)^-1 on what moved.
    """
    room = metric(forces.cones, x)
    gram = forces.cones.maps @ room @ forces.cones.maps.T
    least = float(np.linalg.eigvalsh(gram)[0])
    moved = 0.0
    for (index, _), friction, start in zip(forces.owners, forces.frictions, forces.cones.starts, strict=True):
        contact = forces.contacts[index]
        lever = float(np.linalg.norm(contact.point - forces.scale.reference)) / forces.scale.length
        reach = np.hypot(1.0, friction) * np.hypot(1.0, lever) + friction * contact.torsion / forces.scale.length
        moved += 2 * contact.provenance.normal_error * float(x[start] * reach)
    return moved == 0.0 or (least > 0 and 2 * moved**2 < least)
