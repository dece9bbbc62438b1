"""What a controller needs in a contact state: the contacts, and the sets of hybrid position/force control (2.6 (d))."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import prod

import numpy as np

from fixture_design.analysis.hybrid_control import HybridControl, hybrid_control
from fixture_design.arrays import ArrayLike, Points, Vector
from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.contact_geometry import ContactGeometry, require_no_overlap
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.planar import PlanarGeometry
from fixture_design.assembly.round_contacts import round_contacts
from fixture_design.assembly.round_space import RoundGeometry
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.assembly.spatial_contacts import spatial_contacts
from fixture_design.cones import ConeUnion, PolyhedralConvexCone
from fixture_design.contacts import Contact, face_vectors
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.errors import AssemblyError, UnsupportedError
from fixture_design.tolerances import TOUCHING

#: More combinations of alternatives than this are not listed.
MOST_CHOICES = 1024


def contacts_at(assembly: Assembly, configuration: ArrayLike) -> tuple[Contact, ...]:
    """The contacts of a configuration, points from the moving body's origin, fixed axes (3-34).

    Every pair that touches counts, whether it is named or not. An apex within a facet has the part's outward normal;
    apices in one point are one contact, with the clauses of their tangent cones (an OR where both are convex), and so
    are in space apices on edges, and edges that end on each other.

    Raises:
        AssemblyError: the parts overlap there; not as many numbers as a configuration has.
        UnsupportedError: as `state_graph`.
    """
    return contacts_of(geometry_of(assembly), configuration)


def contacts_of(geometry: ContactGeometry, configuration: ArrayLike) -> tuple[Contact, ...]:
    """As `contacts_at`, for a geometry that is there already.

    Raises:
        AssemblyError: the parts overlap there; not as many numbers as a configuration has.
    """
    q = np.asarray(configuration, dtype=np.float64)
    numbers = 3 if geometry.dimension == 3 else 7
    if q.shape != (numbers,) or not np.isfinite(q).all():
        raise AssemblyError(f"a configuration is {numbers} finite numbers", found=f"{q.tolist()}"[:60])
    if isinstance(geometry, PlanarGeometry):
        return planar_contacts(geometry, q)
    if isinstance(geometry, RoundGeometry):
        return round_contacts(geometry, q)
    assert isinstance(geometry, SpatialGeometry)
    return spatial_contacts(geometry, q)


def planar_contacts(geometry: PlanarGeometry, configuration: Vector) -> tuple[Contact, ...]:
    """As `contacts_at`, for a geometry that is there already.

    Raises:
        AssemblyError: the parts overlap there.
    """
    q = configuration[None]
    near = TOUCHING * geometry.size
    require_no_overlap(geometry, q, near)
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

    Raises:
        UnsupportedError: more than `MOST_CHOICES` combinations of alternatives; else as `contacts_at`.
    """
    return control_of(geometry_of(assembly), configuration)


def control_of(geometry: ContactGeometry, configuration: ArrayLike) -> HybridControl:
    """As `state_control`, for a geometry that is there already.

    Raises: as `state_control`.
    """
    choices = choices_of(contacts_of(geometry, configuration), 2 if geometry.dimension == 3 else 3)
    faces = (face_vectors(*choice) if len(choice[0]) else np.zeros((0, geometry.dimension)) for choice in choices)
    cones = [PolyhedralConvexCone.from_faces(rows, dimension=geometry.dimension) for rows in faces]
    return hybrid_control(ConeUnion.of(cones))


def choices_of(contacts: Sequence[Contact], plane: int) -> list[tuple[Points, Points]]:
    """Points and normals, shape (n, plane), of every choice of one alternative in each clause: a cone of A each.

    Raises:
        UnsupportedError: they are more than `MOST_CHOICES`.
    """
    clauses = [(contact.point, clause) for contact in contacts for clause in contact.clauses]
    choices = prod(len(clause) for _, clause in clauses)
    if choices > MOST_CHOICES:
        names = ", ".join(contact.name for contact in contacts)
        problem = f"{choices} cones make the displacements that are admissible with {names}"
        raise UnsupportedError(problem, expected=f"at most {MOST_CHOICES}")
    points = np.array([point for point, _ in clauses]).reshape(-1, plane)
    return [(points, np.array(choice).reshape(-1, plane)) for choice in product(*(clause for _, clause in clauses))]


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
