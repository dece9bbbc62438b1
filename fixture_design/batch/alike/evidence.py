"""Witnesses, margins and residuals of groups that are decided together, in the form that `analysis` gives them.

For groups of contacts without alternatives and without friction: all of it comes from one set of rows a layout. In the
report's scale R = [n; (x - reference) X n / length], with |n| = 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.batch.alike.decide import NO, YES, Decided, Numbers
from fixture_design.batch.alike.plan import GroupPlan
from fixture_design.cones.kernel import minimum_norm_point
from fixture_design.contacts import scaled_rows
from fixture_design.tolerances import DEFAULT, SUM_ROUNDING


@dataclass(frozen=True, eq=False)
class Evidence:
    """What full records say of one group of n layouts.

    Attributes:
        values: by name, shape (n, k) each: "located margin", "unnoticed" (a motion that the rows do not notice),
            "unnoticed residual", "s", "minus s", "motion", "motion residual", "weights", "weights residual".
        ranks: shape (n,).  bases: shape (n, d), the rows of `heavy_basis`, meaningful where the group closes.
        good: shape (n,), whether there is evidence for every answer.
    """

    values: Mapping[str, np.ndarray]
    ranks: np.ndarray
    bases: np.ndarray
    good: np.ndarray


def evidence_of(group: GroupPlan, numbers: Numbers, decided: Decided) -> Evidence:
    """The evidence for what was decided with witnesses about a group with contacts."""
    assert decided.closures is not None
    assert decided.closures.weights is not None
    assert decided.closures.motions is not None
    count, _, size, dimension = decided.rows.shape
    owners, which = group.owners[0], group.normals[0]
    levers = numbers.points - numbers.reference[:, None]
    reported = scaled_rows(levers[:, owners], numbers.normals[:, which], numbers.length[:, None, None])
    sound = numbers.fit & np.isfinite(reported).all(axis=(1, 2))
    # one bad layout would stop the others; and the order in memory decides about last digits
    reported = np.ascontiguousarray(np.where(sound[:, None, None], reported, 0.0))
    motions, weights = decided.closures.motions, decided.closures.weights.reshape(count, size)
    weights = weights / np.where(decided.lengths[:, 0] > 0, decided.lengths[:, 0], 1.0)
    total = weights.sum(axis=1, keepdims=True)
    weights = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    sizes, last = _unnoticed(decided.rows[:, 0])
    located, _, interior, closed, _ = decided.answers.T
    balances, moves = total[:, 0] > 0, np.linalg.norm(motions, axis=1) > 0
    good = sound & np.where(closed == YES, balances, moves & ((interior == YES) | balances))
    s = _margins(reported, closed, good)
    motion, along = _motion(motions, decided, numbers)
    still, still_along = _motion(last, decided, numbers)
    values = {
        "located margin": _smallest(reported)[:, None],
        "unnoticed": still,
        "unnoticed residual": np.abs(np.einsum("nrd,nd->nr", reported, still_along)).max(axis=1, keepdims=True),
        "s": s[:, None],
        "minus s": 0.0 - s[:, None],
        "motion": motion,
        "motion residual": np.einsum("nrd,nd->nr", reported, along).max(axis=1, keepdims=True),
        "weights": weights,
        "weights residual": np.linalg.norm(np.einsum("nr,nrd->nd", weights, reported), axis=1)[:, None],
    }
    ranks = np.where(located == NO, np.minimum((sizes > DEFAULT.tie).sum(axis=1), dimension - 1), dimension)
    good &= np.isfinite(np.concatenate(list(values.values()), axis=1)).all(axis=1)
    return Evidence({key: value + 0.0 for key, value in values.items()}, ranks, _bases(reported, weights), good)


def _unnoticed(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All d singular values of rows, shape (n, r, d), and the last right singular vector."""
    missing = rows.shape[2] - rows.shape[1]
    padded = np.pad(rows, ((0, 0), (0, max(missing, 0)), (0, 0)))
    _, sizes, right = np.linalg.svd(padded, full_matrices=False)
    return sizes, right[:, -1]


def _smallest(rows: np.ndarray) -> np.ndarray:
    """The d-th singular value, 0 with fewer rows: `determinacy_margin`."""
    if rows.shape[1] < rows.shape[2]:
        return np.zeros(len(rows))
    return np.linalg.svd(rows, compute_uv=False)[:, -1]


def _margins(rows: np.ndarray, closed: np.ndarray, good: np.ndarray) -> np.ndarray:
    """s of each set of rows, as `closure_margin`: the hull's distance from the origin, its nearest facet if closed."""
    margins = np.full(len(rows), np.nan)
    for k in np.flatnonzero(good).tolist():
        if closed[k] == YES:
            found = nearest_facet(rows[k])
            margins[k] = np.nan if found is None else max(found.distance, 0.0)
        else:
            distance = float(np.linalg.norm(minimum_norm_point(rows[k])[0]))
            margins[k] = -distance if distance > DEFAULT.tie else 0.0
    return margins


def _motion(motions: np.ndarray, decided: Decided, numbers: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """`motion_in_world` of motions in the contacts' own scale; and in the report's scale, of length one."""
    plane = decided.reference.shape[1]
    tidy = np.where(np.abs(motions) < SUM_ROUNDING, 0.0, motions)
    turn = tidy[:, plane:] / decided.length[:, None]
    world = np.concatenate([tidy[:, :plane] + _spin(turn, -decided.reference), turn], axis=1)
    moved = world[:, :plane] + _spin(turn, numbers.reference)
    scaled = np.concatenate([moved, turn * numbers.length[:, None]], axis=1)
    size = np.linalg.norm(scaled, axis=1, keepdims=True)
    return world, np.divide(scaled, size, out=np.zeros_like(scaled), where=size > 0)


def _spin(turn: np.ndarray, points: np.ndarray) -> np.ndarray:
    """dtheta X x."""
    if points.shape[1] == 2:
        return turn * np.stack([-points[:, 1], points[:, 0]], axis=1)
    return np.cross(turn, points)


def _bases(rows: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """`heavy_basis` of each layout, shape (n, d), sorted."""
    remaining = weights[..., None] * rows
    every = np.arange(len(rows))
    chosen = np.zeros((len(rows), rows.shape[2]), dtype=np.int64)
    for step in range(rows.shape[2]):
        lengths = np.linalg.norm(remaining, axis=2)
        best = np.argmax(lengths, axis=1)
        chosen[:, step] = best
        longest = lengths[every, best][:, None]
        direction = np.divide(remaining[every, best], longest, out=np.zeros_like(rows[:, 0]), where=longest > 0)
        remaining = remaining - np.einsum("nrd,nd->nr", remaining, direction)[..., None] * direction[:, None]
        remaining[every[:, None], chosen[:, : step + 1]] = 0.0
    return np.sort(chosen, axis=1)
