"""Motions along free directions until a new contact stops them: the states one tightening away.

A motion that holds some contacts advances by what it can go without meeting anything (every distance over the fastest
that it can change), so that it passes nothing by. Near the next contact, its equation is solved together with those
held: where the motion ends, it is in the new state, and the way there is a direct transition.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.following import held, time_to_contact
from fixture_design.assembly.least_squares import solved
from fixture_design.assembly.sorting import Sorted, sort_configurations
from fixture_design.tolerances import DEPENDENT, SOLVED

#: Advances after which a motion is given up, and the longest one relative to the radius [-].
_MOST_ADVANCES, _LONGEST = 60, 0.25

#: The share of the certainly free way that is gone, and how near to a contact it is closed, relative to the size [-].
_SHARE, _NEAR = 0.9, 1e-3

#: Where the last bit, from there to the contact, is looked at [-].
_LAST_BIT = (0.5, 0.9, 0.99)


@dataclass(frozen=True, eq=False)
class Stopped:
    """Motions that a new contact stopped.

    Attributes:
        rows: which of the motions given, shape (k,).
        before: the last configuration in the old state.  ends: in the new state, contacts among them those held.
    """

    rows: Indices
    before: np.ndarray
    ends: Sorted


def tangent(geometry: ContactGeometry, q: np.ndarray, kept: np.ndarray, wished: np.ndarray) -> np.ndarray:
    """The wished velocities (n, d; angles times the radius), without what leaves or enters the contacts kept; unit."""
    result = np.where(geometry.free, wished, 0.0)
    some = np.flatnonzero((kept >= 0).any(axis=1))
    if some.size:
        chosen = np.where(kept[some] >= 0, kept[some], kept[some].max(axis=1, keepdims=True))
        found = geometry.equations(q[some], chosen)
        rows = found.gradients[:, :, list(found.firm)].reshape(len(some), -1, geometry.dimension) / weights(geometry)
        rows = np.where(geometry.free, rows, 0.0)
        _, values, right = np.linalg.svd(rows, full_matrices=False)
        # rows that are dependent, or repeated, add no direction
        basis = np.where((values > DEPENDENT)[..., None], right, 0.0)
        normal = np.einsum("nkj,nk->nj", basis, np.einsum("nkj,nj->nk", basis, result[some]))
        result[some] -= normal
    length = np.linalg.norm(result, axis=1, keepdims=True)
    return np.where(length > DEPENDENT, result / np.maximum(length, DEPENDENT), 0.0)


def trace(geometry: ContactGeometry, start: Sorted, kept: np.ndarray, wished: np.ndarray) -> Stopped:
    """Moves configurations until something new touches.

    Args:
        start: clear configurations.  kept: shape (n, m), the pairs that touch, -1 for none.
        wished: velocities, shape (n, d), angles times the radius; followed as far as the contacts let them.
    """
    here, velocity = start.q.copy(), wished.copy()
    going = np.arange(len(here))
    near: list[np.ndarray] = []
    for _ in range(_MOST_ADVANCES):
        velocity[going] = tangent(geometry, here[going], kept[going], velocity[going])
        going = going[velocity[going].any(axis=1)]
        if not going.size:
            break
        going, arrived = _advance(geometry, here, velocity, start, kept, going)
        near.append(arrived)
    return _closed(geometry, here, start, kept, np.concatenate([*near, np.zeros(0, dtype=int)]))


def _advance(
    geometry: ContactGeometry, here: np.ndarray, velocity: np.ndarray, start: Sorted, kept: np.ndarray, going: Indices
) -> tuple[Indices, Indices]:
    """One advance of the motions that go on, in place; returns those that still do, and those near a new contact."""
    u = velocity[going] / weights(geometry)
    now = sort_configurations(geometry, here[going])
    same = Sorted(now.q, start.touching[going], now.distances, now.admissible, now.clear)
    time = np.minimum(_SHARE * time_to_contact(geometry, now.q, u, same), _LONGEST * geometry.radius)
    end, arrived = held(geometry, geometry.moved(now.q, u * time[:, None]), kept[going])
    after = sort_configurations(geometry, end)
    good = arrived & after.clear & (after.touching == start.touching[going]).all(axis=1)
    here[going[good]] = end[good]
    others = np.where(start.touching[going], np.inf, after.distances).min(axis=1)
    close = good & (others <= _NEAR * geometry.size)
    return going[good & ~close], going[close]


def _closed(geometry: ContactGeometry, here: np.ndarray, start: Sorted, kept: np.ndarray, rows: Indices) -> Stopped:
    """Closes the pair that is nearest, and sorts where that is."""
    if not rows.size:
        return Stopped(rows, here[rows], sort_configurations(geometry, here[rows]))
    now = sort_configurations(geometry, here[rows])
    nearest = np.where(start.touching[rows], np.inf, now.distances).argmin(axis=1)
    chosen = np.column_stack([kept[rows], nearest])
    chosen = np.where(chosen >= 0, chosen, nearest[:, None])
    end, left = solved(geometry, here[rows], chosen)
    ends = sort_configurations(geometry, end)
    moved = np.linalg.norm(geometry.between(here[rows], end) * weights(geometry), axis=1)
    good = ends.clear & (left <= SOLVED * geometry.size) & (moved <= 10 * _NEAR * geometry.size)
    good &= (ends.touching | ~start.touching[rows]).all(axis=1)
    good[good] &= _way_is_free(geometry, here[rows[good]], end[good], start.touching[rows[good]], kept[rows[good]])
    return Stopped(rows[good], here[rows[good]], ends[good])


def _way_is_free(
    geometry: ContactGeometry, begin: np.ndarray, end: np.ndarray, touching: np.ndarray, kept: np.ndarray
) -> np.ndarray:
    """Whether the last bit of a motion, too, stays in the state it came in."""
    way = geometry.between(begin, end)
    good = np.ones(len(begin), dtype=bool)
    for share in _LAST_BIT:
        aim, arrived = held(geometry, geometry.moved(begin, share * way), kept)
        found = sort_configurations(geometry, aim)
        good &= arrived & found.admissible & (found.touching == touching).all(axis=1)
    return good
