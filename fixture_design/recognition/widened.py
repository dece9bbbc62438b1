"""Discriminants of widened sets: a face may be left out only if the bounds of those that imply it allow it too.

D (4-16) drops a face a_k of S_i where a_k = sum c a + sum d b with c, d >= 0, a the faces kept and b those of S_j: then
a_k . s <= 0 follows. Widened, a . s <= eps and b . s <= eps_j leave a_k . s <= sum c eps + sum d eps_j, which may be
more than the bound of a_k. So it is dropped only where some c, d have sum c eps + sum d eps_j <= eps_k: the least is a
linear program. With equal bounds hardly any face is dropped, since all are unit vectors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.recognition.discriminants import Faces, united
from fixture_design.recognition.measurement import MeasurementSet, Widening, oriented_rows
from fixture_design.tolerances import DEFAULT


def bounds_of(rows: Rows, force_size: int, widening: Widening, force: float, displacement: float) -> Weights:
    """By how much a . s may exceed zero, for each face of a set, shape (m,): its own bound and that of the noise.

    Args:
        force_size: numbers of the force block, in which the faces of forces are.
        force, displacement: bounds of the sensors.
    """
    of_force = np.abs(rows[:, :force_size]).max(axis=1, initial=0.0) > 0
    # a tie is inside: sums of products leave 1e-16 where a zero is
    return np.where(of_force, widening.force + force, widening.displacement + displacement) + DEFAULT.tie


@dataclass(frozen=True, eq=False)
class Widened:
    """A cone {s : a . s <= bound for all rows a}.

    Attributes:
        rows: unit, shape (m, d).  bounds: shape (m,), positive.
    """

    rows: Rows
    bounds: Weights

    @property
    def exact(self) -> bool:
        """Whether it is not widened at all."""
        return bool((self.bounds <= DEFAULT.tie).all())


def widened_cones(found: MeasurementSet, force_size: int, force: float, displacement: float) -> list[Widened]:
    """The cones of a set with their bounds; arguments as in `bounds_of`."""
    rows = [oriented_rows(cone) for cone in found.cones]
    return [Widened(some, bounds_of(some, force_size, found.widening, force, displacement)) for some in rows]


def widened_group(cone: Widened, group: Faces, others: list[Widened]) -> Faces:
    """DT's group for one cone of the target, with the faces that widened sets need besides.

    Args:
        group: as found for the sets without their bounds; it stays.  others: cones of the other successors.

    Returns:
        faces that a signal of any of the others, widened, passes only if it is in the cone, widened.
    """
    if cone.exact and all(other.exact for other in others):
        return group
    return united([group, *(_against(cone, group, other) for other in others)])


def _against(cone: Widened, group: Faces, other: Widened) -> Faces:
    kept = list(range(len(cone.rows)))
    for k in sorted(set(kept) - set(group)):
        rest = [m for m in kept if m != k]
        rows = np.vstack([cone.rows[rest], other.rows])
        if _implied(cone.rows[k], cone.bounds[k], rows, np.concatenate([cone.bounds[rest], other.bounds])):
            kept = rest
    return tuple(kept)


def _implied(row: Vector, bound: float, rows: Rows, bounds: Weights) -> bool:
    """Whether row = sum c rows with c >= 0 and sum c bounds <= bound."""
    # s = t row passes all rows and has row . s = t: for t beyond the bound a witness that nothing implies the row
    if (bound * (rows @ row) < bounds - DEFAULT.tie).all():
        return False
    from scipy.optimize import linprog  # only where discriminants are exported

    found = linprog(bounds, A_eq=rows.T, b_eq=row)
    if found.x is None:
        return False
    weights = np.maximum(found.x, 0.0)
    left = float(np.linalg.norm(row - weights @ rows))
    return bool(weights @ bounds + left <= bound + DEFAULT.tie)
