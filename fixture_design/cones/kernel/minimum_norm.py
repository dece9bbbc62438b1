"""The point of a convex hull nearest to the origin (P. Wolfe, Finding the nearest point in a polytope, 1976).

For unit rows d_i it decides the sign of  s = min over |u| = 1 of max_i d_i . u  from below: if the nearest point is
x != 0, then s = -|x| and u = -x / |x| attains it; if x = 0, the weights of x prove s >= 0.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.cones.kernel.checks import require_finite
from fixture_design.cones.kernel.choice import compiled
from fixture_design.errors import ConeError

#: The hull is taken to reach the origin when the nearest point is closer than this to it, relative to the rows [-].
_ARRIVED = 4e-16
#: A row improves the point only if it beats it by this much, relative to the point's own length [-].
_IMPROVES = 1e-13


def minimum_norm_point(rows: Rows) -> tuple[Vector, Weights]:
    """Nearest point x of conv{d_1..d_m} to the origin, and weights w >= 0, sum w = 1, with x = D^T w.

    Args:
        rows: shape (m, d), m >= 1, finite, of comparable length (unit rows, or rows with a unit normal part).

    Returns:
        x with shape (d,), w with shape (m,); at most d + 1 weights are positive.

    Raises:
        ConeError: no rows, or rows that are not finite.
    """
    native = compiled(rows.shape[1])
    if native is not None:
        return native.minimum_norm_point(rows)
    if not len(rows):
        raise ConeError("no rows, so no nearest point")
    require_finite(rows)
    count = len(rows)
    size = float(np.sqrt(np.max(np.einsum("ij,ij->i", rows, rows))))
    corral = [int(np.argmin(np.einsum("ij,ij->i", rows, rows)))]
    barycentric = np.ones(1)
    point = rows[corral[0]].copy()
    length = float(np.linalg.norm(point))
    refused = np.zeros(count, dtype=bool)
    seen = {frozenset(corral)}
    # in exact arithmetic every major cycle shortens the point, so that no corral returns. A step along almost all of a
    # unit row from a point close to the origin gains less than rounding, yet the next one may go all the way: steps
    # that lose no more than rounding are taken too, and corrals that return are refused.
    for _ in range(20 * count + 200):
        # d + 1 independent rows around the origin: what is left of the length is rounding, and no row can take it out
        around = len(corral) > rows.shape[1] and length <= _IMPROVES * size
        if around or length <= _ARRIVED * size:
            break
        heights = rows @ (point / length)
        heights[refused] = np.inf
        heights[corral] = np.inf
        entering = int(np.argmin(heights))
        if heights[entering] >= length - _IMPROVES * size:
            break
        new_corral, new_barycentric = _descend(rows, [*corral, entering], np.append(barycentric, 0.0))
        new_point = new_barycentric @ rows[new_corral]
        new_length = float(np.linalg.norm(new_point))
        if new_length > length + _ARRIVED * size or frozenset(new_corral) in seen:
            refused[entering] = True
            continue
        seen.add(frozenset(new_corral))
        corral, barycentric, point, length = new_corral, new_barycentric, new_point, new_length
        refused[:] = False
    weights = np.zeros(count)
    weights[corral] = barycentric
    return point, weights


def _descend(rows: Rows, corral: list[int], barycentric: np.ndarray) -> tuple[list[int], np.ndarray]:
    """Minor cycles: go to the point of the corral's affine hull nearest to the origin, dropping rows on the way."""
    while True:
        target = _affine_minimizer(rows[corral])
        if np.all(target > 0):
            return corral, target
        falling = target <= 0
        steps = barycentric[falling] / np.maximum(barycentric[falling] - target[falling], 1e-300)
        step = float(np.min(steps))
        barycentric = barycentric + step * (target - barycentric)
        leaving = np.flatnonzero(falling)[int(np.argmin(steps))]
        barycentric[leaving] = 0.0
        keep = barycentric > 0
        corral = [index for index, kept in zip(corral, keep, strict=True) if kept]
        barycentric = barycentric[keep] / barycentric[keep].sum()
        if len(corral) == 1:
            return corral, np.ones(1)


def _affine_minimizer(vertices: Rows) -> np.ndarray:
    """Affine coordinates of the point of aff(vertices) nearest to the origin.

    Least squares over differences keeps the condition number; normal equations would square it.
    """
    if len(vertices) == 1:
        return np.ones(1)
    differences = (vertices[1:] - vertices[0]).T
    coordinates = np.linalg.lstsq(differences, -vertices[0], rcond=1e-14)[0]
    return np.concatenate([[1.0 - coordinates.sum()], coordinates])
