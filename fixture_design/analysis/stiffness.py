"""Reactions of elastic contacts: where every contact's stiffness is known, they settle what friction leaves open.

Every contact is a spring of stiffness k along its normals, and across them if it has friction; the fixture is rigid
otherwise. Under a wrench w the part moves by q with K q = w, K = sum k B^T B, and a contact pushes it with -k B q. It
is the linear model: nothing lifts or slips, so that a contact may be said to pull; clamps push with their preloads.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.analysis.contact_forces import tangents_of, wrench_scaled
from fixture_design.arrays import Points, Rows, Vector
from fixture_design.contacts import Contact, cross, scale_of, unit_normal
from fixture_design.layout import ContactForce, element_name
from fixture_design.tolerances import Tolerances


def elastic_reactions(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    stiffness: Mapping[str, float],
    wrench: Vector,
    tolerances: Tolerances,
) -> dict[str, ContactForce] | None:
    """The force of each contact on the part under a wrench [N, N m] about W's origin, which preloads add to.

    Args:
        preloads: of elements that push with a given force [N], shared evenly by the normals of their contacts.
        stiffness: of elements [N/m].

    Returns:
        None where a contact without preload has no stiffness, a contact has alternatives, or the part is not held.
    """
    if any(len(clause) > 1 for contact in contacts for clause in contact.clauses):
        return None
    if any(element_name(c.name) not in {*stiffness, *preloads} for c in contacts):
        return None
    scale = scale_of(contacts)
    pushes = _pushes(contacts, preloads)
    springs = [_directions(c, pushed=c.name in pushes) for c in contacts]
    rows = [_rows((c.point - scale.reference) / scale.length, d) for c, d in zip(contacts, springs, strict=True)]
    values = [stiffness.get(element_name(c.name), 0.0) for c in contacts]
    total = wrench_scaled(wrench, scale)
    for contact in contacts:
        for push, normal in zip(pushes.get(contact.name, ()), contact.normals, strict=False):
            total -= push * _rows((contact.point - scale.reference) / scale.length, unit_normal(normal)[None])[0]
    largest = max(values)
    matrix = sum((k / largest * B.T @ B for k, B in zip(values, rows, strict=True)), np.zeros((len(total),) * 2))
    sizes = np.linalg.eigvalsh(matrix)
    if sizes[0] <= tolerances.near * sizes[-1]:
        return None
    motion = np.linalg.solve(matrix, total) / largest
    return {
        contact.name: _force(contact, -k * (B @ motion), directions, pushes.get(contact.name))
        for contact, k, B, directions in zip(contacts, values, rows, springs, strict=True)
    }


def _pushes(contacts: Sequence[Contact], preloads: Mapping[str, float]) -> dict[str, list[float]]:
    """For each contact of an element with a preload what it pushes with along each normal."""
    found: dict[str, list[float]] = {}
    for name, preload in preloads.items():
        members = [contact for contact in contacts if element_name(contact.name) == name]
        count = sum(len(contact.normals) for contact in members)
        found |= {contact.name: [preload / count] * len(contact.normals) for contact in members}
    return found


def _directions(contact: Contact, *, pushed: bool) -> Points:
    """The normals (not of clamps that push with a given force), then with friction the tangents of the first."""
    units = np.array([unit_normal(normal) for normal in contact.normals])
    across = tangents_of(units[0]) if contact.friction else units[:0]
    return np.vstack([units[:0] if pushed else units, across])


def _rows(lever: np.ndarray, directions: Points) -> Rows:
    return np.hstack([directions, cross(np.broadcast_to(lever, directions.shape), directions)])


def _force(contact: Contact, spring: np.ndarray, directions: Points, pushes: Sequence[float] | None) -> ContactForce:
    """The force of each normal; what acts across goes with the first."""
    units = np.array([unit_normal(normal) for normal in contact.normals])
    forces = np.zeros_like(units)
    count = 0 if pushes is not None else len(units)
    forces += -np.array(pushes)[:, None] * units if pushes is not None else spring[:count, None] * units
    forces[0] += spring[count:] @ directions[count:]
    return ContactForce(forces, np.zeros(len(units)))
