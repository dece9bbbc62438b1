"""Least squares with nonnegative unknowns (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23).

Written here because a contact-only verification must start without scipy.optimize, whose import costs more than the
whole verification.
"""

from __future__ import annotations

import numpy as np

from fixture_design.cones.kernel.checks import require_finite
from fixture_design.cones.kernel.choice import compiled

#: A column enters only if it points along the residual by this much, relative to both [-].
_IMPROVES = 1e-13
#: Unknowns below this, relative to the largest, have been driven to zero [-].
_DRIVEN_OUT = 1e-15


def nonnegative_least_squares(matrix: np.ndarray, target: np.ndarray) -> np.ndarray:
    """x >= 0 that minimises |M x - b|.

    Args:
        matrix: M, shape (n, k).  target: b, shape (n,).

    Returns:
        x, shape (k,).

    Raises:
        ConeError: entries that are not finite.
    """
    native = compiled(len(matrix))
    if native is not None:
        return native.nonnegative_least_squares(matrix.T, target)
    require_finite(matrix)
    require_finite(target)
    columns = matrix.shape[1]
    solution = np.zeros(columns)
    passive = np.zeros(columns, dtype=bool)
    refused = np.zeros(columns, dtype=bool)
    residual = target.copy()
    for _ in range(10 * columns + 50):
        size = float(np.linalg.norm(residual))
        gradient = matrix.T @ residual
        gradient[passive | refused] = -np.inf
        if not columns or size <= _DRIVEN_OUT * np.linalg.norm(target) or gradient.max() <= _IMPROVES * size:
            break
        entering = int(np.argmax(gradient))
        passive[entering] = True
        trial = _least_squares_on(matrix, target, passive)
        if trial[entering] <= 0:
            passive[entering], refused[entering] = False, True
            continue
        while trial[passive].min() <= 0:
            falling = passive & (trial <= 0)
            step = np.min(solution[falling] / (solution[falling] - trial[falling]))
            solution = solution + step * (trial - solution)
            passive &= solution > _DRIVEN_OUT * solution.max()
            solution[~passive] = 0.0
            trial = _least_squares_on(matrix, target, passive)
        solution = trial
        new_residual = target - matrix @ solution
        if np.linalg.norm(new_residual) < size:
            refused[:] = False
        else:
            refused[entering] = True
        residual = new_residual
    return solution


def _least_squares_on(matrix: np.ndarray, target: np.ndarray, passive: np.ndarray) -> np.ndarray:
    trial = np.zeros(matrix.shape[1])
    trial[passive] = np.linalg.lstsq(matrix[:, passive], target, rcond=1e-14)[0]
    return trial
