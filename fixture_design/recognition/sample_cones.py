"""F(q) and A(q) at samples of a state (4-9), (4-12), as arrays: contact pairs, friction, weight, axes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, Rows, Vector
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.control import planar_contacts
from fixture_design.assembly.planar import PlanarGeometry
from fixture_design.cones import PolyhedralConvexCone, convert, intersect
from fixture_design.contacts import Contact, cross, face_vectors, friction_edges
from fixture_design.recognition.signals import Signals


@dataclass(frozen=True, eq=False)
class Physics:
    """What the cones depend on besides the geometry.

    Attributes:
        friction: mu of every contact.
        edges: of the friction pyramids in space; they lie around the cones, so that no force is left out.
        force: of the weight in fixed axes, shape (p,) [N]; zero without.
        center: of mass, in the moving body's frame, shape (p,) [m].
    """

    friction: float
    edges: int
    force: Point
    center: Point


@dataclass(frozen=True, eq=False)
class SampleCones:
    """The cones at n configurations of one state.

    Attributes:
        q: shape (n, c).
        forces: of each the span vectors of F, in the coordinates of the force block; lines as two of them.
        vectors: of each the contacts' unit normals with their moments, and the weight's wrench where one is known,
            scaled as forces are, shape (n, m, d): what `chart` calls near.
        displacements: of each the alternatives A_1, A_2, ... of A by their face vectors, in those of the displacement
            block: one, but for two convex apices in one point.
    """

    q: np.ndarray
    forces: tuple[Rows, ...]
    vectors: Float[np.ndarray, "n m d"]
    displacements: tuple[tuple[Rows, ...], ...]

    def __len__(self) -> int:
        return len(self.q)

    def taking(self, rows: list[int]) -> SampleCones:
        """Some of the samples."""
        forces = tuple(self.forces[k] for k in rows)
        return SampleCones(self.q[rows], forces, self.vectors[rows], tuple(self.displacements[k] for k in rows))

    def __add__(self, other: SampleCones) -> SampleCones:
        return SampleCones(
            np.concatenate([self.q, other.q]),
            self.forces + other.forces,
            np.concatenate([self.vectors, other.vectors]),
            self.displacements + other.displacements,
        )


def sample_cones(
    geometry: ContactGeometry, contacts: tuple[str, ...], q: np.ndarray, apart: bool, signals: Signals, physics: Physics
) -> SampleCones:
    """The cones of some contacts at configurations where they hold.

    Args:
        contacts: names of contact pairs.  apart: False if two apices are in one point. In the plane the contact is then
            that of the two wedges, where two convex apices leave an OR, and F = (A_1 u A_2)* balances what either
            alternative balances; in space all pairs count together.
    """
    chosen = np.array([geometry.names.index(name) for name in contacts], dtype=int)[None]
    normals = geometry.equations(q, chosen).face_vectors[..., : signals.plane]
    pairs = list(zip(geometry.arms(q, chosen), normals, strict=True))
    wedges = geometry if not apart and isinstance(geometry, PlanarGeometry) else None
    forces, vectors, displacements = [], [], []
    for row, R, (points, outward) in zip(q, geometry.rotations(q), pairs, strict=True):
        branches = [(points, outward)] if wedges is None else _branches(planar_contacts(wedges, row))
        turn = np.eye(signals.wrench_size) if signals.axes == "fixed" else _turning(R)
        spans = _common([_force_spans(*branch, physics) @ turn for branch in branches], signals.wrench_size)
        weight = _weight(R, physics)[None] @ turn if signals.weight else np.zeros((0, signals.wrench_size))
        forces.append(np.vstack([signals.force_rows(spans), *(signals.weight_row(some)[None] for some in weight)]))
        vectors.append(np.vstack([face_vectors(points, outward) @ turn, weight]) * signals.wrench_scale)
        displacements.append(tuple(face_vectors(*branch) @ turn / signals.twist_scale for branch in branches))
    shape = (len(q), len(contacts) + (signals.weight > 0), signals.wrench_size)
    return SampleCones(q, tuple(forces), np.array(vectors).reshape(shape), tuple(displacements))


def _turning(R: np.ndarray) -> np.ndarray:
    """Rows times this are in the part's axes; a planar moment stays."""
    plane = len(R)
    turn = np.eye(3 * (plane - 1))
    turn[:plane, :plane] = R
    if plane == 3:
        turn[3:, 3:] = R
    return turn


def _branches(contacts: tuple[Contact, ...]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points and normals of every choice of alternatives."""
    clauses = [(contact.point, clause) for contact in contacts for clause in contact.clauses]
    points = np.array([point for point, _ in clauses]).reshape(-1, 2)
    return [(points, np.array(choice).reshape(-1, 2)) for choice in product(*(clause for _, clause in clauses))]


def _force_spans(points: np.ndarray, normals: np.ndarray, physics: Physics) -> Rows:
    """Wrenches that contacts balance: d, or those of the edges of friction cones (2-79), (2-80)."""
    if not len(points) or not physics.friction:
        return face_vectors(points, normals)
    edges = [friction_edges(normal, physics.friction, physics.edges, "outer") for normal in normals]
    return face_vectors(np.repeat(points, [len(some) for some in edges], axis=0), np.concatenate(edges))


def _common(spans: list[Rows], dimension: int) -> Rows:
    """What all branches balance: F = (A_1 u A_2 u ...)* (2-37), with friction likewise."""
    if len(spans) == 1:
        return spans[0]
    cones = [convert(PolyhedralConvexCone.from_span(rows, dimension=dimension)) for rows in spans]
    both = convert(intersect(*cones))
    return np.vstack([both.spans, both.lines, -both.lines])


def _weight(R: np.ndarray, physics: Physics) -> Vector:
    """The weight's wrench in fixed axes."""
    arm = R @ physics.center
    return np.concatenate([physics.force, cross(arm[None], physics.force[None])[0]])
