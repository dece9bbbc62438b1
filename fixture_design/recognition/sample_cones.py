"""F(q) and A(q) at samples of a state (4-9), (4-12), as arrays: contact pairs, friction, weight, axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, Rows
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.control import choices_of, contacts_of
from fixture_design.assembly.round_space import RoundGeometry
from fixture_design.cones import PolyhedralConvexCone, convert, intersect
from fixture_design.contacts import cross, face_vectors, friction_edges
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
        forces: of each the unit span vectors of F, shape (k, d), or (k, d + 1) with a weight, in the coordinates of the
            force block; lines as two of them.
        vectors: of each the contacts' unit normals with their moments, and the weight's wrench where one is known,
            scaled as forces are, shape (n, m, d): what `chart` calls near.
        displacements: of each the alternatives A_1, A_2, ... of A by their unit face vectors, in the coordinates of the
            displacement block: one, but where convex apices or edges are in one point.
    """

    q: np.ndarray
    forces: tuple[np.ndarray, ...]
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
    arms, R = geometry.arms(q, chosen), geometry.rotations(q)
    turns = np.eye(signals.wrench_size)[None].repeat(len(q), axis=0) if signals.axes == "fixed" else _turnings(R)
    weights = _weights(R, physics, turns) if signals.weight else None
    rows = _wrenches(arms, normals) @ turns
    vectors = (rows if weights is None else np.concatenate([rows, weights[:, None]], axis=1)) * signals.wrench_scale
    if not apart and not isinstance(geometry, RoundGeometry):
        branches = [choices_of(contacts_of(geometry, row), signals.plane) for row in q]
        spans = [_common([_force_spans(*branch, physics) for branch in some], signals.wrench_size) for some in branches]
        faces = [[face_vectors(*branch) for branch in some] for some in branches]
    else:
        spans = list(_edges(arms, normals, physics))
        faces = [[some] for some in _wrenches(arms, normals)]
    forces = [_unit(signals.force_rows(some @ turn)) for some, turn in zip(spans, turns, strict=True)]
    if weights is not None:
        lifted = (_unit(signals.weight_row(weight)[None]) for weight in weights)
        forces = [np.vstack(pair) for pair in zip(forces, lifted, strict=True)]
    displacements = [
        tuple(_unit(one @ turn / signals.twist_scale) for one in some) for some, turn in zip(faces, turns, strict=True)
    ]
    return SampleCones(q, tuple(forces), vectors, tuple(displacements))


def _unit(rows: Rows) -> Rows:
    """Rows of length one; none of them is zero."""
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def _wrenches(arms: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """d = [n; x X n] (2-5) of n samples and m contacts, shape (n, m, d)."""
    count, contacts, plane = arms.shape
    rows = face_vectors(arms.reshape(-1, plane), normals.reshape(-1, plane))
    return rows.reshape(count, contacts, 3 * (plane - 1))


def _edges(arms: np.ndarray, normals: np.ndarray, physics: Physics) -> np.ndarray:
    """Wrenches that contacts balance, shape (n, k, d): d, or those of the edges of friction cones (2-79), (2-80)."""
    if not physics.friction or not normals.size:
        return _wrenches(arms, normals)
    count, _, plane = arms.shape
    if plane == 2:
        units = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
        across = physics.friction * np.stack([-units[..., 1], units[..., 0]], axis=-1)
        return _wrenches(
            np.repeat(arms, 2, axis=1), np.stack([units - across, units + across], axis=2).reshape(count, -1, 2)
        )
    edges = [friction_edges(normal, physics.friction, physics.edges, "outer") for normal in normals.reshape(-1, plane)]
    return _wrenches(np.repeat(arms, physics.edges, axis=1), np.concatenate(edges).reshape(count, -1, plane))


def _turnings(R: np.ndarray) -> np.ndarray:
    """Rows times these are in the part's axes, shape (n, d, d); a planar moment stays."""
    plane = R.shape[1]
    turns = np.eye(3 * (plane - 1))[None].repeat(len(R), axis=0)
    turns[:, :plane, :plane] = R
    if plane == 3:
        turns[:, 3:, 3:] = R
    return turns


def _force_spans(points: np.ndarray, normals: np.ndarray, physics: Physics) -> Rows:
    """The same of one sample, shape (k, d)."""
    return _edges(points[None], normals[None], physics)[0]


def _common(spans: list[Rows], dimension: int) -> Rows:
    """What all branches balance: F = (A_1 u A_2 u ...)* (2-37), with friction likewise."""
    if len(spans) == 1:
        return spans[0]
    cones = [convert(PolyhedralConvexCone.from_span(rows, dimension=dimension)) for rows in spans]
    both = convert(intersect(*cones))
    return np.vstack([both.spans, both.lines, -both.lines])


def _weights(R: np.ndarray, physics: Physics, turns: np.ndarray) -> np.ndarray:
    """The weight's wrench at every sample, shape (n, d)."""
    arms = R @ physics.center
    forces = np.repeat(physics.force[None], len(R), axis=0)
    return (np.concatenate([forces, cross(arms, forces)], axis=1)[:, None] @ turns)[:, 0]
