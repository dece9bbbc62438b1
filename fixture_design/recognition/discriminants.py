"""Minimum groups of discriminant functions: D (4-16), DS (4-24), DT (4-26), irreducible in the order given.

A discriminant is a face vector a of one of S_i's cones; a . s <= 0 is its answer. In telling S_i from S_j some of a
cone's faces are not needed: a_k is not if it lies in S_i[k]* + S_j*, with S_i[k] the other faces.

(4-16) tests each face against all others at once. Where two are redundant only because of each other it would drop
both, and D(S_1, S_2) of Table 6 would come out empty. So one is dropped after another, in the order given, each tested
against those still kept, as Table 7 has it. The result is irreducible and depends on the order; `smallest` has the
fewest. (Under (4-15): the minimum group is made of the face vectors that do *not* satisfy it, and S_j[a_k] must be
inside the *union* of the S_j[a_l].)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones import PolyhedralConvexCone, convert
from fixture_design.cones.cone import unit_rows
from fixture_design.cones.membership import in_cone_of
from fixture_design.recognition.measurement import MeasurementSet, oriented_rows
from fixture_design.tolerances import DEFAULT, Tolerances

#: Indices of faces of one cone (rows of `oriented_rows`), in their order.
Faces = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Against:
    """A cone that another is told from: unit rows of both its forms, lines and equalities as two vectors each."""

    faces: Rows
    generators: Rows

    @classmethod
    def of(cls, cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> Against:
        known = convert(cone, tolerances)
        faces = unit_rows(oriented_rows(known))[0]
        return cls(faces, unit_rows(np.vstack([known.spans, known.lines, -known.lines]))[0])


def discriminants(rows: Rows, other: Against, tolerances: Tolerances = DEFAULT) -> Faces:
    """D(S_i, S_j) of one cone each (4-16): the faces of S_i that tell it from S_j.

    Args:
        rows: face vectors of S_i, shape (m, d), of any length but zero, in the order in which they are tried.

    Returns:
        those that stay. Any s in S_j with a . s <= 0 for all of them is in S_i; every s in S_i passes them.
    """
    unit = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    products = unit @ other.generators.T
    # a face that none of S_j's span vectors crosses is in S_j*
    kept = [k for k in range(len(unit)) if (products[k] > tolerances.tie).any()]
    for k in tuple(kept):
        others = [m for m in kept if m != k]
        witnesses = (products[k] > tolerances.tie) & (products[others] <= 0).all(axis=0)
        if witnesses.any():
            continue
        if in_cone_of(unit[k], np.vstack([unit[others], other.faces]), tolerances):
            kept = others
    return tuple(kept)


def discriminating(first: MeasurementSet, second: MeasurementSet) -> tuple[Faces, ...]:
    """DS(S_i, S_j) (4-24): for every cone of S_i the faces that tell it from all cones of S_j (4-21)."""
    others = [Against.of(cone) for cone in second.cones]
    return tuple(united(discriminants(oriented_rows(cone), other) for other in others) for cone in first.cones)


def united(groups: Iterable[Faces]) -> Faces:
    """The intersection of cones of the same faces: all that any of them has, in the cone's order."""
    return tuple(sorted({face for group in groups for face in group}))


def smallest(rows: Rows, others: Sequence[Against], tolerances: Tolerances = DEFAULT) -> Faces:
    """The fewest faces of a cone that tell it from all the others: a set cover, by mixed-integer programming.

    Every signal of the others that is outside of the cone must cross one of the chosen faces. Signals are found as
    needed: a choice that lets one pass is cut off by it, until none passes.

    Raises:
        RuntimeError: the solver failed; a fault of ours.
    """
    unit, where = unit_rows(rows)
    if not len(unit):
        return ()  # a cone without faces is everything, and nothing tells it from others
    signals = [s for other in others for s in other.generators]
    cuts = {row.tobytes(): row for s in signals if (row := unit @ s > tolerances.tie).any()}
    while True:
        chosen = _cover(np.array(list(cuts.values())).reshape(-1, len(unit)))
        passing = (_passing(unit, chosen, other, tolerances) for other in others)
        new = {row.tobytes(): row for found in passing for s in found if (row := unit @ s > tolerances.tie).any()}
        new = {key: row for key, row in new.items() if key not in cuts}
        if not new:
            return tuple(np.flatnonzero(where)[chosen].tolist())
        cuts |= new


def _cover(cuts: np.ndarray) -> list[int]:
    """The fewest columns that meet every row."""
    from scipy.optimize import Bounds, LinearConstraint, milp  # only where asked for

    if not len(cuts):
        return []
    count = cuts.shape[1]
    # of equally small sets the one with early faces, by less than one face's worth in all
    cost = 1.0 + np.arange(count) / (count * count)
    found = milp(cost, constraints=LinearConstraint(cuts.astype(float), lb=1.0), integrality=np.ones(count),
                 bounds=Bounds(0, 1))  # fmt: skip
    if found.x is None:
        raise RuntimeError(f"set cover of discriminants: {found.message}")
    return np.flatnonzero(found.x > 0.5).tolist()


def _passing(unit: Rows, chosen: list[int], other: Against, tolerances: Tolerances) -> Iterable[Vector]:
    """Signals of a cone that pass the chosen faces and are outside of others: extreme rays of what passes."""
    passing = convert(PolyhedralConvexCone.from_faces(np.vstack([other.faces, unit[chosen]])), tolerances)
    return np.vstack([passing.spans, passing.lines, -passing.lines])
