"""Adding elements (section 2.7): each stops what it can of the motions that are still free.

The admissible displacements A = {u : D u <= 0} of what is there have a span form, their rays and lines. Whoever closes
must stop every one of these: for a span vector u some new row needs d . u > 0. The candidate that stops most of them
joins, A is formed again, until it is {o}.

This is the greedy way, which shows its reasons and starts from anywhere; `hitting` has the fewest, with proof.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Indices, Rows
from fixture_design.cones import PolyhedralConvexCone, convert
from fixture_design.design.candidates import Several, flat
from fixture_design.tolerances import DEFAULT


def free_spans(rows: Rows) -> Rows:
    """The span vectors of A = {u : rows . u <= 0}, of length one, lines in both directions; none where A = {o}."""
    cone = convert(PolyhedralConvexCone.from_faces(rows[rows.any(axis=1)]))
    spans = np.vstack([cone.spans, cone.lines, -cone.lines])
    return spans / np.linalg.norm(spans, axis=1, keepdims=True)


def added(rows: Several, here: Sequence[int] | Indices, pool: Indices) -> list[tuple[int, np.ndarray]]:
    """Candidates to add one after the other until all motions are stopped, each with a motion that it stops.

    Args:
        rows: of all candidates, shape (n, k, d).  here: indices of what is there.  pool: of what may be added.

    Returns:
        (index, motion) in order; what is free after the last of them, no candidate of the pool stops.
    """
    chosen = [int(index) for index in here]
    record: list[tuple[int, np.ndarray]] = []
    spans = np.vstack([np.eye(rows.shape[2]), -np.eye(rows.shape[2])]) if not chosen else free_spans(flat(rows, chosen))
    while len(spans) and len(pool):
        works = (rows[pool] @ spans.T).max(axis=1)
        stopped = works > DEFAULT.near
        if not stopped.any():
            break
        # most motions stopped; among equals the one that is furthest from letting one of them pass
        value = stopped.sum(axis=1) + np.where(stopped, works, 0.0).sum(axis=1) / (1 + len(spans))
        best = int(np.argmax(value))
        record.append((int(pool[best]), spans[int(np.argmax(works[best]))]))
        chosen.append(int(pool[best]))
        pool = np.delete(pool, best)
        spans = free_spans(flat(rows, chosen))
    return record
