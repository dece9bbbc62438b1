"""Do rows close, does a motion leave them all, or neither? Closure tests without CONVERT, each with its witness.

For unit rows d_i let s = min over |u| = 1 of max_i d_i . u. The test gives bounds lower <= s <= upper, each with its
proof: weights w >= 0 that balance bound s from below, a motion u from above. Form closure of one branch is s > 0; force
closure the same for the edges of friction cones; strong accessibility is s < 0. What that means near zero is for the
tolerances: `Closure.closes` and `Closure.leaves` are True, False, or None where a bound lies in the undecided band.

The compiled bounds hold for the rows as the floats they are, with all rounding on the way (src/certificate.rs).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fixture_design.arrays import Indices, Rows, Vector, Weights
from fixture_design.cones.kernel.checks import require_unit_rows
from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.nonnegative import nonnegative_least_squares
from fixture_design.cones.kernel.threads import thread_count
from fixture_design.cones.kernel.tucker import tucker_partition
from fixture_design.errors import ConeError
from fixture_design.tolerances import DEFAULT, Tolerances


@dataclass(frozen=True, eq=False, slots=True)
class Closure:
    """lower <= s <= upper, and what proves it.

    Attributes:
        weights: shape (m,), >= 0, sum 1; None if no rows balance, or none were needed to settle the sign.
        motion: shape (d,), unit; None likewise.
        tolerances: what counts as zero.
    """

    lower: float
    upper: float
    weights: Weights | None
    motion: Vector | None
    tolerances: Tolerances

    @property
    def closes(self) -> bool | None:
        """Whether face{D} = {o}, with `weights` as the witness of a yes and `motion` of a no."""
        return True if self.lower > self.tolerances.near else False if self.upper <= self.tolerances.zero else None

    @property
    def leaves(self) -> bool | None:
        """Whether `motion` leaves all rows; `weights` are the witness of a no."""
        return True if self.upper < -self.tolerances.near else False if self.lower >= -self.tolerances.zero else None


@dataclass(frozen=True, eq=False)
class Closures:
    """The same for n sets of rows.

    Attributes:
        lower, upper: shape (n,).
        weights: one for each place of the ragged sets, zero where a set has none; None if not asked for.
        motions: shape (n, d), zero where a set has none; None if not asked for.
        tolerances: what counts as zero.
    """

    lower: Weights
    upper: Weights
    weights: Weights | None
    motions: Rows | None
    tolerances: Tolerances

    @property
    def closes(self) -> np.ndarray:
        """Shape (n,), int8: 1 yes, 0 no, -1 undecided."""
        return np.where(
            self.lower > self.tolerances.near, 1, np.where(self.upper <= self.tolerances.zero, 0, -1)
        ).astype(np.int8)

    @property
    def leaves(self) -> np.ndarray:
        """Shape (n,), int8: 1 yes, 0 no, -1 undecided."""
        open_ = self.upper < -self.tolerances.near
        return np.where(open_, 1, np.where(self.lower >= -self.tolerances.zero, 0, -1)).astype(np.int8)


@dataclass(frozen=True, eq=False, slots=True)
class Membership:
    """Is a unit vector in the cone of some rows?

    Attributes:
        inside: None if the distance lies in the undecided band.
        distance: of the vector from the cone.
        weights: shape (m,), >= 0; rows weighted by them come as near as that.
        separating: shape (d,), unit, no row points along it and the vector does; None if the distance is zero.
    """

    inside: bool | None
    distance: float
    weights: Weights
    separating: Vector | None


@dataclass(frozen=True, eq=False)
class Memberships:
    """The same for n vectors, each with a set of rows of its own.

    Attributes:
        residuals: shape (n, d), each vector less the nearest point of its cone: no row of the set points along it.
        weights: >= 0, one for each place of the ragged sets.
        tolerances: what counts as zero.
    """

    residuals: Rows
    weights: Weights
    tolerances: Tolerances

    @property
    def distances(self) -> Weights:
        """Shape (n,), of the vectors from their cones."""
        return np.linalg.norm(self.residuals, axis=1)

    @property
    def inside(self) -> np.ndarray:
        """Shape (n,), int8: 1 yes, 0 no, -1 undecided."""
        distances = self.distances
        far = np.where(distances > self.tolerances.near, 0, -1)
        return np.where(distances <= self.tolerances.zero, 1, far).astype(np.int8)


def closure_test(rows: Rows, tolerances: Tolerances = DEFAULT) -> Closure:
    """Bounds on s that settle its sign, where the tolerances allow it.

    Args:
        rows: shape (m, d), unit or zero; zero rows say nothing, and without rows s = -1.

    Raises:
        ConeError: rows that are not unit, not finite.
    """
    native = compiled(rows.shape[1])
    if native is not None:
        sizes = (tolerances.zero, tolerances.tie, tolerances.near)
        lower, upper, weights, motion = native.closure(rows, *sizes)
        return Closure(lower, upper, weights, motion, tolerances)
    require_unit_rows(rows)
    said = rows.any(axis=1)
    if not said.any():
        return Closure(-np.inf, -1.0, None, np.eye(rows.shape[1])[0], tolerances)
    found = Closure(-np.inf, np.inf, None, None, tolerances)
    for factor in (1.0, 0.01, 100.0):
        found = _tighter(found, _from_partition(rows[said], tolerances.tie * factor, tolerances))
        if (found.closes, found.leaves) in {(True, False), (False, True), (False, False)}:
            break
    if found.weights is not None and not said.all():
        weights = np.zeros(len(rows))
        weights[said] = found.weights
        found = Closure(found.lower, found.upper, weights, found.motion, tolerances)
    return found


def _from_partition(rows: Rows, zero: float, tolerances: Tolerances) -> Closure:
    partition = tucker_partition(rows, zero)
    motion = partition.escape
    upper = np.inf if motion is None else float(np.max(rows @ motion))
    if not partition.balanced.any():
        return Closure(-np.inf, upper, None, motion, tolerances)
    return Closure(closure_bound(rows, partition.weights), upper, partition.weights, motion, tolerances)


def _tighter(first: Closure, second: Closure) -> Closure:
    lower, upper = max(first, second, key=lambda c: c.lower), min(first, second, key=lambda c: c.upper)
    return Closure(lower.lower, upper.upper, lower.weights, upper.motion, first.tolerances)


def closure_bound(rows: Rows, weights: Weights) -> float:
    """A lower bound on s for weights w >= 0 of sum 1.

    (sigma_min(diag(w) D) - |D^T w|) / (1 + |w|) where that is positive, else -|D^T w|: the first bound's proof needs
    s >= 0, which it has where sigma_min is the larger one.
    """
    residual = float(np.linalg.norm(weights @ rows))
    if len(rows) < rows.shape[1]:
        return -residual
    smallest = float(np.linalg.svd(weights[:, None] * rows, compute_uv=False)[-1])
    return (smallest - residual) / (1 + float(np.linalg.norm(weights))) if smallest > residual else -residual


def closure_tests(
    rows: Rows,
    offsets: Indices,
    indices: Indices | None = None,
    tolerances: Tolerances = DEFAULT,
    *,
    witnesses: bool = False,
    threads: int | None = None,
) -> Closures:
    """`closure_test` of many sets of rows, which may differ in size, on several cores.

    Args:
        rows: shape (r, d), unit or zero.
        offsets: shape (n + 1,), rising from 0: set k has the places offsets[k] to offsets[k + 1].
        indices: the row at each place; by default place p is row p. With it sets may share rows.
        witnesses: whether weights and motions are wanted.
        threads: by default one for each processor.

    Raises:
        ConeError: rows that are not unit, not finite; offsets or indices that do not fit.
    """
    native = compiled(rows.shape[1])
    sizes = (tolerances.zero, tolerances.tie, tolerances.near)
    if native is not None:
        count = thread_count(threads)
        lower, upper, weights, motions = native.closures(rows, indices, offsets, *sizes, witnesses, count)
        return Closures(lower, upper, weights, motions, tolerances)
    chosen = _places(rows, offsets, indices)
    tests = [closure_test(rows[chosen[a:b]], tolerances) for a, b in pairwise(offsets)]
    lower, upper = np.array([t.lower for t in tests]), np.array([t.upper for t in tests])
    if not witnesses:
        return Closures(lower, upper, None, None, tolerances)
    sizes_of = np.diff(offsets)
    weights = [np.zeros(n) if t.weights is None else t.weights for t, n in zip(tests, sizes_of, strict=True)]
    motions = [np.zeros(rows.shape[1]) if t.motion is None else t.motion for t in tests]
    return Closures(
        lower, upper, np.concatenate([np.zeros(0), *weights]), np.array(motions).reshape(-1, rows.shape[1]), tolerances
    )


def membership_test(vector: Vector, rows: Rows, tolerances: Tolerances = DEFAULT) -> Membership:
    """Whether a unit vector is a nonnegative combination of unit rows (2-103), with its witness either way.

    Nonnegative least squares: the nearest point of the cone, and what is left separates.

    Raises:
        ConeError: vectors that are not unit, not finite.
    """
    found = membership_tests(vector[None, :], rows, np.array([0, len(rows)]), tolerances=tolerances, threads=1)
    distance = float(found.distances[0])
    separating = found.residuals[0] / distance if distance > 0 else None
    inside = {1: True, 0: False, -1: None}[int(found.inside[0])]
    return Membership(inside, distance, found.weights, separating)


def membership_tests(
    vectors: Rows,
    rows: Rows,
    offsets: Indices,
    indices: Indices | None = None,
    tolerances: Tolerances = DEFAULT,
    *,
    threads: int | None = None,
) -> Memberships:
    """`membership_test` of many vectors, each with a set of rows of its own.

    Args:
        vectors: shape (n, d), unit.  rows, offsets, indices, threads: as `closure_tests`.

    Raises:
        ConeError: vectors that are not unit, not finite; offsets or indices that do not fit.
    """
    native = compiled(rows.shape[1])
    if native is not None:
        residuals, weights = native.memberships(vectors, rows, indices, offsets, thread_count(threads))
        return Memberships(residuals, weights, tolerances)
    chosen = _places(rows, offsets, indices)
    if len(vectors) + 1 != len(offsets):
        raise ConeError(f"{len(vectors)} vectors for {len(offsets) - 1} sets of rows")
    require_unit_rows(rows)
    require_unit_rows(vectors)
    residuals, weights = np.zeros(vectors.shape), np.zeros(len(chosen))
    for k, (start, end) in enumerate(pairwise(offsets)):
        part = rows[chosen[start:end]]
        weights[start:end] = nonnegative_least_squares(part.T, vectors[k])
        residuals[k] = _unreached(part[weights[start:end] > 0], vectors[k])
    return Memberships(residuals, weights, tolerances)


def _unreached(rows: Rows, vector: Vector) -> Vector:
    """The part of the vector orthogonal to the rows, accurate relative to itself."""
    if not len(rows):
        return vector
    basis = np.linalg.qr(rows.T)[0]
    rest = vector - basis @ (basis.T @ vector)
    return rest - basis @ (basis.T @ rest)


def _places(rows: Rows, offsets: Indices, indices: Indices | None) -> Indices:
    """The row at each place of the ragged sets."""
    chosen = np.arange(len(rows)) if indices is None else indices
    if not len(offsets) or offsets[0] != 0 or (np.diff(offsets) < 0).any() or offsets[-1] != len(chosen):
        raise ConeError(f"offsets must rise from 0 to {len(chosen)}")
    if len(chosen) and not 0 <= chosen.min() <= chosen.max() < len(rows):
        raise ConeError(f"there is no row {chosen.min() if chosen.min() < 0 else chosen.max()}; there are {len(rows)}")
    return chosen
