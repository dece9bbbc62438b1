"""Seats: the sets of contacts that a part may rest on where it is located more than once.

A seat is a largest set of rows that are independent, by `SEATED`. Rows that depend on no others are in every seat; the
others fall into groups (two rows are in one if some circuit, a smallest dependent set, has both), and a seat takes a
largest independent set from each. The groups are the blocks of the projector onto the left null space of the rows,
{a : sum a_i d_i = 0}.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, islice, product
from math import comb, prod

import numpy as np

from fixture_design.arrays import Rows
from fixture_design.tolerances import SEATED, SUM_ROUNDING, Tolerances

#: Sets of contacts looked at before the list of seats is cut off.
MAX_SEATS = 5000


@dataclass(frozen=True, eq=False)
class Seats:
    """Seats of some rows.

    Attributes:
        members: indices of each seat's rows, shape (n, r), r the rank.
        basis: orthonormal rows that span what the contacts locate, shape (r, d).
        smallest: the smallest singular value of each seat's rows, shape (n,).
        groups: rows that depend on each other, several a group.
        complete: False where there were too many to list.
    """

    members: np.ndarray
    basis: Rows
    smallest: np.ndarray
    groups: tuple[tuple[int, ...], ...]
    complete: bool

    def inside(self, count: int) -> np.ndarray:
        """Whether each seat has each of ``count`` rows, shape (n, count)."""
        inside = np.zeros((len(self.members), count), dtype=bool)
        np.put_along_axis(inside, self.members, True, axis=1)
        return inside


def seats_of(rows: Rows, tolerances: Tolerances) -> Seats | None:
    """The seats of dimensionless rows, shape (m, d); None where not all is located, up to rounding."""
    left, values, right = np.linalg.svd(rows, full_matrices=False)
    rank = int(np.sum(values > SEATED))
    if rank < rows.shape[1] and np.any(values[rank:] > tolerances.zero):
        return None
    basis = right[:rank]
    if rank == len(rows):
        return Seats(np.arange(rank)[None], basis, values[rank - 1 : rank], (), True)
    projector = np.eye(len(rows)) - left[:, :rank] @ left[:, :rank].T
    groups = _blocks(np.abs(projector) > SEATED)
    sizes = [(group, round(sum(1.0 - projector[i, i] for i in group))) for group in groups]
    listed = islice(product(*(combinations(group, size) for group, size in sizes)), MAX_SEATS)
    chosen = np.array([sorted(sum(parts, ())) for parts in listed], dtype=np.int64).reshape(-1, rank)
    smallest = np.linalg.svd(rows[chosen] @ basis.T, compute_uv=False)[:, -1] if rank else np.ones(len(chosen))
    good = smallest > SEATED
    complete = prod(comb(len(group), size) for group, size in sizes) <= MAX_SEATS
    dependent = tuple(group for group in groups if len(group) > 1)
    return Seats(chosen[good], basis, smallest[good], dependent, complete)


def _blocks(linked: np.ndarray) -> list[tuple[int, ...]]:
    """The connected groups of a symmetric relation, in order of their first members."""
    groups, left = [], set(range(len(linked)))
    while left:
        group, fresh = set[int](), {min(left)}
        while fresh:
            group |= fresh
            fresh = set(np.flatnonzero(linked[sorted(fresh)].any(axis=0)).tolist()) - group
        left -= group
        groups.append(tuple(sorted(group)))
    return groups


def solved(rows: Rows, seats: Seats, targets: Rows) -> np.ndarray:
    """For each seat and target g the weights c of its rows with sum c_i d_i = g, shape (n, k, r)."""
    square = (rows[seats.members] @ seats.basis.T).transpose(0, 2, 1)
    aims = np.broadcast_to((targets @ seats.basis.T).T, (len(square), square.shape[1], len(targets)))
    weights = np.linalg.solve(square, aims).transpose(0, 2, 1)
    # what rounding leaves of a zero is no weight
    return np.where(np.abs(weights) <= SUM_ROUNDING * np.abs(weights).max(axis=2, keepdims=True), 0.0, weights)


def scattered(weights: np.ndarray, seats: Seats, count: int) -> np.ndarray:
    """Weights of the seats' rows, shape (n, k, r), as weights of all ``count`` rows, shape (n, k, count)."""
    everywhere = np.zeros((*weights.shape[:2], count))
    np.put_along_axis(everywhere, np.broadcast_to(seats.members[:, None], weights.shape), weights, axis=2)
    return everywhere
