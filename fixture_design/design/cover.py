"""Set cover: the cheapest candidates that hit every cut."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Indices, Mask, Weights
from fixture_design.errors import SolverError

#: Costs are compared to this part of themselves [-].
_GAP = 1e-6
#: What `scipy.optimize.milp` ends with where there is no solution.
_INFEASIBLE = 2


def cheapest_cover(cuts: Sequence[Mask], costs: Weights, apart: Sequence[tuple[int, int]] = ()) -> Indices | None:
    """Candidates of least total cost with one of every cut; None if there are none.

    An integer program, solved exactly by HiGHS. Candidates in the same cuts are alike but for their cost, and the
    cheapest stands for all of them, except those that are in pairs.

    Args:
        cuts: for each which candidates hit it, shape (n,) each.  costs: > 0, shape (n,).
        apart: pairs that may not be chosen together.

    Raises:
        SolverError: HiGHS ended without an answer.
    """
    if not cuts:
        return np.zeros(0, dtype=np.int64)
    hits = np.array(cuts)
    if not hits.any(axis=1).all():
        return None
    kept = _unlike(hits, costs, {index for pair in apart for index in pair})
    if not apart and np.ptp(costs) == 0 and (few := _two_at_most(hits[:, kept])) is not None:
        return kept[few]
    place = {int(candidate): column for column, candidate in enumerate(kept)}
    pairs = np.zeros((len(apart), len(kept)))
    for row, (first, second) in enumerate(apart):
        pairs[row, [place[first], place[second]]] = 1.0
    return _solved(hits[:, kept].astype(np.float64), pairs, costs[kept], kept)


def greedy_cover(cuts: Sequence[Mask], costs: Weights) -> Indices | None:
    """Candidates with one of every cut, each the one with most of what is left for its cost; None if there are none."""
    if not cuts:
        return np.zeros(0, dtype=np.int64)
    left = np.array(cuts)
    chosen: list[int] = []
    while len(left):
        worth = left.sum(axis=0) / costs
        best = int(np.argmax(worth))
        if worth[best] == 0:
            return None
        chosen.append(best)
        left = left[~left[:, best]]
    return np.array(chosen, dtype=np.int64)


def _unlike(hits: np.ndarray, costs: Weights, always: set[int]) -> Indices:
    """Candidates that hit something: all of ``always``, and of the others one for each set of cuts."""
    order = np.array([index for index in np.argsort(costs, kind="stable") if index not in always], dtype=np.int64)
    patterns = np.packbits(hits[:, order], axis=0)
    _, first = np.unique(patterns, axis=1, return_index=True)
    chosen = {int(order[index]) for index in first} | always
    return np.array(sorted(index for index in chosen if hits[:, index].any() or index in always), dtype=np.int64)


def _two_at_most(hits: np.ndarray) -> Indices | None:
    """One column with all cuts, or two that have them together; None where it takes more."""
    alone = np.flatnonzero(hits.all(axis=0))
    if len(alone):
        return alone[:1]
    for column in range(hits.shape[1]):
        others = np.flatnonzero(hits[~hits[:, column]].all(axis=0))
        if len(others):
            return np.array([column, others[0]], dtype=np.int64)
    return None


def _solved(hits: np.ndarray, pairs: np.ndarray, costs: Weights, kept: Indices) -> Indices | None:
    from scipy.optimize import Bounds, LinearConstraint, milp  # noqa: PLC0415 - slow to import

    matrix = np.vstack([hits, pairs])
    low = np.concatenate([np.ones(len(hits)), np.full(len(pairs), -np.inf)])
    high = np.concatenate([np.full(len(hits), np.inf), np.ones(len(pairs))])
    within = LinearConstraint(matrix, low, high)  # type: ignore[arg-type]
    whole = np.ones(len(costs))
    found = milp(costs, constraints=within, integrality=whole, bounds=Bounds(0, 1), options={"mip_rel_gap": _GAP})
    if found.x is None and found.status != _INFEASIBLE:
        raise SolverError(f"the cheapest cover was not found: {found.message}")
    return None if found.x is None else kept[np.flatnonzero(found.x > 1 / 2)]
