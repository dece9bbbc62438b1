"""Tucker's partition: which rows balance, which leave, for any system D u <= 0.

Tucker's theorem (A. W. Tucker, Dual systems of homogeneous linear relations, 1956; the source of the thesis's own cone
theory) says that every matrix D has weights w >= 0 with D^T w = 0 and a motion u with D u <= 0 such that for every row
exactly one of  w_i > 0  and  d_i . u < 0  holds. So the rows split, uniquely, in two sets:

* B, the *balanced* rows. d_i . r = 0 for every r of face{D}: the bidirectional constraints of Theorem 5 (2-111).
* the rest, all of which a single motion u leaves at once: u is in the relative interior of face{D}.

Every question of the thesis is read off this split: face{D} = {o} if and only if the balanced rows have rank d;
its interior is empty if and only if B is not; a_j lies in the cone of others if and only if -a_j balances with them.

The split is found by facial reduction: the nearest point of the rows' hull either separates them all (done), or is the
origin and then its rows balance; the others are projected along the span of the balanced ones, and so on, at most d
times. Every zero test is recorded, so that a caller sees how far the answer was from another one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Mask, Rows, Vector, Weights
from fixture_design.cones.kernel.checks import require_tolerance, require_unit_rows
from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.directions import singular_directions
from fixture_design.cones.kernel.minimum_norm import minimum_norm_point

#: Singular values below this, relative to the largest, are rounding in the core's pseudo-inverse [-].
_PSEUDO_RANK = 1e-14
#: Projected weights are taken as they are if the smallest is at least this part of the largest [-].
_EVEN_ENOUGH = 1e-3


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
        rows: shape (m, d), unit rows, finite; m = 0 is the unconstrained system. A zero row counts as balanced.
        zero: numbers up to this are zeros; the rows are unit, so it is relative.

    Raises:
        ConeError: rows that are not unit, not finite.
    """
    native = compiled(rows.shape[1])
    if native is not None:
        return TuckerPartition(*native.tucker_partition(rows, zero))
    require_tolerance(zero)
    require_unit_rows(rows)
    count, dimension = rows.shape
    balanced = np.zeros(count, dtype=bool)
    weights = np.zeros(count)
    span = np.zeros((0, dimension))
    free = np.eye(dimension)
    zero_max, nonzero_min = 0.0, np.inf
    motion = None
    core, core_weights = np.zeros(0, dtype=np.int64), np.zeros(0)
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
        core, core_weights = _with_level(rows, core, core_weights, chosen, support[support > zero] / lengths[chosen])
        added, free, smallest, dropped = _split(unit[support > zero], free, zero)
        span = np.vstack([span, added])
        nonzero_min, zero_max = min(nonzero_min, smallest), max(zero_max, dropped)
    if not len(free):
        balanced[:] = True  # the balanced rows span everything, so every other row balances against them
    if balanced.any() and len(free):
        # the steps have lost digits; the balanced rows' own singular vectors are as orthogonal to them as can be
        _, right = singular_directions(rows[balanced])
        span, free = right[: len(span)], right[len(span) :]
    if motion is not None:
        motion = (motion @ free.T) @ free
        motion = motion / np.linalg.norm(motion)
    if balanced.any():
        weights[balanced] = positive_balance(rows, balanced, core, core_weights, zero)
    return TuckerPartition(balanced, weights, span, motion, zero_max, nonzero_min)


def _split(
    balanced: Float[np.ndarray, "_ f"], free: Float[np.ndarray, "f d"], zero: float
) -> tuple[Rows, Rows, float, float]:
    """Orthonormal bases of the part of ``free`` that the balanced rows span and of the rest of it.

    The rows are given in coordinates of ``free``: a row that was almost along the old span has lost its digits in
    other coordinates, and the new basis would not be orthogonal to the old one.

    Returns:
        the two bases, the smallest singular value kept and the largest dropped.
    """
    values, right = singular_directions(balanced)
    rank = int(np.sum(values > zero))
    dropped = float(values[rank]) if rank < len(values) else 0.0
    return right[:rank] @ free, right[rank:] @ free, float(values[rank - 1]), dropped


def _complement(span: Rows) -> Rows:
    """Orthonormal rows that span the orthogonal complement."""
    return singular_directions(span)[1][len(span) :]


def _with_level(
    rows: Rows, core: np.ndarray, core_weights: np.ndarray, chosen: np.ndarray, chosen_weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Positive balanced weights on the rows of earlier levels and of this one.

    The new rows balance up to something in the span of the core; the core takes that up, with any sign, and enough of
    its own positive balance makes the signs right.
    """
    if not len(core):
        return chosen, chosen_weights / chosen_weights.sum()
    taken_up = _taken_up(rows[core], core_weights, chosen_weights @ rows[chosen])
    weights = np.concatenate([taken_up + core_weights, chosen_weights])
    return np.concatenate([core, chosen]), weights / weights.sum()


def _taken_up(core_rows: Rows, core_weights: np.ndarray, wrenches: np.ndarray) -> np.ndarray:
    """Nonnegative weights of the core that balance wrenches from its span, shape (..., d) to (..., k)."""
    signed = -wrenches @ np.linalg.pinv(core_rows, rcond=_PSEUDO_RANK)
    lift = np.maximum(0.0, np.max(-signed / core_weights, axis=-1, keepdims=True))
    return np.maximum(signed + lift * core_weights, 0.0)


def positive_balance(rows: Rows, balanced: Mask, core: np.ndarray, core_weights: np.ndarray, zero: float) -> np.ndarray:
    """Weights w > 0, sum 1, with D^T w = 0, for the rows that balance; as even as one projection makes them.

    The nearest balanced weights to (1, ..., 1) are positive for most sets; else every row is balanced by the core, the
    few rows that span what all of them do, and the sum is projected once more to take its rounding out.
    """
    chosen = rows[balanced]
    across, values, _ = np.linalg.svd(chosen, full_matrices=False)
    across = across[:, : int(np.sum(values > zero))]
    even = 1.0 - across @ across.sum(axis=0)
    if even.min() > _EVEN_ENOUGH * even.max():
        return even / even.sum()
    everywhere = np.zeros(len(rows))
    own = _taken_up(rows[core], core_weights, chosen)
    totals = 1.0 + own.sum(axis=1, keepdims=True)
    everywhere[core] = (own / totals).sum(axis=0)
    everywhere[balanced] += 1.0 / totals[:, 0]
    total = everywhere[balanced]
    projected = total - across @ (across.T @ total)
    best = projected if projected.min() > 0 else total
    return best / best.sum()
