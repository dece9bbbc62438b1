"""What contacts may do to the part, as arrays: for every normal a cone of forces, dimensionless.

A contact with unit normal n pushes the part with f = -N n + t and, if soft, a moment m about n, where N >= 0 and
|[t; m / c]| <= friction N. With x = [N; z], |z| <= N, this is  maps @ x:  N along [-n; -x X n / length], and z along
friction times the tangents (and friction c / length about n). A clamp with a preload has its N given; where it touches
in several places, or in a corner, these share it: sum N = preload is one more row below the wrenches.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product

import numpy as np

from fixture_design.arrays import Points, Vector, Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.contacts import Contact, Scale, cross, scale_of, tangents, unit_normal
from fixture_design.layout import ContactForce, element_name
from fixture_design.tolerances import MOST_FRICTION

#: For each clause of a branch that has alternatives: (contact, clause, alternative).
Choice = tuple[tuple[str, int, int], ...]


@dataclass(frozen=True, eq=False)
class ContactForces:
    """The cones of a branch of contacts, in one scale.

    Attributes:
        owners: for each cone (contact, normal), both as indices.  frictions: for each cone, shape (n,).
        cones: maps of shape (d + g, s), forces in units of ``unit``, moments in ``unit`` times the scale's length.
        given: shape (d + g,), what the g rows of shared preloads have besides the cones; zero in the first d.
        unit: of forces [N].
    """

    contacts: tuple[Contact, ...]
    owners: tuple[tuple[int, int], ...]
    frictions: Weights
    cones: ForceCones
    given: Weights
    scale: Scale
    unit: float = 1.0

    def in_units_of(self, unit: float) -> ContactForces:
        """The same with forces in units of ``unit`` [N]."""
        factor = self.unit / unit
        cones = replace(self.cones, heads=self.cones.heads * factor)
        return replace(self, cones=cones, given=self.given * factor, unit=unit)

    def applied(self, wrench: Vector) -> Weights:
        """A wrench about W's origin [N, N m] in the rows of the cones, without what is given."""
        scaled = wrench_scaled(wrench, self.scale) / self.unit
        return np.concatenate([scaled, np.zeros(len(self.given) - len(scaled))])

    def forces(self, x: Weights) -> dict[str, ContactForce]:
        """The forces on the part [N] of some x, shape (s,), for each contact; zero for normals that have no cone."""
        plane = len(self.scale.reference)
        found = {c.name: (np.zeros((len(c.normals), plane)), np.zeros(len(c.normals))) for c in self.contacts}
        cones = zip(self.owners, self.frictions, self.cones.blocks(), strict=True)
        for (index, normal), friction, block in cones:
            contact, part = self.contacts[index], x[block] * self.unit
            unit = unit_normal(contact.normals[normal])
            forces, moments = found[contact.name]
            across = min(len(part) - 1, plane - 1)
            forces[normal] = -part[0] * unit + friction * part[1 : 1 + across] @ tangents_of(unit)[:across]
            moments[normal] = friction * contact.torsion * part[-1] if len(part) > plane else 0.0
        return {name: ContactForce(forces, moments) for name, (forces, moments) in found.items()}


