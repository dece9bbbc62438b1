"""The sets themselves: admissible displacements A (2-9) and admissible forces F = A* (2-56, Table 3), about W's origin.

A_n = face{h_n1..h_nM} with one cone a branch; F is the polar of their union, which is that of their convex sum (2-58).
Cones are converted in scaled coordinates and mapped back, so that offsets and units do not matter.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from fixture_design.analysis.restraint import Restraint
from fixture_design.arrays import Rows
from fixture_design.cones import (
    ConeUnion,
    PolyhedralConvexCone,
    bidirectional,
    convert_rows,
    union_dual,
)
from fixture_design.contacts import Scale, motion_about_origin
from fixture_design.errors import ConeError
from fixture_design.tolerances import DEFAULT, Tolerances

#: Unions of more cones than this are not listed.
MAX_CONES = 64
#: Cones with more span vectors than this are not listed.
MAX_LISTED = 2000
#: Span vectors of a union beyond which the convex sum is not converted.
MAX_SUM = 600


def admissible_displacements(restraint: Restraint) -> ConeUnion:
    """A as the union of one cone a branch, with both forms, in the restraint's scaled coordinates.

    Raises:
        ConeError: more than MAX_CONES branches, or a cone with more than MAX_LISTED span vectors. `form_closure` and
            its kin need no list.
    """
    constraints = restraint.constraints
    if constraints.branch_count > MAX_CONES:
        raise ConeError(f"the union has {constraints.branch_count} cones, more than {MAX_CONES}")
    alternatives = [constraints.alternatives_of(clause).tolist() for clause in range(len(constraints.contact))]
    tolerances = restraint.tolerances.at_offset(constraints.scale.offset)
    return ConeUnion.of(
        _listed(constraints.rows[constraints.rows_of(choice)], tolerances) for choice in product(*alternatives)
    )


def _listed(rows: Rows, tolerances: Tolerances) -> PolyhedralConvexCone:
    """face{rows} with its span form, and the rows as they are for its face form."""
    dimension = rows.shape[1]
    found = convert_rows(rows, np.zeros((0, dimension)), tolerances, MAX_LISTED)
    spans = PolyhedralConvexCone.from_span(found.vectors, found.lines, dimension=dimension).span_form
    cone = PolyhedralConvexCone.from_faces(rows, dimension=dimension)
    return replace(cone, span_form=spans, certain=found.certain)


def admissible_forces(displacements: ConeUnion, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """F, the polar of the union (Table 3), both forms irreducible: loads that frictionless contacts can balance.

    The span vectors of all A_n together span the convex sum (2-34), whose polar F is (2-58). A single A is its own sum:
    F is spanned by its face vectors.

    Raises:
        ConeError: a union with more than MAX_SUM span vectors.
    """
    return union_dual(displacements, tolerances, MAX_SUM)


def bidirectional_contacts(restraint: Restraint) -> tuple[str, ...]:
    """Names of the contacts that constrain both ways (BIDIRECTION, 2.8.3), among those without alternatives."""
    constraints = restraint.constraints
    single = [int(a[0]) for c in range(len(constraints.contact)) if len(a := constraints.alternatives_of(c)) == 1]
    rows = constraints.rows_of(single)
    cone = PolyhedralConvexCone.from_faces(constraints.rows[rows], dimension=constraints.rows.shape[1])
    tolerances = restraint.tolerances.at_offset(constraints.scale.offset)
    owners = constraints.contact[constraints.clause[constraints.alternative[rows]]]
    names = {restraint.contacts[owner].name for owner in owners[bidirectional(cone, tolerances)]}
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
