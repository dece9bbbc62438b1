"""All branches of a union as sets of rows, for `closure_tests`: one alternative out of every clause (2-9).

Rows belong to alternatives and alternatives to clauses, as flat arrays (`contacts.Constraints` has them so).
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.errors import ConeError

#: More branches than this are refused: unions of that size are searched, not listed.
MAX_BRANCHES = 1_000_000


def branch_sets(alternative: Indices, clause: Indices, most: int = MAX_BRANCHES) -> tuple[Indices, Indices]:
    """Indices and offsets of every branch's rows, the last clause's alternatives changing fastest.

    Args:
        alternative: shape (r,), the alternative of each row, non-decreasing from 0.
        clause: shape (a,), the clause of each alternative, likewise.

    Returns:
        indices, shape (n,): rows of one branch after another; offsets, shape (branches + 1,).

    Raises:
        ConeError: more than ``most`` branches.

    Example:
        >>> indices, offsets = branch_sets(np.array([0, 1, 2]), np.array([0, 1, 1]))
        >>> [indices[a:b].tolist() for a, b in zip(offsets[:-1], offsets[1:])]
        [[0, 1], [0, 2]]
    """
    sizes = np.bincount(clause).tolist() if len(clause) else []
    count = 1
    for size in sizes:
        count *= size
    if count > most:
        raise ConeError(f"the union has {count} branches, more than {most}")
    firsts = np.concatenate([[0], np.cumsum(sizes)])[:-1].astype(np.int64)
    chosen = np.zeros((count, len(sizes)), dtype=np.int64)
    numbers = np.arange(count)
    for k in reversed(range(len(sizes))):
        chosen[:, k] = firsts[k] + numbers % sizes[k]
        numbers //= sizes[k]
    rows_of = np.bincount(alternative, minlength=len(clause))
    starts = np.concatenate([[0], np.cumsum(rows_of)])[:-1].astype(np.int64)
    lengths = rows_of[chosen]
    offsets = np.concatenate([[0], np.cumsum(lengths.sum(axis=1))]).astype(np.int64)
    flat, first = lengths.ravel(), starts[chosen].ravel()
    within = np.arange(flat.sum()) - np.repeat(np.cumsum(flat) - flat, flat)
    return np.repeat(first, flat) + within, offsets
