"""The unidirectional constraints of a set of contacts, as arrays: rows, their alternatives, their clauses.

A row is a face vector [n; (x - reference) X n / length] with |n| = 1: dimensionless, and the same however the layout is
placed or what its unit is. Rows belong to alternatives (a normal has one row; with friction, one for each edge of its
cone), alternatives to clauses (the OR), clauses to contacts (the AND). A *branch* picks one alternative a clause;
A = A_1 u ... u A_N has one cone a branch (2-9). The arrays are flat, so that many layouts go into one batch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Indices, Point, Points, Rows, Weights
from fixture_design.contacts.contact import Contact
from fixture_design.contacts.friction import Side, first_tangents
from fixture_design.contacts.limit_surface import contact_edges
from fixture_design.contacts.wrench import scaled_rows
from fixture_design.errors import ContactError, DimensionError
from fixture_design.tolerances import COINCIDENT


@dataclass(frozen=True)
class Scale:
    """What makes rows dimensionless.

    Attributes:
        reference: the point moments are taken about, shape (p,) [m].
        length: what moments are divided by [m].
        offset: distance of the reference from the origin of the coordinates, as a multiple of the length [-].
    """

    reference: Point
    length: float

    @property
    def offset(self) -> float:
        return float(np.linalg.norm(self.reference)) / self.length


@dataclass(frozen=True, eq=False)
class Constraints:
    """Rows and their logic; see the module's docstring.

    Attributes:
        rows: shape (r, d).
        errors: shape (r,), largest change of each row that the normal's error allows.
        alternative: shape (r,), the alternative of each row, non-decreasing from 0.
        clause: shape (a,), the clause of each alternative, non-decreasing from 0.
        contact: shape (c,), the contact (its place in the sequence given) of each clause.
        scale: reference point and length of the rows.
    """

    rows: Rows
    errors: Weights
    alternative: Indices
    clause: Indices
    contact: Indices
    scale: Scale

    @property
    def branch_count(self) -> int:
        """N of (2-9): the product of the numbers of alternatives. A Python integer: it may be astronomical."""
        count = 1
        for number in np.bincount(self.clause, minlength=len(self.contact)).tolist():
            count *= number
        return count

    def without_errors(self) -> Constraints:
        """The same with the normals as they are given."""
        return replace(self, errors=np.zeros(len(self.rows)))

    def clause_values(self, products: Weights) -> Weights:
        """For each clause the min over its alternatives of the max over their rows of ``products`` (one a row).

        With products d . u it tells which clauses a motion u violates: those with a positive value.
        """
        by_alternative = np.full(len(self.clause), -np.inf)
        np.maximum.at(by_alternative, self.alternative, products)
        by_clause = np.full(len(self.contact), np.inf)
        np.minimum.at(by_clause, self.clause, by_alternative)
        return by_clause

    def alternatives_of(self, clause: int) -> Indices:
        """The alternatives of one clause."""
        return np.flatnonzero(self.clause == clause)

    def rows_of(self, alternatives: Sequence[int] | Indices) -> Indices:
        """The rows of some alternatives, in order."""
        return np.flatnonzero(np.isin(self.alternative, np.asarray(alternatives, dtype=np.int64)))


def scale_of(contacts: Sequence[Contact]) -> Scale:
    """Centroid of the contact points and their root-mean-square distance from it; 1 m if they all coincide."""
    points = np.array([contact.point for contact in contacts])
    reference = points.mean(axis=0)
    length = float(np.sqrt(np.mean(np.sum((points - reference) ** 2, axis=1))))
    # points that coincide up to rounding have no lever: any length serves, since all their moments vanish
    if length <= COINCIDENT * float(np.abs(points).max(initial=0.0)):
        length = max(1.0, float(np.abs(reference).max(initial=0.0)))
    return Scale(reference, length)


def constraints_of(
    contacts: Sequence[Contact],
    scale: Scale | None = None,
    *,
    with_friction: bool = False,
    edges: int = 8,
    side: Side = "inner",
    tangents: Sequence[Points] | None = None,
) -> Constraints:
    """The constraints of some contacts.

    Args:
        contacts: at least one, all planar or all spatial.
        scale: reference and length; by default `scale_of` the contacts.
        with_friction: rows for the edges of the friction cones instead of the normals.
        edges, side: of the friction cones in space, see `contact_edges`.
        tangents: of their first edges, for each contact one a normal; by default `first_tangents` towards the centroid.

    Raises:
        ContactError: no contacts.  DimensionError: planar and spatial contacts mixed.
    """
    if not contacts:
        raise ContactError("there are no contacts")
    if len({contact.dimension for contact in contacts}) != 1:
        raise DimensionError("planar and spatial contacts cannot be mixed")
    scale = scale or scale_of(contacts)
    if tangents is None and with_friction and len(scale.reference) == 3:
        tangents = first_tangents(contacts, scale_of(contacts).reference)
    normals, points, moments, errors = [], [], [], []
    alternative, clause_of, contact_of = [], [], []
    for index, contact in enumerate(contacts):
        lever = contact.point - scale.reference
        # a normal off by e moves its row by at most e times the norm of [t; x X t / length] for unit t
        error = contact.provenance.normal_error * float(np.hypot(1.0, np.linalg.norm(lever) / scale.length))
        firsts = iter(tangents[index] if tangents is not None else [None] * len(contact.normals))
        for clause in contact.clauses:
            for normal in clause:
                friction = contact.friction if with_friction else 0.0
                rays, spins = contact_edges(normal, friction, contact.torsion, edges, side, next(firsts))
                normals.append(rays)
                moments.append(spins)
                points.append(np.broadcast_to(lever, rays.shape))
                spin_error = contact.provenance.normal_error * friction * contact.torsion / scale.length
                errors += [error * float(np.hypot(1.0, friction)) + spin_error] * len(rays)
                alternative += [len(clause_of)] * len(rays)
                clause_of.append(len(contact_of))
            contact_of.append(index)
    return Constraints(
        scaled_rows(np.vstack(points), np.vstack(normals), scale.length, np.vstack(moments)),
        np.array(errors),
        np.array(alternative, dtype=np.int64),
        np.array(clause_of, dtype=np.int64),
        np.array(contact_of, dtype=np.int64),
        scale,
    )
