"""How closed a set of rows is, from both sides: bounds on  s = min over |u| = 1 of max_i d_i . u, with their proofs.

Every question about one branch is a question about the sign of s, for unit rows d_i:

* s > 0: face{D} = {o}, closed;   s < 0: the interior is not empty;   s = 0: neither (a tie).

s moves by at most as much as the rows do, so deciding on it is as safe as the rows are exact. Its bounds:

* a motion u proves    s <= max_i d_i . u / |u|;
* weights w >= 0, sum w = 1, prove    s >= -|D^T w|, and if all rows take part
                                      s >= (sigma_min(diag(w) D) - |D^T w|) / (1 + |w|).

The last one: with h = max_i d_i . u, sum_i w_i (h - d_i . u) <= h + |D^T w| bounds the 1-norm, hence the 2-norm of
diag(w)(h 1 - D u), so sigma_min <= |diag(w) D u| <= |h| |w| + h + |D^T w|; h < 0 would make that less than |D^T w|,
since h >= -|D^T w| and |w| <= 1, so a larger sigma_min proves the bound. Where it is too weak to decide, the facets
of the rows' convex hull give s itself. Errors of normals widen both bounds by as much as they move the rows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.cones.kernel import (
    Closure,
    TuckerPartition,
    closure_bound,
    closure_test,
    nonnegative_least_squares,
    tucker_partition,
)
from fixture_design.tolerances import Tolerances

#: Weights prove closure well enough if their bound is this part of what the hull's facets say [-].
PROVED = 0.01


@dataclass(frozen=True, eq=False)
class Bounds:
    """lower <= s <= upper, and what proves it.

    Attributes:
        lower, upper: for every set of normals within the errors.
        motion: shape (d,), unit, attains ``upper``; None if none was found (upper is then infinite).
        weights: shape (m,), >= 0, sum 1, balance the rows; None if no rows balance.
    """

    lower: float
    upper: float
    motion: Vector | None
    weights: Weights | None


def bounds_of(rows: Rows, errors: Weights, tolerances: Tolerances) -> Bounds:
    """Bounds on s for unit rows.

    The closure test comes first, as where many layouts are decided together. The tolerance that finds the proofs is
    moved down and up by a factor of 100 where they do not settle the sign; the bounds themselves do not depend on it.

    Args:
        rows: shape (m, d), unit; m = 0 gives s = -1 (every motion is free).
        errors: shape (m,), how far each row may be off.
    """
    if not len(rows):
        return Bounds(-np.inf, -1.0, np.eye(rows.shape[1])[0], None)
    bounds = _bounds_of_test(closure_test(rows, tolerances), rows, errors)
    if _settled(bounds, tolerances):
        return bounds
    for factor in (1.0, 0.01, 100.0):
        bounds = _tighter(bounds, _bounds_from(tucker_partition(rows, tolerances.tie * factor), rows, errors))
        if _settled(bounds, tolerances):
            return bounds
    if bounds.weights is not None and bounds.weights.all():
        bounds = _tighter(bounds, _hull_bounds(rows, errors, bounds.weights))
    return bounds


def _settled(bounds: Bounds, tolerances: Tolerances) -> bool:
    closed = bounds.lower > tolerances.near
    tie = bounds.lower >= -tolerances.zero and bounds.upper <= tolerances.zero
    return closed or tie or bounds.upper < -tolerances.near


def _tighter(first: Bounds, second: Bounds) -> Bounds:
    lower, upper = max(first, second, key=lambda b: b.lower), min(first, second, key=lambda b: b.upper)
    return Bounds(lower.lower, upper.upper, upper.motion, lower.weights)


def _bounds_of_test(test: Closure, rows: Rows, errors: Weights) -> Bounds:
    """The bounds of a closure test, wider by as much as normals' errors move the rows."""
    if not errors.any():
        return Bounds(test.lower, test.upper, test.motion, test.weights)
    upper = np.inf if test.motion is None else float(np.max(rows @ test.motion + errors))
    if test.weights is None:
        return Bounds(-np.inf, upper, test.motion, None)
    slack = float(errors.max()) if test.lower > 0 else float(test.weights @ errors)
    return Bounds(test.lower - slack, upper, test.motion, test.weights)


def _bounds_from(partition: TuckerPartition, rows: Rows, errors: Weights) -> Bounds:
    motion = partition.escape
    upper = np.inf if motion is None else float(np.max(rows @ motion + errors))
    if not partition.balanced.any():
        return Bounds(-np.inf, upper, motion, None)
    weights = partition.weights
    lower = closure_bound(rows, weights) if partition.closes else -float(np.linalg.norm(weights @ rows))
    slack = float(errors.max()) if partition.closes else float(weights @ errors)
    return Bounds(lower - slack, upper, motion, weights)


def _hull_bounds(rows: Rows, errors: Weights, weights: Weights) -> Bounds:
    """Bounds by the hull's facets; weights that are too uneven to prove closure are replaced by better ones.

    The facets say how far it is from opening, but a reader has only the weights: without weights that prove s > 0 by
    themselves, errors and all, the lower bound is not used.
    """
    found = nearest_facet(rows)
    if found is None:
        return Bounds(-np.inf, np.inf, None, None)
    upper = float(np.max(rows @ found.motion + errors))
    off = float(errors.max())
    if closure_bound(rows, weights) <= PROVED * found.at_least + off:
        weights = _stiffer_weights(rows, weights)
    proved = closure_bound(rows, weights) > PROVED * found.at_least + off
    lower = found.at_least - off if proved else -np.inf
    return Bounds(lower, upper, found.motion, weights)


def _stiffer_weights(rows: Rows, weights: Weights) -> Weights:
    """Balanced weights that resist every direction: pairs of nonnegative combinations that give +v and -v.

    The directions v are the singular vectors of diag(w) D; a pair balances, and weighs most where v needs it.
    """
    directions = np.linalg.svd(weights[:, None] * rows, full_matrices=False)[2]
    total = weights.copy()
    for direction in directions:
        pair = nonnegative_least_squares(rows.T, direction) + nonnegative_least_squares(rows.T, -direction)
        total += pair / pair.sum()
    across = np.linalg.svd(rows, full_matrices=False)[0]
    balanced = total - across @ (across.T @ total)
    best = balanced if balanced.min() >= 0 else total
    return best / best.sum()
