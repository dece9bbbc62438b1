"""Hybrid position/force control under unidirectional contacts (thesis 2.3 (d), 2.6 (d)).

A, the admissible displacements, is the position-controlled space; F = A*, the admissible forces, the force-controlled
one (2-56). A command is a pair of the two that does no work together, a *reciprocal* pair: dq in A, p in F,
p . dq = 0. What is measured has p . dq = 0 or, when a contact is being left or missed, p . dq > 0, a *repelling* pair;
p . dq < 0, a *contrary* pair, contradicts rigid contact (Ohwovoriole and Roth, 1981).

Where all constraints are bidirectional, A and F are subspaces and orthogonal complements: the position- and
force-controlled subspaces of M. Mason's hybrid control. Otherwise only part of each is a subspace; both are given.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fixture_design.analysis.admissible_sets import admissible_forces
from fixture_design.arrays import ArrayLike, Rows, Vector
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, convert, dual
from fixture_design.cones.kernel import nonnegative_least_squares
from fixture_design.errors import DimensionError
from fixture_design.tolerances import DEFAULT, Tolerances

PairKind = Literal["reciprocal", "repelling", "contrary"]


@dataclass(frozen=True, eq=False)
class HybridControl:
    """The sets a hybrid controller works with.

    Displacements and forces are in one set of coordinates, [dx; dtheta] and [f; m] about one origin; lengths weigh
    against angles as these coordinates do, which matters where a command is *nearest* to a wish, and nowhere else.

    Attributes:
        displacements: A.  forces: F = A*.
        position_controlled: orthonormal rows: the largest subspace found in A, in which the part moves freely both
            ways: the lines of the A_n that has most (a union may hold several; each is a subspace of its own A_n).
        force_controlled: orthonormal rows: the subspace in which contacts push back both ways.
        bidirectional: whether the two subspaces are all of A and F.
    """

    displacements: ConeUnion
    forces: PolyhedralConvexCone
    position_controlled: Rows
    force_controlled: Rows
    bidirectional: bool


def hybrid_control(displacements: ConeUnion, tolerances: Tolerances = DEFAULT) -> HybridControl:
    """Position- and force-controlled sets for an admissible displacement set A."""
    forces = admissible_forces(displacements, tolerances)
    sum_of_cones = convert(dual(forces), tolerances)
    cones = [convert(cone, tolerances) for cone in displacements]
    return HybridControl(
        displacements,
        forces,
        _orthonormal(max((cone.lines for cone in cones), key=len), tolerances),
        _orthonormal(forces.lines, tolerances),
        # A is a subspace if it is its own convex sum: no span vectors left over, and one cone that has all the lines
        not len(sum_of_cones.spans) and any(len(cone.lines) == len(sum_of_cones.lines) for cone in cones),
    )


def commanded_pair(
    control: HybridControl, displacement: ArrayLike, force: ArrayLike, tolerances: Tolerances = DEFAULT
) -> tuple[Vector, Vector]:
    """The admissible, reciprocal command nearest to a wished displacement and force.

    First dq: the point of A nearest to the wish. Then p: the point nearest to its wish on the face of F that is
    orthogonal to dq, so that p . dq = 0 (2.6 (d)). Zero vectors are possible answers: a closed part cannot be moved.

    Args:
        displacement, force: the wishes, shape (d,) each.

    Returns:
        dq in A and p in F with p . dq = 0, shape (d,) each.

    Raises:
        DimensionError: wishes that do not fit the sets.
    """
    wish = _vector(displacement, control)
    moved = min(
        (nearest_in(convert(c, tolerances), wish) for c in control.displacements),
        key=lambda x: np.linalg.norm(x - wish),
    )
    length = np.linalg.norm(moved)
    spans = control.forces.spans
    if length > 0:
        sizes = np.maximum(np.linalg.norm(spans, axis=1), np.finfo(float).tiny)
        spans = spans[np.abs(spans @ moved) <= tolerances.tie * length * sizes]
    face = PolyhedralConvexCone.from_span(spans, control.forces.lines, dimension=control.forces.dimension)
    return moved, nearest_in(face, _vector(force, control))


def nearest_in(cone: PolyhedralConvexCone, vector: Vector) -> Vector:
    """The point of a cone in span form nearest to a vector, shape (d,)."""
    generators = np.vstack([cone.spans, cone.lines, -cone.lines])
    return nonnegative_least_squares(generators.T, vector) @ generators


def classify_pair(force: ArrayLike, displacement: ArrayLike, noise: float = DEFAULT.tie) -> PairKind:
    """What a measured force (on the part, as p of 2-16) and displacement say of each other.

    Args:
        force: p.  displacement: dq; same shape (d,).
        noise: |p . dq| up to this, relative to |p| |dq|, counts as no work; measurements have more than rounding.

    Returns:
        "reciprocal" for no work, "repelling" for positive, "contrary" for negative work.
    """
    p, dq = np.asarray(force, dtype=np.float64), np.asarray(displacement, dtype=np.float64)
    if p.shape != dq.shape or p.ndim != 1:
        raise DimensionError(f"force and displacement must be vectors of one length, not {p.shape} and {dq.shape}")
    work = float(p @ dq)
    if abs(work) <= noise * float(np.linalg.norm(p) * np.linalg.norm(dq)):
        return "reciprocal"
    return "repelling" if work > 0 else "contrary"


def _vector(values: ArrayLike, control: HybridControl) -> Vector:
    vector = np.asarray(values, dtype=np.float64)
    if vector.shape != (control.forces.dimension,):
        raise DimensionError(f"a vector of shape {vector.shape} for sets in R^{control.forces.dimension}")
    return vector


def _orthonormal(rows: Rows, tolerances: Tolerances) -> Rows:
    if not len(rows):
        return rows
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    return right[values > tolerances.tie * values[0]]
