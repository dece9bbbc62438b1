"""How far features may be off on each seat, and displacements that are.

Weights c with g = sum c_i d_i bound a feature: g . q = sum c_i d_i . q. Rows of the seat have d_i . q = s_i, all others
d_j . q <= s_j, so that weights bound g . q on a seat if they are positive on all rows that it does not sit on (and that
do not keep the part on both sides), and -g . q if they are negative there. Every seat's own weights do; where those of
another one do too, the smaller bound holds. Of two round pins, for example, each stays within its disc whichever of
them the weights are of, and three pads that are level carry no part that their far corners would run into.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from fixture_design.analysis.lightest import lightest
from fixture_design.analysis.locating_rows import LocatingRows
from fixture_design.analysis.seats import Seats, scattered, solved
from fixture_design.arrays import Indices, Mask, Point, Points, Rows, Vector, Weights
from fixture_design.tolerances import Tolerances

#: Seats up to which the bounds of all are compared with each other.
MAX_COMPARED = 1000
#: Seats at whose extremes a displacement is looked for, the worst first.
MAX_TRIED = 100


@dataclass(frozen=True, eq=False)
class SeatErrors:
    """Bounds of some targets on all seats.

    Attributes:
        weights: of each seat's rows for each target, and of those on both sides (`lightest`), shape (n, k, m).
        own: the bounds they give, shape (n, k) [unit of the target].
        bound: the smallest that holds on each seat, shape (n, k).
        source: the seat whose weights give it, shape (n, k).
    """

    weights: np.ndarray
    own: np.ndarray
    bound: np.ndarray
    source: np.ndarray


def seat_errors(rows: LocatingRows, seats: Seats, targets: Rows, tolerances: Tolerances) -> SeatErrors:
    """Bounds of the targets' errors on all seats.

    Args:
        targets: shape (k, d), each in the span of the rows.
    """
    weights = scattered(solved(rows.rows, seats, targets), seats, len(rows.rows))
    if len(rows.rows) > len(seats.basis) and np.sum(rows.both) > 1:
        weights = lightest(weights, rows.rows, rows.normals, rows.both, rows.owner, rows.radius)
        left = targets - weights @ rows.rows
        # walls of pins depend on each other only up to the facets' rounding
        missing = np.linalg.solve(
            (rows.rows[seats.members] @ seats.basis.T).transpose(0, 2, 1), (left @ seats.basis.T).transpose(0, 2, 1)
        )
        weights = weights + scattered(missing.transpose(0, 2, 1), seats, len(rows.rows))
    own = rows.shares(weights).sum(axis=-1)
    source = np.broadcast_to(np.arange(len(own))[:, None], own.shape)
    if not 1 < len(own) <= MAX_COMPARED:
        return SeatErrors(weights, own, own, source)
    outside = ~(seats.inside(len(rows.rows)) | rows.both)
    columns = [_smallest(weights[:, k], own[:, k], outside, tolerances) for k in range(len(targets))]
    bound, source = (np.stack(parts, axis=1) for parts in zip(*columns, strict=True))
    return SeatErrors(weights, own, bound, source)


def _smallest(weights: Rows, own: Weights, outside: np.ndarray, tolerances: Tolerances) -> tuple[Weights, Indices]:
    """For one target the larger of the bounds on both sides, each the smallest that holds on each seat."""
    both_sides = []
    limit = tolerances.zero * np.abs(weights).max(axis=1, keepdims=True)
    for sign in (1, -1):
        wrong = (sign * weights < -limit).astype(float)
        holds = wrong @ outside.T.astype(float) == 0
        bounds = np.where(holds, own[:, None], np.inf)
        both_sides.append((bounds.min(axis=0), bounds.argmin(axis=0)))
    (upper, above), (lower, below) = both_sides
    return np.maximum(upper, lower), np.where(upper >= lower, above, below)


def slack(rows: LocatingRows, seats: Seats, errors: SeatErrors) -> np.ndarray:
    """How much the normals' errors may add to each seat's own bounds, shape (n, k).

    With |E| the size of the rows' errors and v the seat's smallest singular value, weights change by at most
    k / (1 - k) |c|, k = |E| / v; inf where k >= 1.
    """
    if not rows.doubt.any():
        return np.zeros_like(errors.own)
    ratio = np.linalg.norm(rows.doubt[seats.members], axis=1) / seats.smallest
    with np.errstate(divide="ignore"):
        grown = np.where(ratio < 1, ratio / np.maximum(1 - ratio, 0.0), np.inf)[:, None, None]
    inside = seats.inside(len(rows.rows))[:, None]
    size = np.linalg.norm(errors.weights, axis=2, keepdims=True)
    changed = np.where(inside, _of_what_counts(grown, size), 0.0)
    turned = _of_what_counts(np.abs(errors.weights) + changed, rows.tilt)
    moved = rows.radius[rows.owner] + rows.form
    return np.sum(np.where(inside, _of_what_counts(changed + turned, moved), 0.0), axis=2)


def _of_what_counts(values: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """values * sizes, zero where the size is, however large the value."""
    return np.where(sizes > 0, values, 0.0) * sizes


@dataclass(frozen=True, eq=False)
class Displaced:
    """A displacement that occurs: in the rows' coordinates, the seat it rests on, and each element's move."""

    motion: Vector
    seat: int
    moves: Mapping[str, Point]


def displaced(
    rows: LocatingRows, seats: Seats, kept: Mask, errors: SeatErrors, column: int, beyond: float, near: float
) -> Displaced | None:
    """A displacement with an error ``beyond`` [m], on a seat that is kept, at which the part enters no element."""
    # where other weights bound the error below a seat's own extreme, that extreme does not occur
    own, bound = errors.own[:, column], errors.bound[:, column]
    own = np.where(kept & (own <= bound * (1 + near)), own, -np.inf)
    worst_first = np.argsort(-own)[:MAX_TRIED]
    for seat in worst_first[own[worst_first] > beyond].tolist():
        for sign, rest in product((1.0, -1.0), (0.0, 1.0)):
            motion, moves = _extreme(rows, seats, seat, errors.weights[seat, column], sign, rest, near)
            if _free_of_others(rows, motion, moves, near):
                return Displaced(motion, seat, dict(zip(rows.elements, moves, strict=True)))
    return None


def _extreme(
    rows: LocatingRows, seats: Seats, seat: int, weights: Weights, sign: float, rest: float, near: float
) -> tuple[Vector, Points]:
    """The displacement with all elements that count at their extremes, the others ``rest`` of theirs towards the part.

    Returns:
        the displacement and the elements' moves, shape (e, p).
    """
    members = seats.members[seat]
    pulls = rows.pulls(weights)
    lengths = np.linalg.norm(pulls, axis=1)
    counts = lengths > near * np.abs(weights).max()
    idle = np.array([_outward(rows, e) for e in range(len(rows.elements))]) * rest
    directions = np.where(counts[:, None], sign * pulls / np.where(counts, lengths, 1.0)[:, None], idle)
    moves = directions * rows.radius[:, None]
    errors = np.sum(rows.normals * moves[rows.owner], axis=1) + sign * np.sign(weights) * rows.form
    motion = np.linalg.solve(rows.rows[members] @ seats.basis.T, errors[members]) @ seats.basis
    # a pin that does not count is wherever its hole is
    for e in np.flatnonzero(~counts).tolist():
        walls = (rows.owner == e) & rows.both
        if walls.any():
            moves[e] = np.linalg.pinv(rows.normals[walls]) @ (rows.rows[walls] @ motion)
    return motion, moves


def _outward(rows: LocatingRows, element: int) -> Point:
    """The direction in which an element leaves the part."""
    total = rows.normals[rows.owner == element].sum(axis=0)
    length = float(np.linalg.norm(total))
    return total / length if length > 0 else total


def _free_of_others(rows: LocatingRows, motion: Vector, moves: Points, near: float) -> bool:
    """Whether d_i . q <= n_i . u + form for all rows, with equality for those on both sides, and |u| <= radius."""
    gaps = np.sum(rows.normals * moves[rows.owner], axis=1) + rows.form - rows.rows @ motion
    largest = near * max(float(np.abs(motion).max()), float(rows.radius.max()))
    within = np.linalg.norm(moves, axis=1) <= rows.radius + largest
    return bool(within.all() and np.all(gaps >= -largest) and np.all(gaps[rows.both] <= largest + rows.form[rows.both]))
