"""Tucker's partition: which rows balance, which leave, for any system D u <= 0.

Tucker's theorem (A. W. Tucker, Dual systems of homogeneous linear relations, 1956; the source of the thesis's own cone
theory) says that every matrix D has weights w >= 0 with D^T w = 0 and a motion u with D u <= 0 such that for every row
exactly one of  w_i > 0  and  d_i . u < 0  holds. So the rows split, uniquely, in two sets:

* B, the *balanced* rows. d_i . r = 0 for every r of face{D}: the bidirectional constraints of Theorem 5 (2-111).
* the rest, all of which a single motion u leaves at once: u is in the relative interior of face{D}.

Every question of the thesis is read off this split: face{D} = {o} if and only if the balanced rows have rank d;
its interior is empty if and only if B is not; a_j lies in the cone of other rows if and only if -a_j balances with them.

The split is found by facial reduction: the nearest point of the rows' hull either separates them all (done), or is the
origin and then its rows balance; the others are projected along the span of the balanced ones, and so on, at most d
times. Every zero test is recorded, so that a caller sees how far the answer was from another one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask, Rows, Vector, Weights
from fixture_design.cones.kernel.minimum_norm import minimum_norm_point
from fixture_design.cones.kernel.nonnegative import nonnegative_least_squares


@dataclass(frozen=True)
class TuckerPartition:
    """The split of the rows of D, with its proof.

    Attributes:
        balanced: shape (m,), the rows in B.
        weights: shape (m,), >= 0, sum 1, positive on B and zero elsewhere, D^T w = 0; all zero if B is empty.
        span: orthonormal rows, shape (r, d): the linear space spanned by the balanced rows.
        motion: shape (d,), unit, orthogonal to ``span``, d_i . u < 0 for every row outside B; None if B has every row.
        zero_max: largest number that was taken as zero.  nonzero_min: smallest number that was not.
    """

    balanced: Mask
    weights: Weights
    span: Rows
    motion: Vector | None
    zero_max: float
    nonzero_min: float

    @property
    def closes(self) -> bool:
        """Whether face{D} is {o}: the balanced rows have full rank."""
        return len(self.span) == self.span.shape[1]

    @property
    def escape(self) -> Vector | None:
        """Some unit u != 0 of face{D}: the motion that leaves most, or one along the lines; None if there is none."""
        if self.motion is not None:
            return self.motion
        return None if self.closes else _complement(self.span)[0]


def tucker_partition(rows: Rows, zero: float) -> TuckerPartition:
    """Split the rows of D into balanced and leaving ones.

    Args:
        rows: shape (m, d), unit rows (no zero rows), finite; m = 0 is the unconstrained system.
        zero: numbers up to this are zeros; the rows are unit, so it is relative.
    """
    count, dimension = rows.shape
    balanced = np.zeros(count, dtype=bool)
    weights = np.zeros(count)
    span = np.zeros((0, dimension))
    free = np.eye(dimension)
    zero_max, nonzero_min = 0.0, np.inf
    motion = None
    while len(free) and not balanced.all():
        projected = rows @ free.T
        lengths = np.linalg.norm(projected, axis=1)
        along = ~balanced & (lengths <= zero)
        if along.any():
            # -d_i is already in the cone of the balanced rows, which is all of their span
            zero_max = max(zero_max, float(lengths[along].max()))
            balanced |= along
        rest = np.flatnonzero(~balanced)
        if not len(rest):
            break
        nonzero_min = min(nonzero_min, float(lengths[rest].min()))
        unit = projected[rest] / lengths[rest, None]
        point, support = minimum_norm_point(unit)
        distance = float(np.linalg.norm(point))
        if distance > zero:
            nonzero_min = min(nonzero_min, distance)
            motion = -(point / distance) @ free
            break
        zero_max = max(zero_max, distance)
        # weights at the level of the tolerance are rounding; they must not let a row into the balance
        chosen = rest[support > zero]
        nonzero_min = min(nonzero_min, float(support[support > zero].min()))
        balanced[chosen] = True
        span, free, smallest, dropped = _extend(span, rows[chosen], zero)
        nonzero_min, zero_max = min(nonzero_min, smallest), max(zero_max, dropped)
    if not len(free):
        balanced[:] = True  # the balanced rows span everything, so every other row balances against them
    if motion is not None:
        motion = motion / np.linalg.norm(motion)
    if balanced.any():
        weights[balanced] = positive_balance(rows[balanced], zero)
    return TuckerPartition(balanced, weights, span, motion, zero_max, nonzero_min)


def _extend(span: Rows, rows: Rows, zero: float) -> tuple[Rows, Rows, float, float]:
    """Orthonormal bases of the span with ``rows`` added and of its complement; smallest kept, largest dropped value."""
    projected = rows - (rows @ span.T) @ span
    projected = projected / np.linalg.norm(projected, axis=1, keepdims=True)
    _, values, right = np.linalg.svd(projected, full_matrices=False)
    kept = values > zero
    span = np.vstack([span, right[kept]])
    smallest = float(values[kept].min()) if kept.any() else np.inf
    dropped = float(values[~kept].max()) if (~kept).any() else 0.0
    return span, _complement(span), smallest, dropped


def _complement(span: Rows) -> Rows:
    """Orthonormal rows that span the orthogonal complement."""
    if not len(span):
        return np.eye(span.shape[1])
    return np.linalg.svd(span, full_matrices=True)[2][len(span) :]


def positive_balance(rows: Rows, zero: float) -> Weights:
    """Weights w > 0, sum 1, with D^T w = 0, for rows that balance; as even as one projection makes them.

    The nearest balanced weights to (1, ..., 1) are positive for most sets; else every row's own balance (2-111) is
    added up, which is positive by construction, and the sum is projected once more to take its rounding out.
    """
    left = np.linalg.svd(rows, full_matrices=False)
    rank = int(np.sum(left[1] > zero))
    across = left[0][:, :rank]
    weights = np.ones(len(rows))
    weights = weights - across @ (across.T @ weights)
    if weights.min() > 1e-3 * weights.max():
        return weights / weights.sum()
    total = np.zeros(len(rows))
    for index, row in enumerate(rows):
        own = np.insert(nonnegative_least_squares(np.delete(rows, index, axis=0).T, -row), index, 1.0)
        total += own / own.sum()
    projected = total - across @ (across.T @ total)
    best = projected if projected.min() > 0 else total
    return best / best.sum()
