"""The fewest rows that close: d + 1 where the part lets them.

Rows close if they balance with positive weights and have full rank d. A basic solution of

    D^T w = 0,  sum w = 1,  w >= 0

has at most d + 1 positive weights. On a smooth part a generic objective gives d + 1 at once; on a prismatic one often a
smaller *circuit* (two opposite tips), so that circuits are put together until the rank is d, and what is not needed
leaves again. Fewer than d + 1 rows never close: 7 in space, 4 in the plane.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fixture_design.arrays import Indices, Rows, Weights
from fixture_design.cones.kernel import closure_tests
from fixture_design.tolerances import DEFAULT, SUPPORT

#: Objectives tried before the smallest set so far is taken.
TRIES = 60
#: Of more rows than these, so many drawn at random are tried first.
SOME = 500
#: Objectives prefer rows outside the span so far by this factor [-].
_OUTSIDE = 1e-3


def fewest_closing(
    rows: Rows,
    rng: np.random.Generator,
    tries: int = TRIES,
    cancelled: Callable[[], bool] = lambda: False,
) -> Indices | None:
    """Indices of few rows that close, d + 1 if one of the tries has so few; None where none close.

    Args:
        rows: unit, shape (n, d).
    """
    if len(rows) > SOME:
        # what closes among some closes among all, and seven of a thousand are as few as seven of all
        some = np.sort(rng.choice(len(rows), SOME, replace=False))
        found = fewest_closing(rows[some], rng, tries, cancelled)
        if found is not None and len(found) == rows.shape[1] + 1:
            return some[found]
    best: Indices | None = None
    for _ in range(tries):
        found = _closing(rows, rng)
        if found is None:
            return best
        if best is None or len(found) < len(best):
            best = found
        if len(best) == rows.shape[1] + 1 or cancelled():
            break
    return best


def _closing(rows: Rows, rng: np.random.Generator) -> Indices | None:
    """Circuits, each with something outside the span of the others, less what is not needed."""
    union = np.empty(0, dtype=np.int64)
    outside = np.ones(len(rows), dtype=bool)
    for _ in range(rows.shape[1]):
        circuit = balanced_circuit(rows, rng.random(len(rows)) + np.where(outside, 0.0, 1.0), outside)
        if circuit is None:
            return None
        union = np.union1d(union, circuit)
        basis = _basis(rows[union])
        outside = np.linalg.norm(rows - rows @ basis.T @ basis, axis=1) > DEFAULT.near
        if len(basis) == rows.shape[1]:
            return without_spare(rows, union, rng)
    return None


def balanced_circuit(rows: Rows, costs: Weights, some_of: np.ndarray) -> Indices | None:
    """Rows that balance and of which at least one is ``some_of``; few of them, by a basic solution."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    equalities = np.vstack([rows.T, some_of.astype(np.float64)])
    right = np.append(np.zeros(rows.shape[1]), 1.0)
    found = linprog(costs, A_eq=equalities, b_eq=right, bounds=(0, None), method="highs-ds")
    if found.x is None:
        return None
    return np.flatnonzero(found.x > SUPPORT * found.x.max())


def without_spare(rows: Rows, chosen: Indices, rng: np.random.Generator) -> Indices:
    """A smallest part of rows that close which still closes: no row can leave it."""
    chosen = rng.permutation(chosen)
    while len(chosen) > rows.shape[1] + 1:
        size = len(chosen) - 1
        less = np.array([np.delete(chosen, place) for place in range(len(chosen))])
        tests = closure_tests(rows, np.arange(len(chosen) + 1) * size, less.ravel())
        closes = np.flatnonzero(tests.closes == 1)
        if not len(closes):
            break
        chosen = less[int(closes[np.argmax(tests.lower[closes])])]
    return np.sort(chosen)


def _basis(rows: Rows) -> Rows:
    """Orthonormal rows that span these."""
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    return right[: int((values > DEFAULT.near * values[0]).sum())]
