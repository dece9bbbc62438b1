"""Contacts as unidirectional constraints (thesis 2.2): points, normals with their logic, face vectors, friction."""

from fixture_design.contacts.constraints import Constraints, Scale, constraints_of, scale_of
from fixture_design.contacts.contact import (
    OPENED,
    ROLES,
    STANDING,
    Clause,
    Contact,
    Provenance,
    Role,
    matching,
    unit_normal,
)
from fixture_design.contacts.friction import (
    Side,
    edges_around,
    first_tangents,
    friction_edges,
    tangents,
    tangents_towards,
)
from fixture_design.contacts.limit_surface import contact_edges, limit_directions, torsion_of_patch
from fixture_design.contacts.wrench import (
    cross,
    face_vectors,
    motion_about_origin,
    motion_scaled,
    scaled_rows,
    velocity,
)

__all__ = [
    "OPENED",
    "ROLES",
    "STANDING",
    "Clause",
    "Constraints",
    "Contact",
    "Provenance",
    "Role",
    "Scale",
    "Side",
    "constraints_of",
    "contact_edges",
    "cross",
    "edges_around",
    "face_vectors",
    "first_tangents",
    "friction_edges",
    "limit_directions",
    "matching",
    "motion_about_origin",
    "motion_scaled",
    "scale_of",
    "scaled_rows",
    "tangents",
    "tangents_towards",
    "torsion_of_patch",
    "unit_normal",
    "velocity",
]
