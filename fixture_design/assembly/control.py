"""What a controller needs in a contact state: the contacts, and the sets of hybrid position/force control (2.6 (d))."""

from __future__ import annotations

from itertools import product

import numpy as np

from fixture_design.analysis.hybrid_control import HybridControl, hybrid_control
from fixture_design.arrays import ArrayLike, Vector
from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.planar import PlanarGeometry
from fixture_design.cones import ConeUnion, PolyhedralConvexCone
from fixture_design.contacts import Contact, face_vectors
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.errors import AssemblyError, UnsupportedError
from fixture_design.tolerances import TOUCHING


def contacts_at(assembly: Assembly, configuration: ArrayLike) -> tuple[Contact, ...]:
    """The contacts of a planar configuration, points from the moving body's origin, fixed axes (3-34).

    Every pair that touches counts, whether it is named or not. An apex within a facet has the part's outward normal;
    two apices in one point are one contact, with the clauses of their wedges (an OR where both are convex).

    Raises:
        UnsupportedError: an assembly in space.
        AssemblyError: the parts overlap there.
    """
    if assembly.space != "planar":
        raise UnsupportedError("contacts of states are for planar assemblies so far", source=assembly.source)
    return planar_contacts(PlanarGeometry.of(assembly), np.asarray(configuration, dtype=np.float64))


def planar_contacts(geometry: PlanarGeometry, configuration: Vector) -> tuple[Contact, ...]:
    """As `contacts_at`, for a geometry that is there already.

    Raises:
        AssemblyError: the parts overlap there.
    """
    q = configuration[None]
    near = TOUCHING * geometry.size
    if geometry.overlap(q)[0] > near:
        raise AssemblyError("the parts overlap at this configuration", found=f"{q[0].tolist()}")
    everything = geometry.equations(q, np.arange(len(geometry.names))[None])
    touching = everything.distances[0] <= near
    contacts, together = _apices_together(geometry, q[0], near)
    arms = geometry.pairs.arms(q)[0]
    for k in np.flatnonzero(touching):
        if not any(np.linalg.norm(arms[k] - point) <= near for point in together):
            normal = everything.face_vectors[0, k, :2]
            contacts.append(Contact.on_facet(geometry.names[k], "locator", arms[k], normal))
    return tuple(contacts)


def state_control(assembly: Assembly, configuration: ArrayLike) -> HybridControl:
    """Position- and force-controlled sets at a configuration: A, F and their subspaces, about the moving body's origin.

    Raises: as `contacts_at`.
    """
    clauses = [
        (contact.point, clause) for contact in contacts_at(assembly, configuration) for clause in contact.clauses
    ]
    cones = []
    for choice in product(*(clause for _, clause in clauses)):
        points = np.array([point for point, _ in clauses]).reshape(-1, 2)
        rows = face_vectors(points, np.array(choice).reshape(-1, 2))
        cones.append(PolyhedralConvexCone.from_faces(rows, dimension=3))
    return hybrid_control(ConeUnion.of(cones))


def _apices_together(geometry: PlanarGeometry, q: np.ndarray, near: float) -> tuple[list[Contact], list[np.ndarray]]:
    """One contact for each two apices in one point, and where these are."""
    c, s = np.cos(q[2]), np.sin(q[2])
    R = np.array([[c, -s], [s, c]])
    moving, fixed = geometry.moving, geometry.fixed
    contacts, points = [], []
    for i, apex in enumerate(moving.starts @ R.T):
        for j in np.flatnonzero(np.linalg.norm(fixed.starts - q[:2] - apex, axis=1) <= near).tolist():
            mine = _wedge(moving.normals[[_before(moving.polygons, i), i]] @ R.T, bool(moving.convex[i]))
            theirs = _wedge(fixed.normals[[_before(fixed.polygons, j), j]], bool(fixed.convex[j]))
            clauses = polyhedral_clauses(mine, theirs)
            points.append(apex)
            if clauses:
                names = moving.apex_names[i] or f"vertex {i}", fixed.apex_names[j] or f"vertex {j}"
                contacts.append(Contact(" - ".join(names), "locator", apex, clauses))
    return contacts, points


def _before(polygons: tuple[np.ndarray, ...], row: int) -> int:
    """The row of the facet that ends at an apex."""
    start = 0
    for polygon in polygons:
        if row < start + len(polygon):
            return start + (row - start - 1) % len(polygon)
        start += len(polygon)
    raise AssertionError(f"no vertex {row}")


def _wedge(normals: np.ndarray, convex: bool) -> list[list[np.ndarray]]:
    """The tangent cone at an apex as convex pieces: one, or for a reflex apex two with a cut between."""
    before, after = normals
    if convex:
        return [[before, after]]
    cut = np.array([-(before + after)[1], (before + after)[0]])
    return [[before, cut], [after, -cut]]