def contact_forces(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    choice: Mapping[tuple[str, int], int] | None = None,
    *,
    smooth: frozenset[str] = frozenset(),
    widened: bool = False,
    scale: Scale | None = None,
) -> ContactForces:
    """The cones of forces of some contacts.

    Args:
        preloads: of elements (`element_name` of their contacts) that push with a given force [N].
        choice: the alternative taken of clauses that have several, by (contact, clause); by default the first.
        smooth: contacts whose friction does not count.
        widened: cones for whatever the normals may be, within their errors.
    """
    scale = scale or scale_of(contacts)
    owners = [owner for owner in _owners(contacts, choice or {}) if preloads.get(_element(contacts, owner)) != 0]
    counts = Counter(_element(contacts, owner) for owner in owners)
    shared = [name for name, count in counts.items() if name in preloads and count > 1]
    frictions = [0.0 if contacts[i].name in smooth else friction_of(contacts[i], widened) for i, _ in owners]
    maps, heads = [], []
    for owner, friction in zip(owners, frictions, strict=True):
        name = _element(contacts, owner)
        columns = _columns(contacts[owner[0]], owner[1], friction, scale)
        shares = np.zeros((len(shared), columns.shape[1]))
        if name in shared:
            shares[shared.index(name), 0] = 1.0
        maps.append(np.vstack([columns, shares]))
        heads.append(preloads[name] if name in preloads and name not in shared else np.nan)
    dimension = contacts[0].dimension
    given = np.concatenate([np.zeros(dimension), [-preloads[name] for name in shared]])
    stacked = np.hstack([np.zeros((len(given), 0)), *maps])
    sizes = np.array([columns.shape[1] for columns in maps], dtype=np.int64)
    cones = ForceCones(stacked, sizes, np.array(heads, dtype=np.float64))
    return ContactForces(tuple(contacts), tuple(owners), np.array(frictions, dtype=np.float64), cones, given, scale)


def force_branches(contacts: Sequence[Contact], most: int) -> tuple[list[Choice], bool]:
    """The choices of one alternative a clause, at most so many, and whether these are all."""
    places = [
        [(c.name, k, a) for a in range(len(clause))]
        for c in contacts
        for k, clause in enumerate(c.clauses)
        if len(clause) > 1
    ]
    found = list(islice(product(*places), most + 1))
    return found[:most], len(found) <= most


def friction_of(contact: Contact, widened: bool) -> float:
    """The friction, or that of the cone that has all cones whose normals are off by up to their error e in it.

    n . v + mu |v_t| + e hypot(1, mu) |v| <= 0 wherever n . v + mu' |v_t| <= 0 with atan(mu') = atan(mu) + asin(e).
    """
    error = contact.provenance.normal_error if widened else 0.0
    if error == 0:
        return contact.friction
    angle = np.arctan(contact.friction) + np.arcsin(min(error, 1.0))
    return float(np.tan(angle)) if angle < np.arctan(MOST_FRICTION) else MOST_FRICTION


def tangents_of(unit: np.ndarray) -> Points:
    """Unit tangents of a unit normal: one in the plane, two in space."""
    return np.array([[-unit[1], unit[0]]]) if len(unit) == 2 else np.array(tangents(unit))


def wrench_scaled(wrench: Vector, scale: Scale) -> Vector:
    """A wrench [f; m] about W's origin, about the reference, its moment over the length."""
    plane = len(scale.reference)
    force = wrench[:plane]
    moment = wrench[plane:] - cross(scale.reference[None], force[None])[0]
    return np.concatenate([force, moment / scale.length])


def _element(contacts: Sequence[Contact], owner: tuple[int, int]) -> str:
    return element_name(contacts[owner[0]].name)


def _owners(contacts: Sequence[Contact], choice: Mapping[tuple[str, int], int]) -> list[tuple[int, int]]:
    owners = []
    for index, contact in enumerate(contacts):
        first = 0
        for number, clause in enumerate(contact.clauses):
            owners.append((index, first + choice.get((contact.name, number), 0)))
            first += len(clause)
    return owners


def _columns(contact: Contact, normal: int, friction: float, scale: Scale) -> np.ndarray:
    """Columns of one cone, shape (d, k)."""
    unit = unit_normal(contact.normals[normal])
    directions = np.vstack([-unit, friction * tangents_of(unit)]) if friction else -unit[None]
    lever = np.broadcast_to((contact.point - scale.reference) / scale.length, directions.shape)
    columns = np.hstack([directions, cross(lever, directions)]).T
    if friction and contact.torsion:
        spin = np.concatenate([np.zeros(3), friction * contact.torsion / scale.length * unit])
        columns = np.column_stack([columns, spin])
    return columns
