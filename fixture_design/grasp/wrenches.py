"""The pushes of a grasp's contacts as wrenches on the part, edge after edge of their friction cones.

An edge with the outward normal part 1 pushes the part with -1 N along the normal: row = [f; (x - reference) X f + m],
f = -(n + mu t), m of a soft tip -(mu c n). All alternatives of a contact with ORs are left out: which of them pushes
depends on the way the part takes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point
from fixture_design.contacts import Contact, contact_edges
from fixture_design.layout import element_name

#: Edges of the pyramids inside the friction cones [-]; what is reckoned with them is a little on the safe side.
EDGES = 8


@dataclass(frozen=True, eq=False)
class Pushes:
    """The pushes of all contacts, m edges in all.

    Attributes:
        wrenches: shape (m, 6), on the part, moments about ``reference``, of pushes of 1 N along the normal.
        forces: shape (m, 3), and moments, shape (m, 3): the same at the contact's point.
        points: shape (m, 3), where, in W.
        owners: names of the elements or contacts they belong to.
        contacts: number of the contact of each.
        reference: in W [m].
    """

    wrenches: Float[np.ndarray, "m 6"]
    forces: Float[np.ndarray, "m 3"]
    moments: Float[np.ndarray, "m 3"]
    points: Float[np.ndarray, "m 3"]
    owners: tuple[str, ...]
    contacts: tuple[int, ...]
    reference: Point


def pushes_of(contacts: Sequence[Contact], reference: Point, edges: int = EDGES) -> Pushes:
    """The pushes of some contacts in space."""
    forces, moments, points = np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3))
    owners: list[str] = []
    numbers: list[int] = []
    for number, contact in enumerate(contacts):
        for normal in [clause[0] for clause in contact.clauses if len(clause) == 1]:
            f, m = contact_edges(normal, contact.friction, contact.torsion, edges)
            forces, moments = np.vstack([forces, -f]), np.vstack([moments, -m])
            points = np.vstack([points, np.tile(contact.point, (len(f), 1))])
            owners += [element_name(contact.name)] * len(f)
            numbers += [number] * len(f)
    wrenches = np.hstack([forces, np.cross(points - reference, forces) + moments])
    return Pushes(wrenches, forces, moments, points, tuple(owners), tuple(numbers), reference)
