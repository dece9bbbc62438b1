"""The smallest bound that pins give together: weights that differ only on rows that keep the part on both sides.

With sum z_i d_i = 0 over such rows (up to `SEATED`), c + z makes the same feature's row as c and bounds it just as
well. Two round pins locate along their line twice; the bound sum R_e |sum c_i n_i| is convex in how they share it, and
its smallest value is what their two discs allow. Found by iteratively reweighted least squares (E. Weiszfeld, 1937);
every step's weights are a bound, so that nothing rests on its convergence.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Mask, Points, Rows, Weights
from fixture_design.tolerances import SEATED, SUM_ROUNDING

#: Steps: each gains a digit or more, but for a pin whose share goes to zero.
_STEPS = 60


def lightest(
    weights: np.ndarray, rows: Rows, normals: Points, both: Mask, owner: Indices, radius: Weights
) -> np.ndarray:
    """Weights (n, k, m) with the smallest sum of radius |sum c_i n_i| over the elements.

    Args:
        rows, normals, both, owner: of the m rows.  radius: of each element [m].
    """
    free = np.flatnonzero(both)
    if len(free) < 2 or not radius.any():
        return weights
    left, values, _ = np.linalg.svd(rows[free])
    ways = left[:, int(np.sum(values > SEATED)) :].T
    if not len(ways):
        return weights
    shifts = np.zeros((len(ways), len(owner)))
    shifts[:, free] = ways
    sizes = np.maximum(radius, SUM_ROUNDING * radius.max())
    pulls, turned = (_pulls(given, normals, owner, len(radius)) for given in (weights, shifts))
    smallest = SUM_ROUNDING * np.abs(weights).max(axis=2, keepdims=True)
    steps = np.zeros((*weights.shape[:2], len(ways)))
    for _ in range(_STEPS):
        lengths = np.linalg.norm(pulls + np.einsum("nkz,zep->nkep", steps, turned), axis=3)
        heavy = sizes / np.maximum(lengths, smallest)
        square = np.einsum("nke,zep,yep->nkzy", heavy, turned, turned)
        aim = np.einsum("nke,zep,nkep->nkz", heavy, turned, pulls)
        steps = -np.einsum("nkzy,nky->nkz", np.linalg.pinv(square, hermitian=True), aim)
    return weights + steps @ shifts


def _pulls(weights: np.ndarray, normals: Points, owner: Indices, count: int) -> np.ndarray:
    """Sum of c_i n_i of each element: shape (..., e, p)."""
    by_element = np.zeros((len(owner), count, normals.shape[1]))
    by_element[np.arange(len(owner)), owner] = normals
    return np.einsum("...m,mep->...ep", weights, by_element)
