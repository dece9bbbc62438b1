"""The sets themselves: admissible displacements A (2-9) and admissible forces F = A* (2-56, Table 3), about W's origin.

A_n = face{h_n1..h_nM} with one cone a branch; F is the polar of their union, which is that of their convex sum (2-58).
Cones are converted in scaled coordinates and mapped back, so that offsets and units do not matter.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from fixture_design.analysis.restraint import Restraint
from fixture_design.arrays import Rows
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, bidirectional, convert, convert_both, union_dual
from fixture_design.contacts import Scale, motion_about_origin
from fixture_design.tolerances import DEFAULT

#: Unions of more cones than this are not listed.
MAX_CONES = 64


def admissible_displacements(restraint: Restraint) -> ConeUnion | None:
    """A as the union of one cone a branch, with both forms, in the restraint's scaled coordinates.

    Returns:
        None if there are more than MAX_CONES branches; `form_closure` and its kin need no list.

    Raises:
        ConeError: a cone has too many span vectors.
    """
    constraints = restraint.constraints
    if constraints.branch_count > MAX_CONES:
        return None
    alternatives = [constraints.alternatives_of(clause).tolist() for clause in range(len(constraints.contact))]
    dimension = constraints.rows.shape[1]
    branches = (constraints.rows[constraints.rows_of(choice)] for choice in product(*alternatives))
    return ConeUnion.of(
        convert(PolyhedralConvexCone.from_faces(rows, dimension=dimension), restraint.tolerances) for rows in branches
    )


def admissible_forces(displacements: ConeUnion) -> PolyhedralConvexCone:
    """F, the polar of the union (Table 3), both forms irreducible: loads that frictionless contacts can balance."""
    return convert_both(union_dual(displacements))


def bidirectional_contacts(restraint: Restraint) -> tuple[str, ...]:
    """Names of the contacts that constrain both ways (BIDIRECTION, 2.8.3), among those without alternatives."""
    constraints = restraint.constraints
    single = [int(a[0]) for c in range(len(constraints.contact)) if len(a := constraints.alternatives_of(c)) == 1]
    rows = constraints.rows_of(single)
    cone = PolyhedralConvexCone.from_faces(constraints.rows[rows], dimension=constraints.rows.shape[1])
    owners = constraints.contact[constraints.clause[constraints.alternative[rows]]]
    names = {restraint.contacts[owner].name for owner in owners[bidirectional(cone, restraint.tolerances)]}
    return tuple(contact.name for contact in restraint.contacts if contact.name in names)


def displacements_in_world(cone: PolyhedralConvexCone, scale: Scale) -> PolyhedralConvexCone:
    """A cone of scaled motions as one of displacements [dx; dtheta] about W's origin [m, rad]."""
    return _mapped(cone, _twist_matrix(scale), _wrench_matrix(scale))


def forces_in_world(cone: PolyhedralConvexCone, scale: Scale) -> PolyhedralConvexCone:
    """A cone of scaled wrenches as one of wrenches [f; m] about W's origin [N, N m]."""
    return _mapped(cone, _wrench_matrix(scale), _twist_matrix(scale))


def _mapped(cone: PolyhedralConvexCone, primal: Rows, polar: Rows) -> PolyhedralConvexCone:
    faces = PolyhedralConvexCone.from_faces(
        _tidy(cone.faces @ polar.T), _tidy(cone.equalities @ polar.T), dimension=cone.dimension
    )
    spans = PolyhedralConvexCone.from_span(
        _tidy(cone.spans @ primal.T), _tidy(cone.lines @ primal.T), dimension=cone.dimension
    )
    return PolyhedralConvexCone(cone.dimension, faces.face_form, spans.span_form, cone.certain)


def _twist_matrix(scale: Scale) -> Rows:
    """Scaled motion to displacement about W's origin."""
    dimension = 3 if len(scale.reference) == 2 else 6
    return np.column_stack([motion_about_origin(unit, scale.reference, scale.length) for unit in np.eye(dimension)])


def _wrench_matrix(scale: Scale) -> Rows:
    """Scaled wrench to wrench about W's origin: the transposed inverse, so that products stay."""
    return np.linalg.inv(_twist_matrix(scale)).T


def _tidy(rows: Rows) -> Rows:
    """Largest component 1, and components that are only rounding zero: the figures of the thesis, readable."""
    if not len(rows):
        return rows
    largest = np.abs(rows).max(axis=1, keepdims=True)
    scaled = rows / np.where(largest > 0, largest, 1.0)
    return np.where(np.abs(scaled) < DEFAULT.zero, 0.0, scaled)
