"""The contacts of a configuration in space, with the normals that a controller works with."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.assembly import rotations
from fixture_design.assembly.contact_geometry import require_no_overlap
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.contacts import Contact
from fixture_design.contacts.contact import Clause
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


def spatial_contacts(geometry: SpatialGeometry, configuration: Vector) -> tuple[Contact, ...]:
    """The contacts of a configuration, points from the moving body's origin, fixed axes.

    An apex within a facet, and an edge across an edge within both, have the one normal of their pair. Where an apex is
    on a rim, or a crossing at an end, all pairs in one point are one contact, with the clauses of the tangent cones of
    both bodies there.

    Raises:
        AssemblyError: the parts overlap there.
    """
    q = configuration[None]
    near = TOUCHING * geometry.size
    require_no_overlap(geometry, q, near)
    touching = np.flatnonzero(geometry.distances(q)[0] <= near)
    if not touching.size:
        return ()
    found = geometry.equations(q, touching[None]).face_vectors[0, :, :3]
    arms = geometry.arms(q, touching[None])[0]
    at_ends = geometry.at_apices(q, near)[0, touching]
    contacts, done = [], set()
    for pair, arm, normal in zip(touching, arms, found, strict=True):
        ends = np.flatnonzero(np.linalg.norm(arms[at_ends] - arm, axis=1) <= near)
        if not ends.size:
            contacts.append(Contact.on_facet(geometry.names[pair], "locator", arm, normal))
        elif not done & set(ends.tolist()):
            done.update(ends.tolist())
            point = arms[at_ends][ends[0]]
            clauses = tangent_clauses(geometry, q, point, near)
            if clauses is None:
                raise AssemblyError("the parts overlap at this configuration", found=f"{q[0].tolist()}")
            if clauses:
                contacts.append(Contact(geometry.names[pair], "locator", point, clauses))
    return tuple(contacts)


def tangent_clauses(
    geometry: SpatialGeometry, q: np.ndarray, arm: np.ndarray, near: float
) -> tuple[Clause, ...] | None:
    """The clauses of both bodies' tangent cones in one point, from the moving body's origin; None if they overlap."""
    R, position = rotations.matrices(q[:, 3:])[0], q[0, :3]
    mine = [piece @ R.T for piece in _cones(geometry.moving.pieces, arm @ R, near)]
    theirs = [piece for body in geometry.fixed for piece in _cones(body.pieces, position + arm, near)]
    return polyhedral_clauses([list(piece) for piece in mine], [list(piece) for piece in theirs])


def _cones(pieces: tuple[Polytope, ...], point: np.ndarray, near: float) -> list[np.ndarray]:
    """The tangent cones at a point of the pieces that have it, each by its outward normals."""
    heights = [piece.normals @ point - piece.offsets for piece in pieces]
    return [
        piece.normals[np.abs(height) <= near]
        for piece, height in zip(pieces, heights, strict=True)
        if height.max() <= near
    ]
